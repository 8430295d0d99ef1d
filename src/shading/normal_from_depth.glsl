// Face normals from the host's depth, for hosts that store none.
//
// Problem: neighbours on another face or surface bend the normal. A wrong normal is a wrong plane for all texels of a
// shadow, or a face that seems to look away.
// Plain way: the cross product of the shorter one-sided differences of positions.
// Here: device depth is affine in the pixel along any plane (see visibility/depth_bias.glsl). So of three pixels in a
// row on one face, the second difference is nothing but rounding. Each axis has three such rows that hold the pixel:
// ahead, behind and between.
// - If none of them bends, all five pixels tell the slope, which evens the rounding out tenfold.
// - Else each row tells it, weighted by how little it bends.
// - Beside a silhouette the rows bend as curved surfaces do, and their slope is continued to the pixel.
// The normal follows from the slopes without a difference of positions.
// Limits: faces that are less than three pixels wide or high. Where no row is near to straight, as on a pole of one
// pixel, the slope is taken for that of a face across the view.
#ifndef GNOMON_SHADING_NORMAL_FROM_DEPTH_GLSL
#define GNOMON_SHADING_NORMAL_FROM_DEPTH_GLSL

#include "gpu_interface/receivers_set.glsl"
#include "shading/frame.glsl"

const float kUnusable = 1e9;      // as a depth: no neighbour
const float kSteepest = 8.0;      // tangent between a face and the view plane that a bent row may tell: 83 degrees
const float kRowRoundings = 4.0;  // what is left of a straight row's second difference, in roundings of its depths
const float kSilhouette = 3.0;    // times as bent is the row across, where a surface ends beside the pixel

float hostDepthAt(uvec2 pixel) { return texelFetch(hostDepth, ivec2(pixel + frame.viewportPx), 0).x; }

// kUnusable beyond the extent and at background.
float neighbourDepth(ivec2 pixel) {
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(frame.extentPx)))) return kUnusable;
    float d = hostDepthAt(uvec2(pixel));
    return isBackground(d) ? kUnusable : d;
}

// Metres of view depth per unit of device depth.
float metresPerDevice(float d) {
    vec2 n = frame.viewDepthNumerator;
    vec2 m = frame.viewDepthDenominator;
    precise float w = m.x * d + m.y;
    precise float metres = (n.x * m.y - n.y * m.x) / (w * w);
    return metres;
}

float weightOf(float bend, float least) {
    precise float share = least / bend;
    precise float weight = share * share;
    return weight;
}

// Slope of the device depth per pixel along an axis, at a pixel of depth d. `rounding`: what rounding may make of d.
// `steep`: the slope of the steepest face that a bent row may tell.
float depthSlope(ivec2 pixel, ivec2 axis, float d, float rounding, float steep) {
    float a1 = neighbourDepth(pixel + axis), a2 = neighbourDepth(pixel + 2 * axis);
    float b1 = neighbourDepth(pixel - axis), b2 = neighbourDepth(pixel - 2 * axis);
    precise float ahead = a1 - d;
    precise float behind = d - b1;
    precise float between = 0.5 * (a1 - b1);
    precise float turnAhead = ahead - (a2 - a1);
    precise float turnBehind = behind - (b1 - b2);
    precise vec3 bend = abs(vec3(turnAhead, turnBehind, ahead - behind));
    if (max(max(bend.x, bend.y), bend.z) <= kRowRoundings * rounding) {
        precise float slope = (2.0 * (a2 - b2) + (a1 - b1)) * 0.1;
        return slope;
    }
    float sides = min(bend.x, bend.y);
    float least = min(sides, bend.z);
    if (least > steep) {
        float shorter = abs(ahead) <= abs(behind) ? ahead : behind;
        return abs(shorter) > steep ? 0.0 : shorter;
    }
    precise vec3 weighed = bend + rounding;
    precise float known = least + rounding;
    float wa = weightOf(weighed.x, known), wb = weightOf(weighed.y, known), wc = weightOf(weighed.z, known);
    float on = bend.z > kSilhouette * sides ? 0.5 : 0.0;  // a one-sided slope is that of half a pixel aside
    precise float sum = wa * (ahead + on * turnAhead) + (wb * (behind + on * turnBehind) + wc * between);
    precise float slope = sum / (wa + (wb + wc));
    return slope;
}

// Toward the camera. `viewDepth` and `rounding` belong to the pixel's depth d.
vec3 faceNormalFromDepth(uvec2 pixel, float d, float viewDepth, float rounding) {
    precise vec2 tangentPerSlope = metresPerDevice(d) / frame.viewXyPerPixel;
    if (!isOrthographic()) tangentPerSlope /= viewDepth;
    precise vec2 steep = abs(kSteepest / tangentPerSlope);
    precise vec2 slope = vec2(depthSlope(ivec2(pixel), ivec2(1, 0), d, rounding, steep.x),
                              depthSlope(ivec2(pixel), ivec2(0, 1), d, rounding, steep.y));
    precise vec2 tangent = slope * tangentPerSlope;
    precise float toward = 1.0;
    if (!isOrthographic()) {
        precise vec2 xy = (vec2(pixel) + 0.5) * frame.viewXyPerPixel + frame.viewXyAtPixel0;
        toward = 1.0 + (xy.x * tangent.x + xy.y * tangent.y);
    }
    precise vec3 n = frame.axisXWs * tangent.x + (frame.axisYWs * tangent.y - frame.axisZWs * toward);
    precise float squared = n.x * n.x + (n.y * n.y + n.z * n.z);
    precise vec3 unit = n * inversesqrt(squared);
    return unit;
}

#endif
