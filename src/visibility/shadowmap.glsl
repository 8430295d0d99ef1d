// Standard shadowmaps: where a receiver lies in a shadow view, how deep, and what is stored there.
#ifndef GNOMON_VISIBILITY_SHADOWMAP_GLSL
#define GNOMON_VISIBILITY_SHADOWMAP_GLSL

#include "visibility/depth_bias.glsl"
#include "gpu_interface/shadowmaps_set.glsl"
#include "shading/light_tests.glsl"
#include "visibility/light_views.glsl"
#include "shading/receiver.glsl"

// A receiver in a shadow view, biased and ready to be compared. Device depths have a sign here that makes greater ones
// nearer to the light, whatever the kind of depth.
struct ShadowPoint {
    vec2 corner;   // place in the atlas, less half a texel (whole numbers are centres); may be outside the rectangle
    vec2 rectMin;  // the rectangle's first pixel
    vec2 rectMax;  // one past its last
    float sign;    // times a stored depth
    float depth;   // of the receiver's plane at the receiver,
    vec2 slope;    // per texel,
    float least;   // and nowhere less than this: what is as far as the view sees does not occlude
    float linear;  // the receiver's linear depth, without bias, metres
    vec2 tangent;  // perspective: lateral over linear depth
    uint view;
    uint atlas;
    float layer;
    vec2 atlasPerTexel;
    bool inFront;  // of the light; else nothing can occlude it
};

// Lights of six faces: that of the largest component, in the order +X -X +Y -Y +Z -Z.
uint cubeFace(vec3 fromLight) {
    vec3 a = abs(fromLight);
    if (a.x >= a.y && a.x >= a.z) return fromLight.x >= 0.0 ? 0u : 1u;
    if (a.y >= a.z) return fromLight.y >= 0.0 ? 2u : 3u;
    return fromLight.z >= 0.0 ? 4u : 5u;
}

// Cascades are orthographic, and no other view is.
bool isOrthographicView(GpuShadowView view) {
    if (kShadowViews != kShadowViewsAny) return kShadowViews == kShadowViewsCascades;
    return (view.flags & kShadowViewOrthographicBit) != 0u;
}

vec4 clipFromWorld(GpuShadowView view, vec3 p) {
    precise vec4 clip = view.clipFromWorld[0] * p.x + view.clipFromWorld[1] * p.y + view.clipFromWorld[2] * p.z +
                        view.clipFromWorld[3];
    return clip;
}

// Distance along the view axis, metres.
float linearDepthOf(GpuShadowView view, vec4 clip) {
    precise float linear = clip.w;
    if (isOrthographicView(view)) linear = (clip.z - view.depthFromLinearA) / view.depthFromLinearB;
    return linear;
}

ShadowPoint shadowPointIn(uint viewIndex, GpuLight light, Receiver receiver) {
    GpuShadowView view = shadowViews[viewIndex];
    bool orthographic = isOrthographicView(view);
    vec4 clip = clipFromWorld(view, receiver.positionWs);
    ShadowPoint s;
    s.view = viewIndex;
    s.inFront = clip.w > 0.0;
    s.linear = linearDepthOf(view, clip);
    precise vec2 ndc = clip.xy / clip.w;
    precise vec2 corner = ndc * view.pxFromNdcScale + (view.pxFromNdcOffset - 0.5);
    s.corner = corner;
    precise vec2 tangent = ndc * view.tangentPerNdc;
    s.tangent = tangent;
    vec2 slope;
    float depth = biasedDepth(view, orthographic, light, receiver, ndc, s.linear, tangent, slope);
    bool reversedZ = (view.flags & kShadowViewReversedZBit) != 0u;
    s.sign = reversedZ ? 1.0 : -1.0;
    s.least = reversedZ ? 0.0 : -1.0;
    s.depth = depth * s.sign;
    s.slope = slope * s.sign;
    s.rectMin = view.rectMinPx;
    s.rectMax = view.rectMaxPx;
    s.atlas = view.atlasAndLayer & 0xFFu;
    s.layer = float(view.atlasAndLayer >> 8u);
    s.atlasPerTexel = view.atlasPerTexel;
    return s;
}

// Depth of the receiver's plane at a texel's centre, where nothing limits it.
float endlessPlaneDepthAt(ShadowPoint s, vec2 texel) {
    if (!kComparesPlanes) return s.depth;
    precise vec2 away = texel - s.corner;
    precise float depth = fma(s.slope.x, away.x, fma(s.slope.y, away.y, s.depth));
    return depth;
}

float planeDepthAt(ShadowPoint s, vec2 texel) {
    return kComparesPlanes ? max(endlessPlaneDepthAt(s, texel), s.least) : s.depth;
}

// Filters compare footprints: the 2x2 texels of a gather, in its order (0,1), (1,1), (1,0), (0,0). All depths are told
// from that of the plane at the first texel, `base`. So the sign and the base cost one operation for each texel, and
// how the plane rises is the same for all footprints of a pixel.
vec4 planeInFootprint(ShadowPoint s, float base) {
    if (!kComparesPlanes) return vec4(0.0);
    precise vec4 rise = vec4(s.slope.y, s.slope.x + s.slope.y, s.slope.x, 0.0);
    precise float least = s.least - base;
    return max(rise, vec4(least));
}
// What is stored. A texel occludes if this is more than the plane's.
vec4 storedInFootprint(ShadowPoint s, vec4 stored, float base) {
    precise vec4 above = fma(stored, vec4(s.sign), vec4(-base));
    return above;
}

float fetchAtlas(uint atlas, float layer, ivec2 texel) {
    ivec3 at = ivec3(texel, int(layer));
    if (kShadowAtlases == 1u) return texelFetch(shadowAtlas0, at, 0).x;
    switch (atlas) {
        case 0u: return texelFetch(shadowAtlas0, at, 0).x;
        case 1u: return texelFetch(shadowAtlas1, at, 0).x;
        case 2u: return texelFetch(shadowAtlas2, at, 0).x;
        default: return texelFetch(shadowAtlas3, at, 0).x;
    }
}

// What is stored in the footprint that begins at a texel. Without the sign.
vec4 gatherFootprint(ShadowPoint s, vec2 first) {
    precise vec3 at = vec3((first + 1.0) * s.atlasPerTexel, s.layer);
    if (kShadowAtlases == 1u) return textureGather(sampler2DArray(shadowAtlas0, shadowSampler), at);
    switch (s.atlas) {
        case 0u: return textureGather(sampler2DArray(shadowAtlas0, shadowSampler), at);
        case 1u: return textureGather(sampler2DArray(shadowAtlas1, shadowSampler), at);
        case 2u: return textureGather(sampler2DArray(shadowAtlas2, shadowSampler), at);
        default: return textureGather(sampler2DArray(shadowAtlas3, shadowSampler), at);
    }
}

#endif
