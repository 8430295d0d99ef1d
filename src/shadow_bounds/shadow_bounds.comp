#version 460
// Shadow bounds: the least and the greatest depth of every block of the shadow atlases, from 16x16 to 256x256 texels.
//
// Problem: most pixels are wholly lit or wholly dark, and a search for blockers takes many texture reads to find out.
// Source: the min/max shadowmaps of Dmitriev and Uralsky 2007, "Soft Shadows Using Hierarchical Min-Max Shadow Maps".
// Plain way: one pass per level over whole atlases.
// Here: one work group makes all five levels of one cell of 256x256 texels. Only cells that a changed shadow view
// touches are made again. A lane reads 32x32 texels. Upper levels meet in shared memory.
#extension GL_GOOGLE_include_directive : require
#define GNOMON_SHADOW_BOUNDS_ACCESS
#include "vulkan/work_group.glsl"
#include "gpu_interface/working_set.glsl"
#include "gpu_interface/shadowmaps_set.glsl"

shared vec2 sharedBounds[kWorkGroupSize];

vec4 gatherAtlas(uint atlas, vec3 at) {
    if (kShadowAtlases == 1u) return textureGather(sampler2DArray(shadowAtlas0, shadowSampler), at);
    switch (atlas) {
        case 0u: return textureGather(sampler2DArray(shadowAtlas0, shadowSampler), at);
        case 1u: return textureGather(sampler2DArray(shadowAtlas1, shadowSampler), at);
        case 2u: return textureGather(sampler2DArray(shadowAtlas2, shadowSampler), at);
        default: return textureGather(sampler2DArray(shadowAtlas3, shadowSampler), at);
    }
}

vec2 join(vec2 a, vec2 b) { return vec2(min(a.x, b.x), max(a.y, b.y)); }

// Texels beyond the atlas repeat its last ones.
vec2 boundsOfBlock(GpuShadowBoundsCell cell, uvec2 block) {
    vec2 first = vec2(block * kShadowBoundsBlockPx);
    vec2 bounds = vec2(1.0, 0.0);
    for (uint y = 0u; y < kShadowBoundsBlockPx; y += 2u) {
        for (uint x = 0u; x < kShadowBoundsBlockPx; x += 2u) {
            vec2 at = (first + vec2(x, y) + 1.0) * vec2(cell.atlasPerTexelX, cell.atlasPerTexelY);
            vec4 d = gatherAtlas(cell.atlasAndLayer & 0xFFu, vec3(at, float(cell.atlasAndLayer >> 8u)));
            vec2 low = min(d.xy, d.zw);
            vec2 high = max(d.xy, d.zw);
            bounds = join(bounds, vec2(min(low.x, low.y), max(high.x, high.y)));
        }
    }
    return bounds;
}

void writeBounds(GpuShadowBoundsCell cell, uint level, uvec2 block, vec2 bounds) {
    shadowBounds[shadowBoundsIndex(cell.first, cell.row, cell.blocks, level, block)] = bounds;
}

void main() {
    GpuShadowBoundsCell cell = shadowBoundsCells[gl_WorkGroupID.x];
    uint lane = laneIndex();
    uvec2 place = laneCoordinates(lane);
    uvec2 block = (uvec2(cell.cellX, cell.cellY) * 8u + place) * 2u;
    vec2 bounds = vec2(1.0, 0.0);
    for (uint i = 0u; i < 4u; ++i) {
        uvec2 own = block + uvec2(i & 1u, i >> 1u);
        vec2 b = boundsOfBlock(cell, own);
        writeBounds(cell, 0u, own, b);
        bounds = join(bounds, b);
    }
    writeBounds(cell, 1u, block >> 1u, bounds);
    // Lanes are in Morton order: four neighbours are one block of the next level.
    for (uint level = 2u; level < kShadowBoundsLevels; ++level) {
        sharedBounds[lane] = bounds;
        barrier();
        uint step = 1u << (2u * (level - 2u));
        if (lane % (4u * step) == 0u) {
            for (uint i = 1u; i < 4u; ++i) bounds = join(bounds, sharedBounds[lane + i * step]);
            writeBounds(cell, level, block >> level, bounds);
        }
        barrier();
    }
}
