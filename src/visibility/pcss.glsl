// Visibility provider "pcss": percentage closer soft shadows, the penumbra of a light with a size.
//
// Problem: a shadow is sharp where it touches its blocker, and widens with the distance from it.
// Source: Fernando 2005, "Percentage-Closer Soft Shadows". Its penumbra is (z - zb) / zb times the source's size.
// Plain way: average the blockers in a region of fixed width. Then average comparisons in a region as wide as the
// penumbra of that average.
// Here:
// 1. Seen from the receiver through the map, the source is a disk. The disk's radius is linear in the blocker's
//    *device* depth, with and without perspective. So it costs one multiplication per stored depth.
// 2. Each blocker is asked whether it lies in the disk of its own depth. What the source cannot see does not count. So
//    a wide search does no harm.
// 3. Search taps, four texels each, crowd toward the middle (radius by the square), where near blockers must be found.
//    Filter taps are spread evenly, each a bilinear comparison.
// 4. A pixel in which no texel of the search is a blocker is lit. One in which all occlude is dark. Shadow bounds,
//    where the host has them made, tell that of many pixels before any tap.
// 5. The pattern is a spiral of golden angles. Each pixel turns it by a sequence of low discrepancy in whole numbers.
//    So every pipeline and device sees the same one.
// 6. A blocker must be nearer to the light than the receiver. So a tap's plane depth grows beyond the receiver's by one
//    texel's slope at most. Else walls behind the receiver would shadow it.
// Limits: one depth per texel stands for all blockers behind each other. Radii beyond kMaxPcssRadiusPx texels are cut.
#ifndef GNOMON_VISIBILITY_PCSS_GLSL
#define GNOMON_VISIBILITY_PCSS_GLSL

#include "visibility/pcss_search.glsl"

float filterTap(ShadowPoint s, vec2 corner) {
    vec2 first = floorOfTap(corner);
    precise vec2 f = corner - first;
    float base = endlessPlaneDepthAt(s, first);
    vec4 stored = storedInFootprint(s, gatherFootprint(s, first), base);
    vec4 lit = vec4(lessThanEqual(stored, planeInFootprint(s, base)));
    precise float top = fma(f.x, lit.z - lit.w, lit.w);
    precise float bottom = fma(f.x, lit.y - lit.x, lit.x);
    precise float value = fma(f.y, bottom - top, top);
    return value;
}

// `perTap`: one over the number of taps. There are two loops, so that nothing stands between the texture reads where
// all taps stay inside the rectangle.
float filterPenumbra(GpuLight light, ShadowPoint s, PcssKernel k, float radius, uint taps, float perTap) {
    precise float sum = 0.0;
    precise float scale = radius * sqrt(perTap);
    TapAxes axes = tapAxes(k, scale);
    if (!mayLeave(s, k, radius)) {
        for (uint i = 0u; i < taps; ++i) sum += filterTap(s, tapCorner(s, axes, frame.pcssPattern[i].filtered));
    } else {
        for (uint i = 0u; i < taps; ++i) {
            vec2 corner = tapCorner(s, axes, frame.pcssPattern[i].filtered);
            if (leavesFace(s, k, corner)) {
                float plane, stored;
                otherFace(light, s, i, corner + 0.5, plane, stored);
                sum += stored > plane ? 0.0 : 1.0;
            } else {
                sum += filterTap(s, cornerInside(s, corner));
            }
        }
    }
    precise float visibility = sum * perTap;
    return visibility;
}

// A narrow penumbra needs fewer taps: a third of them for a radius of 0, and 1/32 more per square texel.
uint tapsForRadius(uint most, float radiusPx) {
    precise float wanted = float(most) * (1.0 / 3.0 + (1.0 / 32.0) * (radiusPx * radiusPx));
    return min(uint(min(wanted, 64.0)) + 1u, most);
}

// `sharing`: the filter is "pcss_shared". `known`: its quad has searched, and `radius` is what it has found. Else the
// pixel searches by itself; with "pcss_shared" it takes half of the taps for that.
float pcssVisibility(GpuLight light, ShadowPoint s, uvec2 pixel, bool sharing, bool known, float radius) {
    PcssKernel k = pcssKernelOf(light, s, pixel);
    hidePlanesBehind(s);
    GpuPcssTaps preset = frame.pcssTaps[pcssPresetOf(light)];
    float visibility;
    if (!known) {
        uint taps = sharing ? (preset.searchTaps + 1u) / 2u : preset.searchTaps;
        precise float perTapSquared = sharing ? 1.0 / float(taps * taps) : preset.perSearchTapSquared;
        radius = searchBlockers(light, s, k, 0.0, taps, perTapSquared, visibility);
    }
    if (radius < 0.0) return visibility;
    uint taps = preset.filterTaps;
    float perTap = preset.perFilterTap;
    if (sharing) {
        radius = max(radius, k.texel);  // a next cascade is coarser
        precise float radiusPx = radius / k.texel;
        taps = tapsForRadius(taps, radiusPx);
        perTap = 1.0 / float(taps);
    }
    return filterPenumbra(light, s, k, radius, taps, perTap);
}

#endif
