// The visibility of a light from a pixel, quantised: the one function behind slots, EVALUATE and inline shadows.
//
// Problem: a frame must not depend on which pair got a slot and which is evaluated while lighting.
// What we do: every evaluation, wherever it happens, returns a value that a slot can hold. Everything before it is
// precise, so that different pipelines compute the same bits. The values are perceptual: q = round(255 * sqrt(v)), or
// 15 in place of 255 with slots of 4 bits.
// A host's own provider: compile with -DGNOMON_HOST_PROVIDER, and with a gnomon_host_provider.glsl on the include path.
// That file defines
//     float hostVisibility(GpuLight light, Receiver receiver, vec3 toLight);   // 0 dark to 1 lit
#ifndef GNOMON_VISIBILITY_VISIBILITY_GLSL
#define GNOMON_VISIBILITY_VISIBILITY_GLSL

#include "gpu_interface/numbers.h"

// Filters that lights may have; with one there is nothing to choose.
layout(constant_id = kSpecFilters) const uint kFilters = 1u << kFilterPcss;
layout(constant_id = kSpecPcfRadius) const uint kPcfRadius = 1;

#include "visibility/cascades.glsl"
#include "visibility/hard.glsl"
#include "visibility/pcf.glsl"
#include "visibility/pcss.glsl"
#include "shading/stored_visibility.glsl"
#ifdef GNOMON_HOST_PROVIDER
#include "gnomon_host_provider.glsl"  // glslc expands no macro here
#endif

bool hasFilter(GpuLight light, uint filterOfLight) {
    uint bit = 1u << filterOfLight;
    if ((kFilters & bit) == 0u) return false;
    return kFilters == bit || (light.typeAndFlags >> kLightFilterShift & kLightFilterMask) == filterOfLight;
}

float viewVisibility(uint viewIndex, GpuLight light, Receiver receiver) {
    ShadowPoint s = shadowPointIn(viewIndex, light, receiver);
    if (!s.inFront) return 1.0;
    if (hasFilter(light, kFilterHard)) return hardVisibility(s);
    if (hasFilter(light, kFilterPcf)) return pcfVisibility(s);
    if (hasFilter(light, kFilterPcss)) return pcssVisibility(light, s, receiver.pixel);
    return 1.0;
}

// The first cascade that holds the receiver. It is blended with the next one where that holds the receiver, too. The
// last one blends into light.
float cascadedVisibility(GpuLight light, Receiver receiver) {
    uint count = cascadeCount(light);
    float border;
    uint cascade = cascadeOf(light, receiver.positionWs, border);
    if (cascade == count) return 1.0;
    bool last = cascade + 1u == count;
    float ignored;
    if (border > 0.0 && !last && !cascadeHolds(light.shadowView + cascade + 1u, receiver.positionWs, ignored)) {
        border = 0.0;
    }
    precise float weight = 1.0 - border;
    precise float visibility = 0.0;
    for (uint i = 0u; i < 2u; ++i) {  // a loop, so that the filter's code exists once
        precise float seen = 1.0;
        if (i == 0u || !last) seen = viewVisibility(light.shadowView + cascade + i, light, receiver);
        visibility += weight * seen;
        if (border == 0.0) break;
        weight = border;
    }
    return visibility;
}

float providerVisibility(GpuLight light, Receiver receiver, vec3 toLight) {
#ifdef GNOMON_HOST_PROVIDER
    if (hasFilter(light, kFilterHost)) return hostVisibility(light, receiver, toLight);
#endif
    if (lightType(light) == kLightDirectional) return cascadedVisibility(light, receiver);
    uint face = lightHasSixFaces(light) ? cubeFace(receiver.positionWs - light.positionWs) : 0u;
    return viewVisibility(light.shadowView + face, light, receiver);
}

// How much of the shadow is there: directional lights lose it with the pixel's distance, others with their own.
float shadowFadeOf(GpuLight light, Receiver receiver) {
    if (lightType(light) != kLightDirectional) return light.shadowFade;
    precise vec3 d = receiver.positionWs - frame.eyeWs;
    precise float distance = sqrt(dot(d, d));
    precise float fade = light.shadowFadePerMetre * distance + light.shadowFade;
    return clamp(fade, 0.0, 1.0);
}

// Unquantised; for a pixel that the light reaches.
float evaluateVisibility(GpuLight light, Receiver receiver, vec3 toLight) {
    if (!lightCasts(light) || kFilters == 0u) return 1.0;
    precise float visibility = 0.0;
    if (kFacedAwayIsDark == 0u || receiver.subsurface || facesLight(receiver.faceNormalWs, toLight)) {
        visibility = providerVisibility(light, receiver, toLight);
    }
    precise float faded = 1.0 - shadowFadeOf(light, receiver) * (1.0 - visibility);
    return faded;
}

uint quantiseVisibility(float visibility) {
    precise float root = sqrt(clamp(visibility, 0.0, 1.0));
    precise float level = float(kVisibilityLevels) * root + 0.5;
    return uint(level);
}

#endif
