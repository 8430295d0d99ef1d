// Visibility provider "pcf": percentage closer filtering, (2r + 1)^2 bilinear comparisons.
//
// Source: Reeves, Salesin, Cook 1987, "Rendering Antialiased Shadows with Depth Maps".
// Plain way: (2r + 1)^2 hardware comparisons with bilinear filtering. Their weights are a driver's own 8-bit ones, and
// each compares one depth with four texels.
// Here: their sum is a weighted sum over (2r + 2)^2 texels. The weight is 1 - f at the first row and column, f at the
// last, and 1 between. (r + 1)^2 gathers fetch the texels. Each texel is compared with the receiver's plane at its own
// centre. The weights are exact, so that every pipeline and device agrees.
#ifndef GNOMON_VISIBILITY_PCF_GLSL
#define GNOMON_VISIBILITY_PCF_GLSL

#include "visibility/shadowmap.glsl"

float pcfVisibility(ShadowPoint s) {
    float border = float(kPcfRadius) + 1.0;
    precise vec2 corner = clamp(s.corner, s.rectMin + border - 0.5, s.rectMax - border - 0.5) - float(kPcfRadius);
    precise vec2 first = floor(corner);
    precise vec2 f = corner - first;
    precise float sum = 0.0;
    for (uint j = 0u; j <= kPcfRadius; ++j) {
        precise float top = j == 0u ? 1.0 - f.y : 1.0;
        precise float bottom = j == kPcfRadius ? f.y : 1.0;
        for (uint i = 0u; i <= kPcfRadius; ++i) {
            precise float left = i == 0u ? 1.0 - f.x : 1.0;
            precise float right = i == kPcfRadius ? f.x : 1.0;
            vec2 texel = first + 2.0 * vec2(i, j);
            float base = endlessPlaneDepthAt(s, texel);
            vec4 stored = storedInFootprint(s, gatherFootprint(s, texel), base);
            vec4 lit = vec4(lessThanEqual(stored, planeInFootprint(s, base)));
            sum += bottom * (left * lit.x + right * lit.y) + top * (right * lit.z + left * lit.w);
        }
    }
    const float taps = float((2u * kPcfRadius + 1u) * (2u * kPcfRadius + 1u));
    precise float visibility = sum / taps;
    return visibility;
}

#endif
