// One blocker search for the 2x2 pixels of a quad: the filter "pcss_shared".
//
// Problem: neighbours search nearly the same texels for nearly the same blockers, 16 taps each.
// Plain way: each of four neighbours takes a quarter of the taps, and they add up what they have found. The others'
// taps then count as if they had been made from the own place.
// Here: the search is made once, from the middle of the receivers. It reaches farther by how far they lie apart,
// and a blocker counts if one of the receivers may see it. So it finds what each would find, and a little more. Then
// each pixel filters from its own place, by the radius that the quad has found.
// Receivers that do not ask the shadowmap, since the light does not reach them or they look away, take no part. The
// others share if they look at the same shadow view and lie nearly in one plane. Else each pixel searches by itself.
// Where two cascades blend, the search in the first one serves both.
// The result depends on the aligned 2x2 pixels and the light alone. So EVALUATE and inline shadows, which search the
// quad anew, get the same bits.
// Limits: the radius is rounded to 1/1024 of a texel, since passes hand it on in 16 bits.
#ifndef GNOMON_VISIBILITY_PCSS_QUAD_GLSL
#define GNOMON_VISIBILITY_PCSS_QUAD_GLSL

#include "visibility/choose_view.glsl"
#include "visibility/pcss_search.glsl"

// How far from the first one's plane receivers may lie, as a share of how far they lie apart; and the least cosine
// between their normals. Both are about 14 degrees.
const float kQuadFlatness = 0.25;
const float kQuadLeastCosine = 0.97;

struct QuadSearch {
    uint code;      // kQuadDark ..., or the filter's radius
    uint reached;   // how many of the four pixels the light reaches,
    uint asking;    // and how many of these ask its shadowmap
};

// The receivers of a quad that ask. What is kept of them does not grow with their number, since registers are what this
// search is short of.
struct QuadReceivers {
    Receiver first;
    uint view;
    vec3 low;   // a box around them
    vec3 high;
    bool share;
    bool none;  // no view holds the first one
    bool blendsIntoLight;
};

void addReceiver(GpuLight light, Receiver r, uint before, inout QuadReceivers all) {
    ViewChoice choice = chooseView(light, r);
    if (before == 0u) {
        all = QuadReceivers(r, choice.view, r.positionWs, r.positionWs, true, choice.none, false);
    }
    all.low = min(all.low, r.positionWs);
    all.high = max(all.high, r.positionWs);
    all.first.offPlaneMetres = max(all.first.offPlaneMetres, r.offPlaneMetres);
    all.blendsIntoLight = all.blendsIntoLight || (choice.last && choice.border > 0.0);
    precise vec3 away = r.positionWs - all.first.positionWs;
    precise float off = abs(dot(all.first.faceNormalWs, away));
    precise float apart = sqrt(dot(away, away));
    bool flatly = off <= kQuadFlatness * apart + 2.0 * all.first.offPlaneMetres &&
                  (!kNeedsFaceNormals || dot(all.first.faceNormalWs, r.faceNormalWs) >= kQuadLeastCosine);
    bool alike = choice.view == all.view && choice.none == all.none && r.subsurface == all.first.subsurface;
    all.share = all.share && alike && (flatly || before == 0u);
}

uint searchForQuad(GpuLight light, QuadReceivers all, uvec2 pixel) {
    precise vec3 diagonal = 0.5 * (all.high - all.low);
    precise vec3 middle = 0.5 * (all.high + all.low);
    // Of fewer than four receivers the middle of the box may lie off their plane.
    precise float off = dot(all.first.faceNormalWs, middle - all.first.positionWs);
    Receiver receiver = all.first;
    receiver.positionWs = middle - off * all.first.faceNormalWs;
    receiver.pixel = pixel;
    ShadowPoint s = shadowPointIn(all.view, light, receiver);
    if (!s.inFront) return kQuadOwn;
    PcssKernel k = pcssKernelOf(light, s, pixel);
    hidePlanesBehind(s);
    precise float spread = sqrt(dot(diagonal, diagonal));
    if (!isOrthographicView(shadowViews[all.view])) spread = spread / s.linear;
    float visibility;
    GpuPcssTaps preset = frame.pcssTaps[pcssPresetOf(light)];
    float radius = searchBlockers(light, s, k, spread, preset.searchTaps, preset.perSearchTapSquared, visibility);
    if (radius < 0.0) return visibility == 0.0 ? kQuadDark : kQuadLit;
    precise float parts = radius / k.texel * float(kQuadRadiusParts) + 0.5;
    return clamp(uint(parts), 1u, kQuadMostRadius);
}

// `first`: the quad's pixel with even coordinates.
QuadSearch searchQuad(GpuLight light, uvec2 first) {
    QuadSearch quad = QuadSearch(kQuadDark, 0u, 0u);
    QuadReceivers all;
    HostPixel host[4];
    for (uint i = 0u; i < 4u; ++i) host[i] = hostPixelAt(first + uvec2(i & 1u, i >> 1u));
    for (uint i = 0u; i < 4u; ++i) {
        Receiver r = receiverOf(first + uvec2(i & 1u, i >> 1u), host[i]);
        vec3 toLight;
        if (!r.valid || !lightReaches(light, r.positionWs, r.mask, toLight)) continue;
        ++quad.reached;
        if (!asksShadowmap(r, toLight)) continue;
        addReceiver(light, r, quad.asking, all);
        ++quad.asking;
    }
    if (quad.asking == 0u) return quad;
    quad.code = kQuadOwn;
    if (!all.share) return quad;
    quad.code = all.none ? kQuadLit : searchForQuad(light, all, first);
    if (quad.code == kQuadLit && quad.asking != 4u) quad.code = kQuadLitIfAsked;
    if (quad.code == kQuadDark && all.blendsIntoLight) quad.code = kQuadDarkInMap;
    return quad;
}

#endif
