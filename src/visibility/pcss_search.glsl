// The search for blockers of a soft shadow, and what the shadow bounds spare of it.
#ifndef GNOMON_VISIBILITY_PCSS_SEARCH_GLSL
#define GNOMON_VISIBILITY_PCSS_SEARCH_GLSL

#include "visibility/pcss_kernel.glsl"
#include "shadow_bounds/shadow_bounds.glsl"

// Loops over taps count to numbers of the frame, not to constants: a compiler that knew the numbers would unroll the
// loops, at the cost of registers. With one preset there is nothing to choose.
layout(constant_id = kSpecPcssPresets) const uint kPcssPresets = 1;

uint pcssPresetOf(GpuLight light) {
    return kPcssPresets == 1u ? 0u : light.typeAndFlags >> kLightPcssPresetShift & kLightPcssPresetMask;
}

// What a search has found.
struct Blockers {
    float blocking;  // texels
    float depths;    // sum over them, without the sign
    bool allOcclude;
};

// A footprint (visibility/shadowmap.glsl). `stored`: without the sign.
// `farthest`: what is stored farther from the light than this is out of the source's sight at the tap's radius.
void countBlockers(ShadowPoint s, vec4 stored, float base, vec4 plane, float farthest, inout Blockers found) {
    vec4 above = storedInFootprint(s, stored, base);
    precise float seenAbove = farthest - base;
    bvec4 occludes = greaterThan(above, plane);
    bvec4 seen = greaterThan(above, vec4(seenAbove));
    found.allOcclude = found.allOcclude && all(occludes);
    precise vec4 blocks = vec4(occludes.x && seen.x, occludes.y && seen.y, occludes.z && seen.z, occludes.w && seen.w);
    precise float blocking = found.blocking + ((blocks.x + blocks.y) + (blocks.z + blocks.w));
    precise float depths = fma(blocks.x, stored.x, found.depths);
    depths = fma(blocks.y, stored.y, depths);
    depths = fma(blocks.z, stored.z, depths);
    depths = fma(blocks.w, stored.w, depths);
    found.blocking = blocking;
    found.depths = depths;
}

void countFootprint(ShadowPoint s, vec2 first, float farthest, inout Blockers found) {
    float base = endlessPlaneDepthAt(s, first);
    countBlockers(s, gatherFootprint(s, first), base, planeInFootprint(s, base), farthest, found);
}

// A blocker must be nearer to the light than the receiver: a tap's plane depth grows beyond it by one texel's slope.
void hidePlanesBehind(inout ShadowPoint s) {
    precise float behind = s.depth - (abs(s.slope.x) + abs(s.slope.y));
    s.least = max(behind, s.least);
}

// What the shadow bounds tell of a search of radius `reach` that stays in the rectangle. True where they tell its whole
// result. Else `needed` is the radius beyond which no blocker can be. It is found in two rounds: the nearest depth in a
// region bounds what the source can see of the region, and the smaller region that is left may hold only farther
// depths.
// Tried and dropped: a plane of every block of 16x16 texels, with the bounds of what is left of its depths. Unlike the
// bounds alone it can tell "lit". It is right, but asking it takes longer than the search that it spares: filter_pairs
// 1.92 -> 2.08 ms, lighting_inline 2.36 -> 2.88 ms, search_pairs 0.83 -> 0.90 ms (NVIDIA H100, 3840x2160).
bool knownByBounds(ShadowPoint s, PcssKernel k, float reach, float spread, out float needed, out float visibility) {
    needed = reach;
    visibility = 1.0;
    for (uint i = 0u; i < 2u; ++i) {
        vec2 extent = tapExtent(k, max(needed, k.texel));  // no filter is narrower than a texel
        bool known;
        vec2 bounds = shadowBoundsOver(s.view, s.corner + 0.5 - extent, s.corner + 0.5 + extent, known);
        if (!known) return false;
        float nearest = s.sign > 0.0 ? bounds.y : -bounds.x;
        float farthest = s.sign > 0.0 ? bounds.x : -bounds.y;
        float rise = dot(abs(s.slope), extent);
        float slack = 1e-6 * abs(s.depth) + 1e-5 * rise;  // the taps' own rounding
        if (nearest <= max(s.depth - rise - slack, s.least)) return true;
        visibility = 0.0;
        if (farthest > max(s.depth + rise + slack, s.least)) return true;
        visibility = 1.0;
        // The region of the source grows toward the light.
        float seen = fma(k.radius1, nearest, k.radius0) + kTapTexels * k.texel + spread;
        seen += 1e-5 * abs(seen) + 1e-6 * (abs(k.radius0) + k.radius1 * abs(nearest));
        if (!(seen < needed)) return false;
        needed = max(seen, 0.0);
    }
    return false;
}

// What is stored farther from the light than this is out of the source's sight at a tap's radius.
float farthestAt(float squared, vec3 sight) {
    precise float farthest = fma(squared, sight.x, sight.y);
    return max(farthest, sight.z);
}

// Returns the filter's radius. Below 0 no filter is needed, and `visibility` is known. There are two loops, so that
// nothing stands between the texture reads where all taps stay inside the rectangle.
// `spread`: how far aside, in the unit of radii, the receivers lie for which the search is made; 0 for one. What one of
// them sees counts, so the search reaches farther by it, and a tap counts as if it were nearer by it.
// `perTapSquared`: one over the square of the number of taps.
float searchBlockers(GpuLight light, ShadowPoint s, PcssKernel k, float spread, uint taps, float perTapSquared,
                     out float visibility) {
    precise float reach = (k.widest + k.texel) + spread;
    // A depth is in the source's sight at a radius from (radius - radius0 - margin) / radius1 on.
    precise float inverse = k.radius1 > 0.0 ? 1.0 / k.radius1 : 0.0;
    precise float farthest0 = k.radius1 > 0.0 ? -(k.radius0 + kTapTexels * k.texel) * inverse : -2.0;
    Blockers found = Blockers(0.0, 0.0, true);
    precise float scale = reach * perTapSquared;
    precise vec3 sight = vec3(scale * inverse, farthest0 - spread * inverse, farthest0);
    TapAxes axes = tapAxes(k, scale);
    if (!mayLeave(s, k, reach)) {
        float needed;
        if (knownByBounds(s, k, reach, spread, needed, visibility)) return -1.0;
        precise float mostSquared = needed / scale;
        for (uint i = 0u; i < taps; ++i) {
            GpuPcssTap tap = frame.pcssPattern[i];
            if (tap.squared > mostSquared && !found.allOcclude) break;  // beyond, there is no blocker
            countFootprint(s, floorOfTap(tapCorner(s, axes, tap.searched)), farthestAt(tap.squared, sight), found);
        }
    } else {
        for (uint i = 0u; i < taps; ++i) {
            GpuPcssTap tap = frame.pcssPattern[i];
            vec2 corner = tapCorner(s, axes, tap.searched);
            float farthest = farthestAt(tap.squared, sight);
            if (leavesFace(s, k, corner)) {
                float plane, stored;
                otherFace(light, s, i, corner + 0.5, plane, stored);
                countBlockers(s, vec4(stored * s.sign), 0.0, vec4(plane), farthest, found);
            } else {
                countFootprint(s, floorOfTap(cornerInside(s, corner)), farthest, found);
            }
        }
    }
    visibility = found.allOcclude ? 0.0 : 1.0;
    if (found.blocking == 0.0 || found.allOcclude) return -1.0;
    precise float mean = found.depths * s.sign / found.blocking;
    precise float radius = clamp(fma(k.radius1, mean, k.radius0), k.texel, max(k.widest, k.texel));
    return radius;
}

#endif
