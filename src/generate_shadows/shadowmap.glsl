// Standard shadowmaps: which view of a light holds a point, where in its atlas the point lies, and at which depth.
#ifndef GNOMON_GENERATE_SHADOWS_SHADOWMAP_GLSL
#define GNOMON_GENERATE_SHADOWS_SHADOWMAP_GLSL

#include "depth_bias/depth_bias.glsl"
#include "gpu_interface/shadowmaps_set.glsl"
#include "shading/light_tests.glsl"
#include "shading/receiver.glsl"

// A receiver in a shadow view, biased and ready to be compared.
struct ShadowPoint {
    vec2 px;        // in the atlas, texel centres at .5, kept where the whole filter stays inside the rectangle
    float depth;    // device depth
    uint atlas;
    float layer;
    vec2 atlasPerTexel;
    bool reversedZ;
    bool inFront;   // of the light; else nothing can occlude it
};

// Point lights: the face of the largest component, in the order +X -X +Y -Y +Z -Z.
uint cubeFace(vec3 fromLight) {
    vec3 a = abs(fromLight);
    if (a.x >= a.y && a.x >= a.z) return fromLight.x >= 0.0 ? 0u : 1u;
    if (a.y >= a.z) return fromLight.y >= 0.0 ? 2u : 3u;
    return fromLight.z >= 0.0 ? 4u : 5u;
}

vec4 clipFromWorld(GpuShadowView view, vec3 p) {
    precise vec4 clip = view.clipFromWorld[0] * p.x + view.clipFromWorld[1] * p.y + view.clipFromWorld[2] * p.z +
                        view.clipFromWorld[3];
    return clip;
}

// Distance along the view axis, metres.
float linearDepthOf(GpuShadowView view, vec4 clip) {
    precise float linear = clip.w;
    if ((view.flags & kShadowViewOrthographicBit) != 0u) {
        linear = (clip.z - view.depthFromLinearA) / view.depthFromLinearB;
    }
    return linear;
}

ShadowPoint shadowPointOf(GpuLight light, Receiver receiver, vec3 toLight, float filterRadius) {
    uint face = lightType(light) == kLightPoint ? cubeFace(receiver.positionWs - light.positionWs) : 0u;
    GpuShadowView view = shadowViews[light.shadowView + face];
    bool orthographic = (view.flags & kShadowViewOrthographicBit) != 0u;

    precise float receiverDepth = linearDepthOf(view, clipFromWorld(view, receiver.positionWs));
    precise float texelMetres = orthographic ? view.texelMetres : view.texelMetres * receiverDepth;
    precise vec3 p = receiver.positionWs + normalOffset(view, receiver, toLight, texelMetres, filterRadius);
    precise vec4 clip = clipFromWorld(view, p);
    precise float linear = linearDepthOf(view, clip) - linearBias(light, receiver);

    ShadowPoint s;
    s.inFront = clip.w > 0.0;
    precise float depth = orthographic ? view.depthFromLinearA + view.depthFromLinearB * linear
                                       : view.depthFromLinearA + view.depthFromLinearB / max(linear, 1e-4);
    s.reversedZ = (view.flags & kShadowViewReversedZBit) != 0u;
    precise float slack = deviceDepthSlack(view, depth);
    precise float biased = s.reversedZ ? depth + slack : depth - slack;
    s.depth = biased;
    precise float inverseW = 1.0 / clip.w;
    precise vec2 px = clip.xy * inverseW * view.pxFromNdcScale + view.pxFromNdcOffset;
    float border = filterRadius > 0.0 ? filterRadius + 1.0 : 0.5;
    s.px = clamp(px, view.rectMinPx + border, view.rectMaxPx - border);
    s.atlas = view.atlasAndLayer & 0xFFu;
    s.layer = float(view.atlasAndLayer >> 8u);
    s.atlasPerTexel = vec2(view.atlasPerTexelX, view.atlasPerTexelY);
    return s;
}

// 1 where the receiver is at or before the stored depth.
float litBy(ShadowPoint s, float stored) {
    return (s.reversedZ ? stored <= s.depth : stored >= s.depth) ? 1.0 : 0.0;
}
vec4 litBy(ShadowPoint s, vec4 stored) {
    return s.reversedZ ? vec4(lessThanEqual(stored, vec4(s.depth))) : vec4(greaterThanEqual(stored, vec4(s.depth)));
}

float fetchShadowTexel(ShadowPoint s, ivec2 texel) {
    ivec3 at = ivec3(texel, int(s.layer));
    switch (s.atlas) {
        case 0u: return texelFetch(shadowAtlas0, at, 0).x;
        case 1u: return texelFetch(shadowAtlas1, at, 0).x;
        case 2u: return texelFetch(shadowAtlas2, at, 0).x;
        default: return texelFetch(shadowAtlas3, at, 0).x;
    }
}

// The 2x2 texels whose first one is `texel`, in the order of textureGather: (0,1), (1,1), (1,0), (0,0).
vec4 gatherShadowTexels(ShadowPoint s, ivec2 texel) {
    vec3 at = vec3((vec2(texel) + 1.0) * s.atlasPerTexel, s.layer);
    switch (s.atlas) {
        case 0u: return textureGather(sampler2DArray(shadowAtlas0, shadowSampler), at);
        case 1u: return textureGather(sampler2DArray(shadowAtlas1, shadowSampler), at);
        case 2u: return textureGather(sampler2DArray(shadowAtlas2, shadowSampler), at);
        default: return textureGather(sampler2DArray(shadowAtlas3, shadowSampler), at);
    }
}

#endif
