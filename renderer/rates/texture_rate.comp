#version 460
// Samples a shadow atlas as the filters do, with next to no arithmetic around it: how many samples a device can take
// when all of them are in its texture caches. Every work group stays within a block of 32x32 texels.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "vulkan/work_group.glsl"

layout(constant_id = kSpecFirstFree) const uint kGather = 0;          // 1: 2x2 texels by textureGather, 0: one by texelFetch
layout(constant_id = kSpecFirstFree + 1) const uint kSamplesPerLane = 1;  // a multiple of 16
layout(set = 0, binding = 0) uniform texture2DArray atlas;
layout(set = 0, binding = 1) uniform sampler nearest;
layout(set = 0, binding = 2, std430) restrict writeonly buffer Result { float result[]; };

const uint kAtlasSizePx = 1024u;

void main() {
    uint lane = laneIndex();
    uvec2 block = uvec2(gl_WorkGroupID.x, gl_WorkGroupID.x >> 5u) * 32u % (kAtlasSizePx - 32u);
    vec2 first = vec2(block + laneCoordinates(lane)) + 1.0;
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < kSamplesPerLane / 16u; ++i) {
        // The 16 steps are unrolled, so their offsets are constants.
        vec2 row = first + vec2(0.0, float(i & 7u));
        for (uint j = 0u; j < 16u; ++j) {
            vec2 at = row + vec2(float(j & 3u) * 5.0, float(j >> 2u) * 3.0);
            if (kGather != 0u) {
                sum += textureGather(sampler2DArray(atlas, nearest), vec3(at * (1.0 / float(kAtlasSizePx)), 0.0));
            } else {
                sum.x += texelFetch(atlas, ivec3(ivec2(at), 0), 0).x;
            }
        }
    }
    if (dot(sum, vec4(1.0)) < 0.0) result[0] = sum.x;  // never, but no compiler knows that
}
