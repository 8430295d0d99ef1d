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

layout(constant_id = kSpecPcfRadius) const uint kPcfRadius = 1;

#include "visibility/filters.glsl"
#include "visibility/hard.glsl"
#include "visibility/pcf.glsl"
#include "visibility/pcss.glsl"
#include "visibility/choose_view.glsl"
#include "visibility/pcss_quad.glsl"
#include "shading/stored_visibility.glsl"
#ifdef GNOMON_HOST_PROVIDER
#include "gnomon_host_provider.glsl"  // glslc expands no macro here
#endif

// What the search of a receiver's quad has told, for its filter.
struct KnownSearch {
    bool known;    // else the pixel searches by itself
    float radius;  // of the filter, in the unit of radii; below 0: `visibility` is known
    float visibility;
};

KnownSearch knownSearch(uint quad, uint viewIndex) {
    KnownSearch search = KnownSearch(quad != kQuadOwn, -1.0, 0.0);
    if (quad == kQuadLit || quad == kQuadLitIfAsked) search.visibility = 1.0;
    if (quad == kQuadDark || quad > kQuadMostRadius) return search;
    precise float radius = float(quad) * (1.0 / float(kQuadRadiusParts)) * texelOf(viewIndex);
    search.radius = radius;
    return search;
}

float viewVisibility(uint viewIndex, GpuLight light, Receiver receiver, KnownSearch search) {
    bool sharing = hasFilter(light, kFilterPcssShared);
    if (sharing && search.known && search.radius < 0.0) return search.visibility;
    ShadowPoint s = shadowPointIn(viewIndex, light, receiver);
    if (!s.inFront) return 1.0;
    if (hasFilter(light, kFilterHard)) return hardVisibility(s);
    if (hasFilter(light, kFilterPcf)) return pcfVisibility(s);
    if (!sharing && !hasFilter(light, kFilterPcss)) return 1.0;
    return pcssVisibility(light, s, receiver.pixel, sharing, sharing && search.known, search.radius);
}

// `quad`: what the search of the receiver's quad has told. It is kQuadOwn for filters without such a search.
float builtInVisibility(GpuLight light, Receiver receiver, uint quad) {
    ViewChoice choice = chooseView(light, receiver);
    if (choice.none) return 1.0;
    KnownSearch search = knownSearch(quad, choice.view);
    precise float weight = 1.0 - choice.border;
    precise float visibility = 0.0;
    for (uint i = 0u; i < 2u; ++i) {  // a loop, so that the filter's code exists once
        precise float seen = 1.0;
        if (i == 0u || !choice.last) seen = viewVisibility(choice.view + i, light, receiver, search);
        visibility += weight * seen;
        if (choice.border == 0.0) break;
        weight = choice.border;
    }
    return visibility;
}

// How much of the shadow is there: directional lights lose it with the pixel's distance, others with their own.
float shadowFadeOf(GpuLight light, Receiver receiver) {
    if (lightType(light) != kLightDirectional) return light.shadowFade;
    precise vec3 d = receiver.positionWs - frame.eyeWs;
    precise float distance = sqrt(dot(d, d));
    precise float fade = light.shadowFadePerMetre * distance + light.shadowFade;
    return clamp(fade, 0.0, 1.0);
}

// For a pixel that a casting light reaches, where the search of its quad is known.
float visibilityWithQuad(GpuLight light, Receiver receiver, vec3 toLight, uint quad) {
    precise float visibility = 0.0;
    if (asksShadowmap(receiver, toLight)) {
#ifdef GNOMON_HOST_PROVIDER
        if (hasFilter(light, kFilterHost)) visibility = hostVisibility(light, receiver, toLight);
        else
#endif
        visibility = builtInVisibility(light, receiver, quad);
    }
    precise float faded = 1.0 - shadowFadeOf(light, receiver) * (1.0 - visibility);
    return faded;
}

// Unquantised; for a pixel that the light reaches.
float evaluateVisibility(GpuLight light, Receiver receiver, vec3 toLight) {
    if (!lightCasts(light) || kFilters == 0u) return 1.0;
    uint quad = kQuadOwn;
    if (hasFilter(light, kFilterPcssShared)) quad = searchQuad(light, receiver.pixel & ~uvec2(1u)).code;
    return visibilityWithQuad(light, receiver, toLight, quad);
}

uint quantiseVisibility(float visibility) {
    precise float root = sqrt(clamp(visibility, 0.0, 1.0));
    precise float level = float(kVisibilityLevels) * root + 0.5;
    return uint(level);
}

#endif
