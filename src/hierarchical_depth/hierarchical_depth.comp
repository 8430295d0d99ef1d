#version 460
// Hierarchical depth: least and greatest view depth of every 8x8 shadow tile.
//
// Source: the paper, section 2.2 and its footnote 1. The greatest depth leaves out background, which would otherwise
// make every tile at a silhouette reach to the end of the world. A tile of background alone gets min = +inf, max =
// -inf, and no lights.
// Plain way: one work group per tile, one lane per pixel. There is so little to do for a tile that launching its work
// group and its barrier take half of the time.
// Here: one work group of 64 lanes for four tiles in a row, 16 lanes each. A lane reads the 2x2 pixels of a quad. When
// the tile's range is known, each lane marks the slices of the range that its pixels are in (depth_slices.glsl).
// With a host's own pyramid (kHostDepthPyramid) one lane converts one tile.
// Limits: a host's pyramid may include background. The range of such a tile is then taken as endless: a standard
// infinite projection's zero could make its end of either sign. What lies between is not known, so all slices count.
#extension GL_GOOGLE_include_directive : require
#define GNOMON_LISTS_ACCESS
#include "vulkan/work_group.glsl"
#include "shading/receiver.glsl"
#include "gpu_interface/working_set.glsl"
#include "hierarchical_depth/depth_slices.glsl"

layout(constant_id = kSpecHostDepthPyramid) const uint kHostDepthPyramid = 0;

const uint kTiles = kDepthTilesPerGroup;
const uint kLanes = kWorkGroupSize / kTiles;  // of a tile

shared vec2 ranges[kWorkGroupSize];
shared uint slices[kTiles];

#define kInfinity uintBitsToFloat(0x7F800000u)

void convertHostPyramid(uvec2 tile) {
    if (any(greaterThanEqual(tile, frame.tileCounts))) return;
    vec2 device = texelFetch(hostDepthPyramid, ivec2(tile), 0).xy;
    vec2 range = vec2(kInfinity, -kInfinity);
    if (!isBackground(device.x) || !isBackground(device.y)) {
        float a = isBackground(device.x) ? kInfinity : viewDepthOf(device.x);
        float b = isBackground(device.y) ? kInfinity : viewDepthOf(device.y);
        range = vec2(min(a, b), max(a, b));
    }
    tileDepthRanges[tileIndexOf(tile)] = range;
    tileDepthSlices[tileIndexOf(tile)] = kAllDepthSlices;
}

vec2 join(vec2 a, vec2 b) { return vec2(min(a.x, b.x), max(a.y, b.y)); }

// `solid`: one bit for each pixel with geometry.
vec4 depthsOfQuad(uvec2 first, out uint solid) {
    vec4 depths = vec4(0.0);
    solid = 0u;
    for (uint i = 0u; i < 4u; ++i) {
        uvec2 pixel = first + uvec2(i & 1u, i >> 1u);
        if (any(greaterThanEqual(pixel, frame.extentPx))) continue;
        float d = hostDepthAt(pixel);
        if (isBackground(d)) continue;
        depths[i] = viewDepthOf(d);
        solid |= 1u << i;
    }
    return depths;
}

vec2 rangeOf(vec4 depths, uint solid) {
    vec2 range = vec2(kInfinity, -kInfinity);
    for (uint i = 0u; i < 4u; ++i) {
        if ((solid >> i & 1u) != 0u) range = join(range, vec2(depths[i]));
    }
    return range;
}

uint slicesOf(vec2 range, vec4 depths, uint solid) {
    if (!(range.y < kInfinity)) return kAllDepthSlices;
    uint marked = 0u;
    for (uint i = 0u; i < 4u; ++i) {
        if ((solid >> i & 1u) != 0u) marked |= 1u << depthSlice(range, depths[i]);
    }
    return marked;
}

void main() {
    uint lane = laneIndex();
    if (kHostDepthPyramid != 0u) {
        convertHostPyramid(gl_WorkGroupID.xy * 8u + laneCoordinates(lane));
        return;
    }
    uint local = lane / kLanes;
    uvec2 tile = uvec2(gl_WorkGroupID.x * kTiles + local, gl_WorkGroupID.y);
    uint solid;
    vec4 depths = depthsOfQuad(tile * kShadowTileSizePx + 2u * laneCoordinates(lane % kLanes), solid);
    ranges[lane] = rangeOf(depths, solid);
    if (lane < kTiles) slices[lane] = 0u;
    barrier();
    // Four lanes of a tile join four quads each, and one lane joins theirs.
    for (uint step = kLanes / 4u; step > 0u; step /= 4u) {
        if (lane % kLanes < step) {
            for (uint i = 1u; i < 4u; ++i) ranges[lane] = join(ranges[lane], ranges[lane + i * step]);
        }
        barrier();
    }
    vec2 range = ranges[local * kLanes];
    atomicOr(slices[local], slicesOf(range, depths, solid));
    barrier();
    if (lane % kLanes == 0u && tile.x < frame.tileCounts.x) {
        tileDepthRanges[tileIndexOf(tile)] = range;
        tileDepthSlices[tileIndexOf(tile)] = slices[local];
    }
}
