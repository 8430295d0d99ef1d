#version 460
// Hierarchical depth: least and greatest view depth of every 8x8 shadow tile.
//
// Source: the paper, section 2.2 and its footnote 1. The greatest depth leaves out background, which would otherwise
// make every tile at a silhouette reach to the end of the world. A tile of background alone gets min = +inf, max =
// -inf, and no lights.
// One work group per tile, one lane per pixel. With a host's own pyramid (kHostDepthPyramid) one lane converts one
// tile.
// Limits: a host's pyramid may include background. The range of such a tile is then taken as endless: a standard
// infinite projection's zero could make its end of either sign.
#extension GL_GOOGLE_include_directive : require
#define GNOMON_LISTS_ACCESS
#include "vulkan/work_group.glsl"
#include "shading/receiver.glsl"

layout(constant_id = kSpecHostDepthPyramid) const uint kHostDepthPyramid = 0;

shared float sharedNear[kSubgroupCount];
shared float sharedFar[kSubgroupCount];

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

void main() {
    uint lane = laneIndex();
    uvec2 cell = gl_WorkGroupID.xy * 8u + laneCoordinates(lane);
    if (kHostDepthPyramid != 0u) {
        convertHostPyramid(cell);
        return;
    }
    float near = kInfinity;
    float far = -kInfinity;
    if (all(lessThan(cell, frame.extentPx))) {
        float d = hostDepthAt(cell);
        if (!isBackground(d)) {
            near = viewDepthOf(d);
            far = near;
        }
    }
    near = subgroupMin(near);
    far = subgroupMax(far);
    if (kSubgroupCount > 1u) {
        if (subgroupElect()) {
            sharedNear[gl_SubgroupID] = near;
            sharedFar[gl_SubgroupID] = far;
        }
        barrier();
        for (uint i = 0u; i < kSubgroupCount; ++i) {
            near = min(near, sharedNear[i]);
            far = max(far, sharedFar[i]);
        }
    }
    if (lane == 0u) tileDepthRanges[tileIndexOf(gl_WorkGroupID.xy)] = vec2(near, far);
}
