// Depth bias: where the point to be tested moves before it is compared with a shadowmap.
//
// Problem: a shadowmap holds one depth per texel; a surface seen at a slant is above it on one side of the texel and
// below it on the other, and shadows itself.
// Source: the paper, section 4.2: a constant, 2 mm by default, in *linear* depth along the light's view axis. The slant
// within a filter's footprint is met by moving the point along its face normal n: a footprint that reaches r texels of t
// metres each way along the view's axes X and Y touches points of the receiver's plane that lie up to
// r t (|n.X| + |n.Y|) above the point, measured along n.
// Limits: the offset grows with the filter's width and the texel's size, so contact shadows of wide filters at low
// resolution begin late.
#ifndef GNOMON_DEPTH_BIAS_DEPTH_BIAS_GLSL
#define GNOMON_DEPTH_BIAS_DEPTH_BIAS_GLSL

#include "gpu_interface/structs.h"
#include "shading/receiver.glsl"

// Rasterizers snap vertices to 2^-4 (SwiftShader) to 2^-8 of a texel, which tilts faces that look straight at the light.
const float kLeastSlant = 0.1;

// Metres; `texelMetres` at the receiver, `filterRadius` in texels.
vec3 normalOffset(GpuShadowView view, Receiver receiver, vec3 toLight, float texelMetres, float filterRadius) {
    precise vec3 n = receiver.faceNormalWs;
    precise vec3 x = vec3(view.clipFromWorld[0].x, view.clipFromWorld[1].x, view.clipFromWorld[2].x);
    precise vec3 y = vec3(view.clipFromWorld[0].y, view.clipFromWorld[1].y, view.clipFromWorld[2].y);
    precise float slant = abs(dot(n, x)) * inversesqrt(dot(x, x)) + abs(dot(n, y)) * inversesqrt(dot(y, y));
    precise float metres = texelMetres * (filterRadius + 1.0) * max(slant, kLeastSlant);
    precise vec3 offset = n * (dot(n, toLight) >= 0.0 ? metres : -metres);
    return offset;
}

// How far the point moves toward the light along the light's view axis, metres.
float linearBias(GpuLight light, Receiver receiver) {
    return receiver.subsurface ? max(light.biasMetres, frame.shadows.x) : light.biasMetres;
}

// What float rounding may make of a device depth, in the map and here: 16 steps of its terms. With reversed Z that is
// 20 micrometres at 20 m; with standard Z and a near plane of 5 cm, 16 mm, and no smaller bias could hold there.
float deviceDepthSlack(GpuShadowView view, float depth) {
    precise float slack = 1e-6 * (abs(view.depthFromLinearA) + abs(depth - view.depthFromLinearA));
    return slack;
}

#endif
