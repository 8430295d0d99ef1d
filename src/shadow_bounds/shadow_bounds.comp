#version 460
// Shadow bounds: the least and the greatest depth of every block of the shadow atlases, from 16x16 to 256x256 texels.
//
// Problem: most pixels are wholly lit or wholly dark, and a search for blockers takes many texture reads to find out.
// Source: the min/max shadowmaps of Dmitriev and Uralsky 2007, "Soft Shadows Using Hierarchical Min-Max Shadow Maps".
// Plain way: one pass per level over whole atlases.
// Here: one work group makes all five levels of one cell of 256x256 texels. Only cells that a changed shadow view
// touches are made again. A lane reads 32x32 texels. Upper levels meet in shared memory.
// Planes: bounds alone never say "lit", since the receiver's own surface lies in them. So every block of the finest
// level also gets a plane, by least squares, and how far its depths lie off it. A block of one flat surface has almost
// nothing left. In blocks of several surfaces much is left, and their plane tells nothing.
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

// Depths of 2x2 texels of a block, in the order of textureGather: (0,1), (1,1), (1,0), (0,0). Texels beyond the atlas
// repeat its last ones.
vec4 depthsAt(GpuShadowBoundsCell cell, uvec2 block, uint x, uint y) {
    vec2 first = vec2(block * kShadowBoundsBlockPx);
    vec2 at = (first + vec2(x, y) + 1.0) * vec2(cell.atlasPerTexelX, cell.atlasPerTexelY);
    return gatherAtlas(cell.atlasAndLayer & 0xFFu, vec3(at, float(cell.atlasAndLayer >> 8u)));
}

vec2 rangeOf(vec4 d) {
    vec2 low = min(d.xy, d.zw);
    vec2 high = max(d.xy, d.zw);
    return vec2(min(low.x, low.y), max(high.x, high.y));
}

const vec4 kGatherX = vec4(0.0, 1.0, 1.0, 0.0);
const vec4 kGatherY = vec4(1.0, 1.0, 0.0, 0.0);

// Bounds of a block. `slope`: of its plane, per texel.
vec2 boundsOfBlock(GpuShadowBoundsCell cell, uvec2 block, out vec2 slope) {
    const float size = float(kShadowBoundsBlockPx);
    const float middle = 0.5 * (size - 1.0);
    // The sum of the squares of x over the block, with x counted from its middle.
    const float squares = size * size * (size * size - 1.0) / 12.0;
    vec2 bounds = vec2(1.0, 0.0);
    vec2 moments = vec2(0.0);
    for (uint y = 0u; y < kShadowBoundsBlockPx; y += 2u) {
        for (uint x = 0u; x < kShadowBoundsBlockPx; x += 2u) {
            vec4 d = depthsAt(cell, block, x, y);
            bounds = join(bounds, rangeOf(d));
            moments += vec2(dot(d, float(x) - middle + kGatherX), dot(d, float(y) - middle + kGatherY));
        }
    }
    slope = moments / squares;
    return bounds;
}

// What is left of a block's depths, counted from its first texel.
vec2 leftOver(GpuShadowBoundsCell cell, uvec2 block, vec2 slope) {
    vec2 left = vec2(2.0, -2.0);
    for (uint y = 0u; y < kShadowBoundsBlockPx; y += 2u) {
        for (uint x = 0u; x < kShadowBoundsBlockPx; x += 2u) {
            vec4 plane = (float(x) + kGatherX) * slope.x + (float(y) + kGatherY) * slope.y;
            left = join(left, rangeOf(depthsAt(cell, block, x, y) - plane));
        }
    }
    return left;
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
        vec2 slope;
        vec2 b = boundsOfBlock(cell, own, slope);
        writeBounds(cell, 0u, own, b);
        shadowPlanes[shadowPlaneIndex(cell.planesFirst, cell.row, own)] = vec4(slope, leftOver(cell, own, slope));
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
