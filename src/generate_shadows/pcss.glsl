// Visibility provider "pcss": percentage closer soft shadows, the penumbra of a light with a size.
//
// Problem: a shadow is sharp where it touches its blocker and widens with the distance from it.
// Source: Fernando 2005, "Percentage-Closer Soft Shadows". Its penumbra is (z - zb) / zb times the source's size.
// Plain way: average the blockers in a region of fixed width, then average comparisons in a region as wide as the
// penumbra of that average.
// Here: (1) The disk that the source is, seen from the receiver through the map, is a disk whose radius is linear in the
// blocker's *device* depth, with and without perspective: one multiplication per stored depth. So (2) each blocker is
// asked whether it lies in the disk of its own depth, which makes a wide search harmless: what the source cannot see does
// not count. (3) Search taps, four texels each, crowd toward the middle (radius by the square), where near blockers must
// be found; filter taps are spread evenly, each a bilinear comparison. (4) A pixel in which no texel of the search is a
// blocker is lit, one in which all occlude is dark.
// Shadow bounds, where the host has them made, tell that of most pixels before any tap.
// (5) The pattern is a spiral of golden angles, turned per pixel by a sequence of low discrepancy in whole numbers: every
// pipeline and device sees the same one. (6) A blocker is nearer to the light than the receiver: a tap's plane depth
// grows beyond the receiver's by one texel's slope at most, else walls behind the receiver would shadow it.
// Limits: one depth per texel stands for all blockers behind each other; radii beyond kMaxPcssRadiusPx texels are cut.
#ifndef GNOMON_GENERATE_SHADOWS_PCSS_GLSL
#define GNOMON_GENERATE_SHADOWS_PCSS_GLSL

#include "generate_shadows/golden_spiral.glsl"
#include "generate_shadows/shadowmap.glsl"
#include "shadow_bounds/shadow_bounds.glsl"

// Loops over taps count to frame.random.z and w, which are the same numbers: a compiler that knew them would unroll the
// loops, at the cost of registers.
layout(constant_id = 5) const uint kPcssSearchTaps = 16;
layout(constant_id = 6) const uint kPcssFilterTaps = 24;

// Nearer blockers are searched for as if they were at this share of the receiver's depth.
const float kNearestBlocker = 0.1;
// A texel that touches a tap's bilinear footprint is at most this far aside.
const float kTapTexels = 1.5;

// Depths here are device depths with the sign that makes greater ones nearer to the light.
struct PcssKernel {
    vec2 corner;  // the receiver's place less half a texel: whole numbers there are texels
    vec2 right;   // texels per tangent (perspective) or per metre, along the pattern's axes, which the pixel turns, in
    vec2 down;    // the disk that the receiver sees
    float sign;
    float depth;  // of the receiver's plane at the receiver,
    vec2 slope;   // per texel,
    float least;  // and its least value: at most one texel's slope behind the receiver
    float texel;     // one texel in the unit of radii
    float widest;    // radius of the search, without its margin of a texel
    float radius0;   // radius of the source's disk at depth d: radius0 + radius1 * d, radius1 at least 0
    float radius1;
    bool cube;  // point light: taps that leave the face look at another
};

