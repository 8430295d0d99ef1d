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
    float depths;    // sum over them
    bool allOcclude;
};

// `farthest`: what is stored farther from the light than this is out of the source's sight at the tap's radius.
void countBlockers(vec4 plane, vec4 stored, float farthest, inout Blockers found) {
    bvec4 occludes = greaterThan(stored, plane);
    bvec4 seen = greaterThan(stored, vec4(farthest));
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

float searchRadius(uint tap, float scale) {
    precise float place = float(tap) + 0.5;
    precise float radius = place * place * scale;
    return radius;
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
    TapAxes axes = tapAxes(k, scale);
    if (!mayLeave(s, k, reach)) {
        float needed;
        if (knownByBounds(s, k, reach, spread, needed, visibility)) return -1.0;
        for (uint i = 0u; i < taps; ++i) {
            float radius = searchRadius(i, scale);
            if (radius > needed && !found.allOcclude) break;  // beyond, there is no blocker
            vec2 first = floorOfTap(tapCorner(s, axes, frame.pcssPattern[i].searched));
            vec4 stored = gatherShadowTexels(s, first);
            countBlockers(planeDepthsAt(s, first), stored, fma(max(radius - spread, 0.0), inverse, farthest0), found);
        }
    } else {
        for (uint i = 0u; i < taps; ++i) {
            float radius = searchRadius(i, scale);
            vec2 corner = tapCorner(s, axes, frame.pcssPattern[i].searched);
            vec4 plane, stored;
            if (leavesFace(s, k, corner)) {
                float planeThere, storedThere;
                otherFace(light, s, i, corner + 0.5, planeThere, storedThere);
                plane = vec4(planeThere);
                stored = vec4(storedThere);
            } else {
                vec2 first = floorOfTap(clamp(corner, s.rectMin + 0.5, s.rectMax - 1.5));
                plane = planeDepthsAt(s, first);
                stored = gatherShadowTexels(s, first);
            }
            countBlockers(plane, stored, fma(max(radius - spread, 0.0), inverse, farthest0), found);
        }
    }
    visibility = found.allOcclude ? 0.0 : 1.0;
    if (found.blocking == 0.0 || found.allOcclude) return -1.0;
    precise float mean = found.depths / found.blocking;
    precise float radius = clamp(fma(k.radius1, mean, k.radius0), k.texel, max(k.widest, k.texel));
    return radius;
}

#endif
