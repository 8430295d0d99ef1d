// Oriented depth bias: at which depth a receiver is compared with each texel of a shadowmap.
//
// Problem: a shadowmap holds one depth per texel, that of the texel's centre; a surface seen at a slant is above it on
// one side of the texel and below it on the other, and shadows itself.
// Source: the paper, section 4: a constant, 2 mm by default, in *linear* depth along the light's view axis; slopes are
// met at each texel by the receiver's own face plane.
// Plain way: a hardware bias by slope, in device depth, as large as the widest kernel on the steepest face needs.
// Here: device depth is affine in a texel's position along any plane, with perspective (A + B / z, and 1 / z is affine)
// as without. So one depth and one slope per pixel give the plane's depth at every texel's centre: what the rasterizer
// stored there, if nothing is nearer.
// Limits: the slope of faces that are nearly edge-on to the light is cut at kLeastCosine (1.1 degrees). The map
// holds the surface as the rasterizer snapped it, 2^-4 (SwiftShader) to 2^-8 texels aside, hence the slack by slope.
#ifndef GNOMON_DEPTH_BIAS_DEPTH_BIAS_GLSL
#define GNOMON_DEPTH_BIAS_DEPTH_BIAS_GLSL

#include "gpu_interface/structs.h"
#include "shading/receiver.glsl"

const float kLeastCosine = 0.02;
const float kSnapPx = 1.0 / 16.0;

// |rays| of a view through ndc, as a multiple of linear depth; `tangent` is where: lateral over linear depth.
float rayLength(vec2 tangent) {
    precise float squared = tangent.x * tangent.x + (tangent.y * tangent.y + 1.0);
    return sqrt(squared);
}

// Slope of the device depth of the plane through the receiver with face normal n, per texel. `ndc`, `linear` and
// `tangent` are the receiver's in the view.
vec2 planeSlope(GpuShadowView view, bool orthographic, vec3 n, vec2 ndc, float linear, vec2 tangent) {
    vec3 x = vec3(view.clipFromWorld[0].x, view.clipFromWorld[1].x, view.clipFromWorld[2].x);
    vec3 y = vec3(view.clipFromWorld[0].y, view.clipFromWorld[1].y, view.clipFromWorld[2].y);
    vec3 z = orthographic ? vec3(view.clipFromWorld[0].z, view.clipFromWorld[1].z, view.clipFromWorld[2].z) /
                                view.depthFromLinearB
                          : vec3(view.clipFromWorld[0].w, view.clipFromWorld[1].w, view.clipFromWorld[2].w);
    precise vec3 xy = cross(x, y);
    precise vec2 m = vec2(dot(n, cross(y, z)), dot(n, cross(z, x)));
    precise float mz = dot(n, xy);
    precise float k = orthographic ? mz : m.x * ndc.x + (m.y * ndc.y + mz);
    precise float least = kLeastCosine * sqrt(dot(xy, xy)) * (orthographic ? 1.0 : rayLength(tangent));
    if (abs(k) < least) k = k < 0.0 ? -least : least;
    precise float perNdc = orthographic ? -view.depthFromLinearB / k : view.depthFromLinearB / (linear * k);
    precise vec2 slope = m * perNdc / view.pxFromNdcScale;
    return slope;
}

// How far the point moves toward the light along the light's view axis, metres.
float linearBias(GpuLight light, Receiver receiver) {
    return receiver.subsurface ? max(light.biasMetres, frame.shadows.x) : light.biasMetres;
}

// What float rounding may make of a device depth, in the map and here: 16 steps of its terms, and the rasterizer's
// snapping. With reversed Z the first is 20 micrometres at 20 m; with standard Z and a near plane of 5 cm, 16 mm, and
// no smaller bias could hold there.
float deviceDepthSlack(GpuShadowView view, float depth, vec2 slope) {
    precise float rounding = 1e-6 * (abs(view.depthFromLinearA) + abs(depth - view.depthFromLinearA));
    precise float slack = rounding + kSnapPx * (abs(slope.x) + abs(slope.y));
    return slack;
}

#endif
