#version 460
// Hierarchical depth: least and greatest view depth of every 8x8 shadow tile.
//
// Source: the paper, section 2.2 and its footnote 1. The greatest depth leaves out background, which would otherwise
// make every tile at a silhouette reach to the end of the world. A tile of background alone gets min = +inf, max =
// -inf, and no lights.
// Plain way: one work group per tile, one lane per pixel. There is so little to do for a tile that launching its work
// group and its barrier take half of the time.
// Here: one work group of 64 lanes for four tiles in a row, 16 lanes each. A lane reads the 2x2 pixels of a quad.
// With a host's own pyramid (kHostDepthPyramid) one lane converts one tile.
// Limits: a host's pyramid may include background. The range of such a tile is then taken as endless: a standard
// infinite projection's zero could make its end of either sign.
#extension GL_GOOGLE_include_directive : require
#define GNOMON_LISTS_ACCESS
#include "vulkan/work_group.glsl"
#include "shading/receiver.glsl"

layout(constant_id = kSpecHostDepthPyramid) const uint kHostDepthPyramid = 0;

const uint kTiles = kDepthTilesPerGroup;
const uint kLanes = kWorkGroupSize / kTiles;  // of a tile

shared vec2 ranges[kWorkGroupSize];

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
}

vec2 join(vec2 a, vec2 b) { return vec2(min(a.x, b.x), max(a.y, b.y)); }

vec2 rangeOfQuad(uvec2 first) {
    vec2 range = vec2(kInfinity, -kInfinity);
    for (uint i = 0u; i < 4u; ++i) {
        uvec2 pixel = first + uvec2(i & 1u, i >> 1u);
        if (any(greaterThanEqual(pixel, frame.extentPx))) continue;
        float d = hostDepthAt(pixel);
        if (!isBackground(d)) range = join(range, vec2(viewDepthOf(d)));
    }
    return range;
}

void main() {
    uint lane = laneIndex();
    if (kHostDepthPyramid != 0u) {
        convertHostPyramid(gl_WorkGroupID.xy * 8u + laneCoordinates(lane));
        return;
    }
    uint local = lane / kLanes;
    uvec2 tile = uvec2(gl_WorkGroupID.x * kTiles + local, gl_WorkGroupID.y);
    ranges[lane] = rangeOfQuad(tile * kShadowTileSizePx + 2u * laneCoordinates(lane % kLanes));
    barrier();
    // Four lanes of a tile join four quads each, and one lane joins theirs.
    for (uint step = kLanes / 4u; step > 0u; step /= 4u) {
        if (lane % kLanes < step) {
            for (uint i = 1u; i < 4u; ++i) ranges[lane] = join(ranges[lane], ranges[lane + i * step]);
        }
        barrier();
    }
    if (lane % kLanes == 0u && tile.x < frame.tileCounts.x) tileDepthRanges[tileIndexOf(tile)] = ranges[lane];
}