// Cosine and sine. 32 bits are a turn; in whole numbers, since every pipeline must have the same.
vec2 turnOf(uvec2 pixel) {
    uint turn = pixel.x * 3242174889u + pixel.y * 2447445414u + frame.random.y;
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

PcssKernel pcssKernelOf(GpuLight light, ShadowPoint s, uvec2 pixel) {
    precise float a = shadowViews[s.view].depthFromLinearA;
    precise float inverseB = 1.0 / shadowViews[s.view].depthFromLinearB;
    vec2 pxPerUnit = shadowViews[s.view].pxPerMetre;
    precise float r = light.sourceRadius;
    PcssKernel k;
    k.sign = s.reversedZ ? 1.0 : -1.0;
    precise float radius0, radius1, widest;
    if (isOrthographicView(shadowViews[s.view])) {
        radius1 = -r * inverseB * k.sign;
        radius0 = r * (s.linear + a * inverseB);
        widest = max(s.reversedZ ? radius0 + radius1 : radius0, 0.0);
    } else {
        precise float seen = r / s.linear;
        radius1 = r * inverseB * k.sign;
        radius0 = -r * (a * inverseB) - seen;
        widest = (1.0 / kNearestBlocker - 1.0) * seen;
    }
    precise float texel = 1.0 / max(pxPerUnit.x, pxPerUnit.y);
    precise float cut = min(widest, float(kMaxPcssRadiusPx) * texel);
    precise float behind = s.depth * k.sign - (abs(s.slope.x) + abs(s.slope.y));
    precise vec2 corner = s.px - 0.5;
    placeDisk(s, pxPerUnit, turnOf(pixel), k);
    k.corner = corner;
    k.depth = s.depth * k.sign;
    k.slope = s.slope * k.sign;
    k.least = max(behind, s.reversedZ ? 0.0 : -1.0);
    k.texel = texel;
    k.widest = cut;
    k.radius0 = radius0;
    k.radius1 = radius1;
    k.cube = lightType(light) == kLightPoint;
    return k;
}

// Tap `i` at radius 1, in texels from the receiver.
vec2 tapOffset(PcssKernel k, uint i) {
    precise vec2 offset = vec2(fma(k.right.x, kGoldenSpiral[i].x, k.down.x * kGoldenSpiral[i].y),
                               fma(k.right.y, kGoldenSpiral[i].x, k.down.y * kGoldenSpiral[i].y));
    return offset;
}

// Half the sides of a box that holds the texels of all taps within a radius.
vec2 tapExtent(PcssKernel k, float radius) {
    return radius * (abs(k.right) + abs(k.down)) + kTapTexels;
}

bool mayLeave(ShadowPoint s, PcssKernel k, float radius) {
    vec2 extent = tapExtent(k, radius);
    return any(lessThan(s.px - extent, s.rectMin)) || any(greaterThan(s.px + extent, s.rectMax));
}

#include "generate_shadows/point_faces.glsl"

// The receiver's plane and the map at the four texels around `corner`, which is a place less half a texel.
vec4 planeDepthsAt(PcssKernel k, vec2 first) {
    precise vec2 away = first - k.corner;
    precise float depth = fma(k.slope.x, away.x, fma(k.slope.y, away.y, k.depth));
    precise vec4 depths = depth + vec4(k.slope.y, k.slope.x + k.slope.y, k.slope.x, 0.0);
    return max(depths, vec4(k.least));
}

// What a search has found.
struct Blockers {
    float blocking;  // texels
    float depths;    // sum over them
    bool allOcclude;
};

// `farthest`: what is stored farther from the light than this is out of the source's sight at the tap's radius.
void countBlockers(vec4 plane, vec4 stored, float farthest, inout Blockers found) {
    found.allOcclude = found.allOcclude && all(greaterThan(stored, plane));
    precise vec4 blocks = vec4(greaterThan(stored, max(plane, vec4(farthest))));
    precise float blocking = found.blocking + ((blocks.x + blocks.y) + (blocks.z + blocks.w));
    precise float depths = fma(blocks.x, stored.x, found.depths);
    depths = fma(blocks.y, stored.y, depths);
    depths = fma(blocks.z, stored.z, depths);
    depths = fma(blocks.w, stored.w, depths);
    found.blocking = blocking;
    found.depths = depths;
}

// What the shadow bounds tell of a search of radius `reach` that stays in the rectangle. True where they tell all. Else
// `needed` is the radius beyond which no blocker can be: the nearest depth in the region bounds what the source can see
// of it, and a smaller region may hold only farther ones.
bool knownByBounds(ShadowPoint s, PcssKernel k, float reach, out float needed, out float visibility) {
    needed = reach;
    visibility = 1.0;
    for (uint i = 0u; i < 2u; ++i) {
        vec2 extent = tapExtent(k, needed);
        bool known;
        vec2 bounds = shadowBoundsOver(s.view, s.px - extent, s.px + extent, known);
        if (!known) return false;
        float nearest = s.reversedZ ? bounds.y : -bounds.x;
        float farthest = s.reversedZ ? bounds.x : -bounds.y;
        float rise = dot(abs(k.slope), extent);
        float slack = 1e-6 + 1e-5 * rise;  // the taps' own rounding
        if (nearest <= max(k.depth - rise - slack, k.least)) return true;
        visibility = 0.0;
        if (i == 0u && farthest > max(k.depth + rise + slack, k.least)) return true;
        visibility = 1.0;
        // The region of the source grows toward the light.
        float seen = fma(k.radius1, nearest, k.radius0) + kTapTexels * k.texel;
        seen += 1e-5 * abs(seen) + 1e-6 * (abs(k.radius0) + k.radius1);
        if (!(seen < needed)) return false;
        needed = max(seen, 0.0);
    }
    return false;
}

float searchRadius(uint tap, float reach) {
    precise float share = (float(tap) + 0.5) * (1.0 / float(kPcssSearchTaps));
    precise float radius = share * share * reach;
    return radius;
}

// The filter's radius; or below 0 where no filter is needed, and then `visibility` is known. Two loops: where all taps
// stay inside the rectangle, nothing stands between the texture reads.
float searchBlockers(GpuLight light, ShadowPoint s, PcssKernel k, out float visibility) {
    precise float reach = k.widest + k.texel;
    // A depth is in the source's sight at a radius from (radius - radius0 - margin) / radius1 on.
    precise float inverse = k.radius1 > 0.0 ? 1.0 / k.radius1 : 0.0;
    precise float farthest0 = k.radius1 > 0.0 ? -(k.radius0 + kTapTexels * k.texel) * inverse : -2.0;
    Blockers found = Blockers(0.0, 0.0, true);
    if (!mayLeave(s, k, reach)) {
        float needed;
        if (knownByBounds(s, k, reach, needed, visibility)) return -1.0;
        for (uint i = 0u; i < frame.random.z; ++i) {
            float radius = searchRadius(i, reach);
            if (radius > needed && !found.allOcclude) break;  // beyond, there is no blocker
            vec2 offset = tapOffset(k, i);
            precise vec2 first = floor(fma(offset, vec2(radius), k.corner));
            vec4 stored = gatherShadowTexels(s, first) * k.sign;
            countBlockers(planeDepthsAt(k, first), stored, fma(radius, inverse, farthest0), found);
        }
    } else {
        for (uint i = 0u; i < frame.random.z; ++i) {
            float radius = searchRadius(i, reach);
            vec2 offset = tapOffset(k, i);
            precise vec2 corner = fma(offset, vec2(radius), k.corner);
            vec4 plane, stored;
            if (leavesFace(s, k, corner)) {
                float planeThere, storedThere;
                otherFace(light, s, k, corner + 0.5, planeThere, storedThere);
                plane = vec4(planeThere);
                stored = vec4(storedThere);
            } else {
                precise vec2 first = floor(clamp(corner, s.rectMin + 0.5, s.rectMax - 1.5));
                plane = planeDepthsAt(k, first);
                stored = gatherShadowTexels(s, first) * k.sign;
            }
            countBlockers(plane, stored, fma(radius, inverse, farthest0), found);
        }
    }
    visibility = found.allOcclude ? 0.0 : 1.0;
    if (found.blocking == 0.0 || found.allOcclude) return -1.0;
    precise float mean = found.depths / found.blocking;
    precise float radius = clamp(fma(k.radius1, mean, k.radius0), k.texel, max(k.widest, k.texel));
    return radius;
}

float filterTap(ShadowPoint s, PcssKernel k, vec2 corner) {
    precise vec2 first = floor(corner);
    precise vec2 f = corner - first;
    vec4 lit = vec4(lessThanEqual(gatherShadowTexels(s, first) * k.sign, planeDepthsAt(k, first)));
    precise float top = fma(f.x, lit.z - lit.w, lit.w);
    precise float bottom = fma(f.x, lit.y - lit.x, lit.x);
    precise float value = fma(f.y, bottom - top, top);
    return value;
}

float filterPenumbra(GpuLight light, ShadowPoint s, PcssKernel k, float radius) {
    precise float sum = 0.0;
    bool inside = !mayLeave(s, k, radius);
    for (uint i = 0u; i < frame.random.w; ++i) {
        precise float share = sqrt((float(i) + 0.5) * (1.0 / float(kPcssFilterTaps)));
        precise float away = share * radius;
        vec2 offset = tapOffset(k, i);
        precise vec2 corner = fma(offset, vec2(away), k.corner);
        if (!inside && leavesFace(s, k, corner)) {
            float plane, stored;
            otherFace(light, s, k, corner + 0.5, plane, stored);
            sum += stored > plane ? 0.0 : 1.0;
        } else {
            sum += filterTap(s, k, clamp(corner, s.rectMin + 0.5, s.rectMax - 1.5));
        }
    }
    precise float visibility = sum * (1.0 / float(kPcssFilterTaps));
    return visibility;
}

float pcssVisibility(GpuLight light, ShadowPoint s, uvec2 pixel) {
    PcssKernel k = pcssKernelOf(light, s, pixel);
    float visibility;
    float radius = searchBlockers(light, s, k, visibility);
    return radius < 0.0 ? visibility : filterPenumbra(light, s, k, radius);
}

#endif
