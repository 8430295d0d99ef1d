// The visibility of a light from a pixel, quantised: the one function behind slots, EVALUATE and inline shadows.
//
// Problem: a frame must not depend on which pair got a slot and which is evaluated while lighting.
// What we do: every evaluation, wherever it happens, returns the value that a slot can hold, and everything before it is
// precise, so that different pipelines compute the same bits. The 8 bits are perceptual: q = round(255 * sqrt(v)).
// A host's own provider: -DGNOMON_HOST_PROVIDER and, on the include path, gnomon_host_provider.glsl, which defines
//     float hostVisibility(GpuLight light, Receiver receiver, vec3 toLight);   // 0 dark to 1 lit
#ifndef GNOMON_GENERATE_SHADOWS_VISIBILITY_GLSL
#define GNOMON_GENERATE_SHADOWS_VISIBILITY_GLSL

#include "gpu_interface/numbers.h"

layout(constant_id = 1) const uint kProvider = kProviderPcf;
layout(constant_id = 3) const uint kPcfRadius = 1;

#include "generate_shadows/shadowmap.glsl"
#include "generate_shadows/hard.glsl"
#include "generate_shadows/pcf.glsl"
#ifdef GNOMON_HOST_PROVIDER
#include "gnomon_host_provider.glsl"  // glslc expands no macro here
#endif

float providerVisibility(GpuLight light, Receiver receiver, vec3 toLight) {
#ifdef GNOMON_HOST_PROVIDER
    return hostVisibility(light, receiver, toLight);
#else
    if (kProvider == kProviderHard) return hardVisibility(light, receiver, toLight);
    if (kProvider == kProviderPcf) return pcfVisibility(light, receiver, toLight);
    return 1.0;
#endif
}

// Unquantised; for a pixel that the light reaches.
float evaluateVisibility(GpuLight light, Receiver receiver, vec3 toLight) {
    if (!lightCasts(light) || kProvider == kProviderOff) return 1.0;
    precise float visibility = 0.0;
    if (receiver.subsurface || facesLight(receiver.faceNormalWs, toLight)) {
        visibility = providerVisibility(light, receiver, toLight);
    }
    precise float faded = 1.0 - light.shadowFade * (1.0 - visibility);
    return faded;
}

uint quantiseVisibility(float visibility) {
    precise float root = sqrt(clamp(visibility, 0.0, 1.0));
    return uint(255.0 * root + 0.5);
}

#endif
