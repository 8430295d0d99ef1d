// The kernel of a soft shadow: where its taps lie in the map.
#ifndef GNOMON_VISIBILITY_PCSS_KERNEL_GLSL
#define GNOMON_VISIBILITY_PCSS_KERNEL_GLSL

#include "visibility/shadowmap.glsl"

// Nearer blockers are searched for as if they were at this share of the receiver's depth.
const float kNearestBlocker = 0.1;
// A texel that touches a tap's bilinear footprint is at most this far aside.
const float kTapTexels = 1.5;

struct PcssKernel {
    vec2 right;   // texels per tangent (perspective) or per metre, along the pattern's axes, which the pixel turns, in
    vec2 down;    // the disk that the receiver sees
    float texel;     // one texel in the unit of radii
    float widest;    // radius of the search, without its margin of a texel
    float radius0;   // radius of the source's disk at depth d: radius0 + radius1 * d, radius1 at least 0
    float radius1;
    bool cube;  // point light: taps that leave the face look at another
};

// Cosine and sine. 32 bits are a turn; in whole numbers, since every pipeline must have the same.
vec2 turnOf(uvec2 pixel) {
    uint turn = pixel.x * 3242174889u + pixel.y * 2447445414u + frame.patternTurn;
    precise float f = float((turn << 2u) >> 8u) * (1.0 / 16777216.0);
    precise float t = (2.0 * f - 1.0) * 0.41421356;  // tangent of half an angle within 45 degrees
    precise float inverse = 1.0 / (1.0 + t * t);
    precise vec2 d = vec2((1.0 - t * t) * inverse, 2.0 * t * inverse);
    uint quadrant = turn >> 30u;
    if ((quadrant & 1u) != 0u) d = vec2(-d.y, d.x);
    return (quadrant & 2u) != 0u ? -d : d;
}

// Off the view's axis the disk, which faces the receiver, is stretched outward.
void placeDisk(ShadowPoint s, vec2 pxPerUnit, vec2 turn, inout PcssKernel k) {
    precise float stretch = 1.0 / (1.0 + rayLength(s.tangent));
    precise vec2 across = s.tangent * stretch;
    precise vec2 x = vec2(fma(s.tangent.x, across.x, 1.0), s.tangent.x * across.y) * pxPerUnit;
    precise vec2 y = vec2(s.tangent.x * across.y, fma(s.tangent.y, across.y, 1.0)) * pxPerUnit;
    precise vec2 right = x * turn.x + y * turn.y;
    precise vec2 down = y * turn.x - x * turn.y;
    k.right = right;
    k.down = down;
}

// One texel of a view in the unit of radii: tangents, or metres.
float texelOf(uint viewIndex) {
    vec2 pxPerUnit = shadowViews[viewIndex].pxPerMetre;
    precise float texel = 1.0 / max(pxPerUnit.x, pxPerUnit.y);
    return texel;
}

PcssKernel pcssKernelOf(GpuLight light, ShadowPoint s, uvec2 pixel) {
    precise float a = shadowViews[s.view].depthFromLinearA;
    precise float inverseB = 1.0 / shadowViews[s.view].depthFromLinearB;
    vec2 pxPerUnit = shadowViews[s.view].pxPerMetre;
    precise float r = light.sourceRadius;
    PcssKernel k;
    precise float radius0, radius1, widest;
    if (isOrthographicView(shadowViews[s.view])) {
        radius1 = -r * inverseB * s.sign;
        radius0 = r * (s.linear + a * inverseB);
        widest = max(s.sign > 0.0 ? radius0 + radius1 : radius0, 0.0);
    } else {
        precise float seen = r / s.linear;
        radius1 = r * inverseB * s.sign;
        radius0 = -r * (a * inverseB) - seen;
        widest = (1.0 / kNearestBlocker - 1.0) * seen;
    }
    float texel = texelOf(s.view);
    precise float cut = min(widest, float(kMaxPcssRadiusPx) * texel);
    placeDisk(s, pxPerUnit, turnOf(pixel), k);
    k.texel = texel;
    k.widest = cut;
    k.radius0 = radius0;
    k.radius1 = radius1;
    k.cube = hasShadowViews(light, kShadowViewsSixFaces);
    return k;
}

// The kernel's axes, in texels, times what scales the pattern of a tap.
struct TapAxes {
    vec2 right;
    vec2 down;
};

TapAxes tapAxes(PcssKernel k, float scale) {
    precise vec2 right = k.right * scale;
    precise vec2 down = k.down * scale;
    return TapAxes(right, down);
}

// Where a tap's footprint of 2x2 texels begins, in the atlas. `pattern`: frame.pcssPattern.
vec2 tapCorner(ShadowPoint s, TapAxes axes, vec2 pattern) {
    precise vec2 corner = fma(axes.down, vec2(pattern.y), fma(axes.right, vec2(pattern.x), s.corner));
    return corner;
}

// The greatest whole number that is not above a place in an atlas. Of whole numbers themselves it may be the one
// below: then the footprint is another, but a bilinear weight of 1 takes the same texel. Two additions where floor()
// takes a slow unit of the GPU.
// Tried and dropped: places told from a texel beside the receiver, which saves six instructions a tap. It keeps eight
// registers more, and was no faster (NVIDIA H100).
vec2 floorOfTap(vec2 corner) {
    const float kWhole = 12582912.0;  // 1.5 * 2^23: floats there have no fraction
    precise vec2 shifted = (corner - 0.5) + kWhole;
    precise vec2 whole = shifted - kWhole;
    return whole;
}

// Moved so that its footprint stays in the rectangle.
vec2 cornerInside(ShadowPoint s, vec2 corner) { return clamp(corner, s.rectMin + 0.5, s.rectMax - 1.5); }

// Half the sides of a box that holds the texels of all taps within a radius.
vec2 tapExtent(PcssKernel k, float radius) {
    return radius * (abs(k.right) + abs(k.down)) + kTapTexels;
}

bool mayLeave(ShadowPoint s, PcssKernel k, float radius) {
    vec2 extent = tapExtent(k, radius);
    return any(lessThan(s.corner + 0.5 - extent, s.rectMin)) || any(greaterThan(s.corner + 0.5 + extent, s.rectMax));
}

#include "visibility/cube_faces.glsl"

#endif
