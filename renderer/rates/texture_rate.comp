#version 460
// Samples a shadow atlas as the filters do, from texture caches, with as little arithmetic around it as possible.
//
// Problem: how many samples a second can a device take? A loop that asks this easily measures something else. If
// results are not used, or places come back after a few steps, a compiler takes fewer samples than are written. If
// places are costly to find, arithmetic is measured.
// Here:
// 1. Every lane stores the xor of all it has read. A test compares it with the same by the CPU.
// 2. A place costs few instructions. For RDNA2, RADV makes three vector instructions beside a coherent fetch, and
//    eleven beside a scattered gather.
// 3. Four samples at a time do not depend on each other.
// 4. Coherent: the lanes of a group read an 8x8 tile, which moves as a whole. Neighbours read neighbouring texels, as
//    pixels do that look up one texel each. Scattered: each lane has a place of its own in a square of 32x32 texels, as
//    the taps of soft shadows have.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "renderer/rates/sample_pattern.h"
#include "vulkan/work_group.glsl"

layout(constant_id = kSpecRateGathers) const uint kGathers = 0;
layout(constant_id = kSpecRateScattered) const uint kScattered = 0;
layout(set = 0, binding = 0) uniform texture2DArray atlas;
layout(set = 0, binding = 1) uniform sampler nearest;
layout(set = 0, binding = 2, std430) restrict writeonly buffer Result { uint result[]; };  // by group and lane
layout(push_constant) uniform Amount { uint rounds; };

uint scrambled(uint x) {
    x = (x ^ (x >> 16u)) * 0x7FEB352Du;
    x = (x ^ (x >> 15u)) * 0x846CA68Bu;
    return x ^ (x >> 16u);
}

uint sampleBits(uvec2 own, uint place) {
    uvec2 texel = own + uvec2(place >> kRateXShift, bitfieldExtract(place, int(kRateYShift), int(kRateReachBits)));
    if (kGathers == 0u) return floatBitsToUint(texelFetch(atlas, ivec3(texel, 0), 0).x);
    const float perTexel = 1.0 / float(kRateAtlasSizePx);
    vec2 at = vec2(texel) * perTexel + perTexel;  // between the 2x2 texels; exact, since this is a power of two
    uvec4 bits = floatBitsToUint(textureGather(sampler2DArray(atlas, nearest), vec3(at, 0.0)));
    return bits.x ^ bits.y ^ bits.z ^ bits.w;
}

void main() {
    uint group = gl_WorkGroupID.x;
    uint lane = laneIndex();
    uint index = group * kWorkGroupSize + lane;
    uvec2 tile = uvec2(group, group / kRateTilesPerRow) % kRateTilesPerRow;
    uvec2 own = tile * kShadowTileSizePx + laneCoordinates(lane);
    uint place = scrambled(kScattered != 0u ? index : group);
    uint bits = 0u;
    for (uint i = 0u; i < rounds; ++i) {
        uint a = sampleBits(own, place);
        uint b = sampleBits(own, place + kRateStep);
        uint c = sampleBits(own, place + 2u * kRateStep);
        uint d = sampleBits(own, place + 3u * kRateStep);
        place += kRateSamplesPerRound * kRateStep;
        bits ^= a ^ b ^ c ^ d;
    }
    result[index] = bits;
}
