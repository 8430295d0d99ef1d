// Depth bias: where the point to be tested moves before it is compared with a shadowmap.
//
// Problem: a shadowmap holds one depth per texel; a surface seen at a slant is above it on one side of the texel and
// below it on the other, and shadows itself.
// Source: the paper, section 4.2: a constant, 2 mm by default, in *linear* depth along the light's view axis. The slant
// within a filter's footprint is met by moving the point along its face normal by the footprint's size in metres times
// the sine of the angle to the light.
// Limits: the offset grows with the filter's width and the texel's size, so contact shadows of wide filters at low
// resolution begin late.
#ifndef GNOMON_DEPTH_BIAS_DEPTH_BIAS_GLSL
#define GNOMON_DEPTH_BIAS_DEPTH_BIAS_GLSL

#include "gpu_interface/structs.h"
#include "shading/receiver.glsl"

// Metres; `texelMetres` at the receiver, `filterRadius` in texels.
vec3 normalOffset(Receiver receiver, vec3 toLight, float texelMetres, float filterRadius) {
    precise float c = dot(receiver.faceNormalWs, toLight);
    precise float sine = sqrt(max(0.0, 1.0 - c * c));
    precise float metres = texelMetres * (filterRadius + 1.0) * sine;
    precise vec3 offset = receiver.faceNormalWs * (c >= 0.0 ? metres : -metres);
    return offset;
}

// How far the point moves toward the light along the light's view axis, metres.
float linearBias(GpuLight light, Receiver receiver) {
    return receiver.subsurface ? max(light.biasMetres, frame.shadows.x) : light.biasMetres;
}

#endif
