// Oriented depth bias: at which depth a receiver is compared with each texel of a shadowmap.
//
// Problem: a shadowmap holds one depth per texel, that of the texel's centre. A surface seen at a slant is above that
// depth on one side of the texel and below it on the other. So it shadows itself.
// Source: the paper, section 4: a constant, 2 mm by default, in *linear* depth along the light's view axis. Slopes are
// met at each texel by the receiver's own face plane, which is ours. So are limits to the constant that go by what the
// view sees: in a scene of 4 mm, 2 mm would be half the scene (ShadowView::mostBias), and at 5 km they are less than
// rasterizers round (ShadowView::leastBias).
// Plain way: a hardware bias by slope, in device depth, as large as the widest kernel on the steepest face needs.
// Here: along any plane, device depth is affine in a texel's position. That holds with perspective (A + B / z, and 1 /
// z is affine) as without. So one depth and one slope per pixel give the plane's depth at every texel's centre. That is
// what the rasterizer stored there, if nothing is nearer.
// The bias grows by how far the rounding of the camera's depth may have moved the position off its face.
// Other modes, to compare:
// - the paper's listing 7: one depth for all texels, nearer to the light or, where the face looks away, farther;
// - no bias at all, for maps that were drawn with a hardware bias.
// Limits: the slope of faces that are nearly edge-on to the light is cut at kLeastCosine (0.3 degrees). The map holds
// the surface as the rasterizer snapped it, 2^-4 (SwiftShader) to 2^-8 texels aside. Hence the slack by slope.
#ifndef GNOMON_VISIBILITY_DEPTH_BIAS_GLSL
#define GNOMON_VISIBILITY_DEPTH_BIAS_GLSL

#include "visibility/depth_bias_mode.glsl"
#include "gpu_interface/structs.h"
#include "shading/light_tests.glsl"
#include "shading/receiver.glsl"

const float kLeastCosine = 0.005;
const float kSnapPx = 1.0 / 16.0;

// Length of the ray through a place of a view, for linear depth 1. `tangent` is the place: lateral over linear depth.
float rayLength(vec2 tangent) {
    precise float squared = tangent.x * tangent.x + (tangent.y * tangent.y + 1.0);
    return sqrt(squared);
}

// Slope per texel of the device depth of a plane: the one through the receiver with face normal n. `ndc`, `linear` and
// `tangent` are the receiver's place in the view. `linearPerMetre`: how much linear depth a metre off the plane is.
vec2 planeSlope(GpuShadowView view, bool orthographic, vec3 n, vec2 ndc, float linear, vec2 tangent,
                out float linearPerMetre) {
    precise vec3 m = vec3(dot(n, view.planeX), dot(n, view.planeY), dot(n, view.planeZ));
    precise float k = orthographic ? m.z : fma(m.x, ndc.x, fma(m.y, ndc.y, m.z));
    float least = kLeastCosine * rayLength(tangent);
    if (abs(k) < least) k = k < 0.0 ? -least : least;
    precise float inverse = 1.0 / (orthographic ? k : k * linear);
    precise float across = abs(orthographic ? inverse : inverse * linear);
    linearPerMetre = across;
    precise vec2 slope = m.xy * vec2(view.planeSlopePerPxX, view.planeSlopePerPxY) * inverse;
    return slope;
}

// How far the point, at a linear depth, moves toward the light along the light's view axis, metres.
float linearBias(GpuShadowView view, bool orthographic, GpuLight light, Receiver receiver, float linear) {
    precise float most = orthographic ? view.mostBias : view.mostBias * max(linear, 0.0);
    precise float least = orthographic ? view.leastBias : view.leastBias * max(linear, 0.0);
    float bias = min(max(light.biasMetres, least), most);
    return receiver.subsurface ? max(bias, frame.subsurfaceBiasMetres) : bias;
}

bool movesTowardLight(GpuLight light, Receiver receiver) {
    vec3 toLight = lightType(light) == kLightDirectional ? -light.directionWs : light.positionWs - receiver.positionWs;
    return receiver.subsurface || facesLight(receiver.faceNormalWs, toLight);
}

// Whether a pixel that a casting light reaches asks the light's shadowmap at all. Else it is dark.
bool asksShadowmap(Receiver receiver, vec3 toLight) {
    return kFacedAwayIsDark == 0u || receiver.subsurface || facesLight(receiver.faceNormalWs, toLight);
}

// What rounding may make of a device depth, in the map and here. It has three parts: 16 steps of a float's terms, a
// step of an atlas of fewer bits, and the rasterizer's snapping. With reversed Z the first is 20 micrometres at 20 m.
// With standard Z and a near plane of 5 cm it is 16 mm, and no smaller bias could hold there.
float deviceDepthSlack(GpuShadowView view, float depth, vec2 slope) {
    precise float rounding = 1e-6 * (abs(view.depthFromLinearA) + abs(depth - view.depthFromLinearA));
    precise float slack = rounding + view.depthStep + kSnapPx * (abs(slope.x) + abs(slope.y));
    return slack;
}

float deviceDepthOf(GpuShadowView view, bool orthographic, float linear) {
    float b = view.depthFromLinearB;
    // |B| is about the near plane's distance. Far before that plane, any depth says that nothing is nearer to the light.
    precise float depth = view.depthFromLinearA + (orthographic ? b * linear : b / max(linear, 1e-3 * abs(b)));
    return depth;
}

// The device depth at which a receiver is compared at its own place in a view, and the slope of its plane there, per
// texel. `ndc`, `linear` and `tangent` are its place in the view.
float biasedDepth(GpuShadowView view, bool orthographic, GpuLight light, Receiver receiver, vec2 ndc, float linear,
                  vec2 tangent, out vec2 slope) {
    slope = vec2(0.0);
    if (kDepthBias == kDepthBiasUnbiased) return deviceDepthOf(view, orthographic, linear);
    float bias = linearBias(view, orthographic, light, receiver, linear);
    // Away from the light, so that what looks away from it rather shadows itself.
    float sign = kFacedAwayIsDark != 0u || movesTowardLight(light, receiver) ? 1.0 : -1.0;
    if (kDepthBias == kDepthBiasOrientedConstant) {
        precise float moved = linear - sign * bias;
        return deviceDepthOf(view, orthographic, moved);
    }
    float linearPerMetre;
    slope = planeSlope(view, orthographic, receiver.faceNormalWs, ndc, linear, tangent, linearPerMetre);
    precise float biased = linear - sign * (bias + receiver.offPlaneMetres * linearPerMetre);
    precise float depth = deviceDepthOf(view, orthographic, biased);
    precise float slack = sign * deviceDepthSlack(view, depth, slope);
    precise float compared = (view.flags & kShadowViewReversedZBit) != 0u ? depth + slack : depth - slack;
    return compared;
}

#endif
