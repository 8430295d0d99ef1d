// One blocker search for the 2x2 pixels of a quad: the filter "pcss_shared".
//
// Problem: neighbours search nearly the same texels for nearly the same blockers, 16 taps each.
// Plain way: each of four neighbours takes a quarter of the taps, and they add up what they have found. The others'
// taps then count as if they had been made from the own place.
// Here: the search is made once, from the middle of the four receivers. It reaches farther by how far they lie apart,
// and a blocker counts if one of the receivers may see it. So it finds what each would find, and a little more. Then
// each pixel filters from its own place, by the radius that the quad has found.
// A quad shares if all four receivers ask the same shadow view and lie nearly in one plane. In others each pixel
// searches by itself.
// The result depends on the aligned 2x2 pixels and the light alone. So EVALUATE and inline shadows, which search the
// quad anew, get the same bits.
// Limits: the radius is rounded to 1/1024 of a texel, since passes hand it on in 16 bits.
#ifndef GNOMON_VISIBILITY_PCSS_QUAD_GLSL
#define GNOMON_VISIBILITY_PCSS_QUAD_GLSL

#include "visibility/choose_view.glsl"
#include "visibility/pcss_search.glsl"

// Off their common plane receivers may lie by this share of how far they lie apart.
const float kQuadFlatness = 0.25;

struct QuadSearch {
    uint code;      // kQuadDark, kQuadLit, kQuadOwn, or the filter's radius
    uint reached;   // how many of the four pixels the light reaches,
    uint asking;    // and how many of these ask its shadowmap
};

uint searchForQuad(GpuLight light, uint viewIndex, Receiver middle, float spreadMetres) {
    ShadowPoint s = shadowPointIn(viewIndex, light, middle);
    if (!s.inFront) return kQuadOwn;
    PcssKernel k = pcssKernelOf(light, s, middle.pixel);
    hidePlanesBehind(s);
    precise float spread = spreadMetres;
    if (!isOrthographicView(shadowViews[viewIndex])) spread = spreadMetres / s.linear;
    float visibility;
    float radius = searchBlockers(light, s, k, spread, visibility);
    if (radius < 0.0) return visibility == 0.0 ? kQuadDark : kQuadLit;
    precise float parts = radius / k.texel * float(kQuadRadiusParts) + 0.5;
    return clamp(uint(parts), 1u, kQuadOwn - 1u);
}

// `first`: the quad's pixel with even coordinates.
QuadSearch searchQuad(GpuLight light, uvec2 first) {
    QuadSearch quad = QuadSearch(kQuadDark, 0u, 0u);
    vec3 positions[4];
    vec3 normals[4];
    Receiver middle;
    uint view = 0u;
    uint subsurface = 0u;
    bool oneView = true;
    for (uint i = 0u; i < 4u; ++i) {
        Receiver r = receiverAt(first + uvec2(i & 1u, i >> 1u));
        positions[i] = r.positionWs;
        normals[i] = r.faceNormalWs;
        vec3 toLight = vec3(0.0);
        bool reached = r.valid && lightReaches(light, r.positionWs, r.mask, toLight);
        quad.reached += reached ? 1u : 0u;
        quad.asking += reached && asksShadowmap(r, toLight) ? 1u : 0u;
        subsurface += r.subsurface ? 1u : 0u;
        ViewChoice choice = chooseView(light, r);
        oneView = oneView && !choice.none && choice.border == 0.0;
        if (i == 0u) {
            middle = r;
            view = choice.view;
        }
        oneView = oneView && choice.view == view;
        middle.offPlaneMetres = max(middle.offPlaneMetres, r.offPlaneMetres);
    }
    if (quad.asking == 0u) return quad;
    quad.code = kQuadOwn;
    if (quad.asking != 4u || !oneView || (subsurface & 3u) != 0u) return quad;
    precise vec3 mean = 0.25 * ((positions[0] + positions[1]) + (positions[2] + positions[3]));
    precise float farthest = 0.0;  // squared
    precise float off = 0.0;
    for (uint i = 0u; i < 4u; ++i) {
        precise vec3 away = positions[i] - mean;
        farthest = max(farthest, dot(away, away));
        off = max(off, abs(dot(normals[i], away)));
    }
    precise float spread = sqrt(farthest);
    if (off > kQuadFlatness * spread + 2.0 * middle.offPlaneMetres) return quad;
    middle.positionWs = mean;
    quad.code = searchForQuad(light, view, middle, spread);
    return quad;
}

#endif
