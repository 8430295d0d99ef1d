// What shadow views a casting light has. A pipeline that serves one kind alone knows it when it is made.
#ifndef GNOMON_VISIBILITY_LIGHT_VIEWS_GLSL
#define GNOMON_VISIBILITY_LIGHT_VIEWS_GLSL

#include "gpu_interface/numbers.h"
#include "shading/light_tests.glsl"

layout(constant_id = kSpecShadowViews) const uint kShadowViews = kShadowViewsAny;

uint shadowViewsOf(GpuLight light) {
    if (lightType(light) == kLightDirectional) return kShadowViewsCascades;
    return (light.typeAndFlags & kLightSixFacesBit) != 0u ? kShadowViewsSixFaces : kShadowViewsOne;
}

bool hasShadowViews(GpuLight light, uint kind) {
    return kShadowViews == kShadowViewsAny ? shadowViewsOf(light) == kind : kShadowViews == kind;
}

#endif
