// Cascades of a directional light: which one a receiver takes, and how neighbours blend.
//
// Problem: one orthographic map over the whole view is too coarse near the camera.
// Source: Engel 2006, "Cascaded Shadow Maps", ShaderX5; Valient 2008, "Stable Rendering of Cascaded Shadow Maps".
// Here: a receiver takes the first cascade that holds it. Over the last tenth of the cascade's extent the next one is
// blended in, so that no seam shows. The last cascade blends into light. The host gives the shadow views, of any age.
#ifndef GNOMON_VISIBILITY_CASCADES_GLSL
#define GNOMON_VISIBILITY_CASCADES_GLSL

#include "visibility/shadowmap.glsl"

const float kBlendedShare = 1.0 / float(kCascadeBlendedPart);

// Whether a cascade holds a point; `border` is 0 where it is to be used alone and 1 at its border.
bool cascadeHolds(uint viewIndex, vec3 positionWs, out float border) {
    GpuShadowView view = shadowViews[viewIndex];
    vec4 clip = clipFromWorld(view, positionWs);
    precise vec2 px = clip.xy / clip.w * view.pxFromNdcScale + view.pxFromNdcOffset;
    precise float depth = view.depthFromLinearA + view.depthFromLinearB * linearDepthOf(view, clip);
    precise vec2 halfPx = 0.5 * (view.rectMaxPx - view.rectMinPx) - float(kCascadeMarginPx);
    precise vec2 share = abs(px - 0.5 * (view.rectMinPx + view.rectMaxPx)) / halfPx;
    precise float most = max(share.x, share.y);
    precise float into = (most - (1.0 - kBlendedShare)) / kBlendedShare;
    border = clamp(into, 0.0, 1.0);
    vec2 margin = vec2(float(kCascadeMarginPx));
    return all(greaterThanEqual(px, view.rectMinPx + margin)) && all(lessThanEqual(px, view.rectMaxPx - margin)) &&
           depth >= 0.0 && depth <= 1.0;
}

uint cascadeCount(GpuLight light) { return light.typeAndFlags >> kLightCascadesShift & kLightCascadesMask; }

// The first cascade that holds the receiver, or cascadeCount().
uint cascadeOf(GpuLight light, vec3 positionWs, out float border) {
    uint count = cascadeCount(light);
    border = 0.0;
    for (uint i = 0u; i < count; ++i) {
        if (cascadeHolds(light.shadowView + i, positionWs, border)) return i;
    }
    return count;
}

#endif
