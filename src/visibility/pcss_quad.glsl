// One blocker search for the 2x2 pixels of a quad: the filter "pcss_shared".
//
// Problem: neighbours search nearly the same texels for nearly the same blockers, 16 taps each.
// Plain way: each of four neighbours takes a quarter of the taps, and they add up what they have found. The others'
// taps then count as if they had been made from the own place.
// Here: the search is made once, from the middle of the receivers. It reaches farther by how far they lie apart,
// and a blocker counts if one of the receivers may see it. So it finds what each would find, and a little more. Then
// each pixel filters from its own place, by the radius that the quad has found.
// Receivers that do not ask the shadowmap, since the light does not reach them or they look away, take no part. The
// others share if they ask the same shadow view and lie nearly in one plane. Else each pixel searches by itself.
// The result depends on the aligned 2x2 pixels and the light alone. So EVALUATE and inline shadows, which search the
// quad anew, get the same bits.
// Limits: the radius is rounded to 1/1024 of a texel, since passes hand it on in 16 bits.
#ifndef GNOMON_VISIBILITY_PCSS_QUAD_GLSL
#define GNOMON_VISIBILITY_PCSS_QUAD_GLSL

#include "visibility/choose_view.glsl"
#include "visibility/pcss_search.glsl"

// Off their common plane receivers may lie by this share of how far they lie apart.
const float kQuadFlatness = 0.25;

// How a pixel votes on whether a pair is dark or lit.
const uint kNoVote = 0u;
const uint kNotLit = 1u;   // it is not wholly lit
const uint kNotDark = 2u;  // it is not wholly dark

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
    return clamp(uint(parts), 1u, kQuadMostRadius);
}

// `first`: the quad's pixel with even coordinates.
QuadSearch searchQuad(GpuLight light, uvec2 first) {
    QuadSearch quad = QuadSearch(kQuadDark, 0u, 0u);
    vec3 positions[4];
    vec3 normals[4];
    bool asks[4];
    Receiver middle;
    uint view = 0u;
    uint subsurface = 0u;
    bool oneView = true;
    float offPlane = 0.0;
    precise vec3 sum = vec3(0.0);
    for (uint i = 0u; i < 4u; ++i) {
        Receiver r = receiverAt(first + uvec2(i & 1u, i >> 1u));
        positions[i] = r.positionWs;
        normals[i] = r.faceNormalWs;
        vec3 toLight = vec3(0.0);
        bool reached = r.valid && lightReaches(light, r.positionWs, r.mask, toLight);
        asks[i] = reached && asksShadowmap(r, toLight);
        quad.reached += reached ? 1u : 0u;
        if (!asks[i]) continue;
        ViewChoice choice = chooseView(light, r);
        if (quad.asking == 0u) {
            middle = r;
            view = choice.view;
        }
        ++quad.asking;
        oneView = oneView && !choice.none && choice.border == 0.0 && choice.view == view;
        subsurface += r.subsurface ? 1u : 0u;
        offPlane = max(offPlane, r.offPlaneMetres);
        sum += r.positionWs;
    }
    if (quad.asking == 0u) return quad;
    quad.code = kQuadOwn;
    if (!oneView || (subsurface != 0u && subsurface != quad.asking)) return quad;
    precise vec3 mean = sum / float(quad.asking);
    precise float farthest = 0.0;  // squared
    precise float off = 0.0;
    for (uint i = 0u; i < 4u; ++i) {
        precise vec3 away = positions[i] - mean;
        if (!asks[i]) continue;
        farthest = max(farthest, dot(away, away));
        off = max(off, abs(dot(normals[i], away)));
    }
    precise float spread = sqrt(farthest);
    if (off > kQuadFlatness * spread + 2.0 * offPlane) return quad;
    middle.positionWs = mean;
    middle.offPlaneMetres = offPlane;
    middle.pixel = first;
    quad.code = searchForQuad(light, view, middle, spread);
    if (quad.code == kQuadLit && quad.asking != 4u) quad.code = kQuadLitIfAsked;
    return quad;
}

// What the pixels of a quad whose code is kQuadOwn have found, each by itself: one of the quad's pixels.
uint searchPixel(GpuLight light, uvec2 pixel) {
    Receiver r = receiverAt(pixel);
    vec3 toLight;
    if (!r.valid || !lightReaches(light, r.positionWs, r.mask, toLight) || !asksShadowmap(r, toLight)) return kNoVote;
    ViewChoice choice = chooseView(light, r);
    if (choice.none) return kNotDark;
    if (choice.border != 0.0) return kNotLit | kNotDark;
    ShadowPoint s = shadowPointIn(choice.view, light, r);
    if (!s.inFront) return kNotDark;
    PcssKernel k = pcssKernelOf(light, s, r.pixel);
    hidePlanesBehind(s);
    float visibility;
    float radius = searchBlockers(light, s, k, 0.0, visibility);
    return radius >= 0.0 ? kNotLit | kNotDark : visibility == 0.0 ? kNotLit : kNotDark;
}

#endif
