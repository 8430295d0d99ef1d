#version 460
// The visibility of one light as the lighting passes read it after phase 4, for comparison with the truth. It comes
// from the final lists and slots, and is evaluated where an entry says so. One work group per shadow tile.
#extension GL_GOOGLE_include_directive : require
#include "shading/evaluate_lights.glsl"

layout(local_size_x = 64) in;
layout(set = 3, binding = 0, r32f) uniform restrict writeonly image2D visibilityPicture;
layout(push_constant) uniform Push { uint hostIndex; };

const float kNotReached = -1.0;

// Index among the view's lights, or their number.
uint viewLight() {
    uint i = 0u;
    while (i < frame.lightCount && lights[i].hostIndex != hostIndex) ++i;
    return i;
}

float visibilityAt(uvec2 pixel) {
    Receiver receiver = receiverAt(pixel);
    uint wanted = viewLight();
    vec3 toLight;
    if (!receiver.valid || wanted == frame.lightCount) return kNotReached;
    if (!lightReaches(lights[wanted], receiver.positionWs, receiver.mask, toLight)) return kNotReached;
    LightWalk walk = beginLightWalk(pixel);
    uint lightIndex, entry;
    while (nextLight(walk, lightIndex, entry)) {
        if (lightIndex == wanted) return walkVisibility(entry, pixel, lights[wanted], receiver, toLight);
    }
    return 0.0;  // not in the list: dark all over the tile
}

void main() {
    uvec2 local = uvec2(gl_LocalInvocationID.x % kShadowTileSizePx, gl_LocalInvocationID.x / kShadowTileSizePx);
    uvec2 pixel = gl_WorkGroupID.xy * kShadowTileSizePx + local;
    if (any(greaterThanEqual(pixel, frame.extentPx))) return;
    imageStore(visibilityPicture, ivec2(pixel), vec4(visibilityAt(pixel)));
}
