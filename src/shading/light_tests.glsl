// Does a light reach a point? The one per-pixel test of phase 3, phase 4, EVALUATE and every lighting shader.
#ifndef GNOMON_SHADING_LIGHT_TESTS_GLSL
#define GNOMON_SHADING_LIGHT_TESTS_GLSL

#include "gpu_interface/structs.h"
#include "gpu_interface/numbers.h"

uint lightType(GpuLight light) { return light.typeAndFlags & kLightTypeMask; }
bool lightCasts(GpuLight light) { return (light.typeAndFlags & kLightCastsBit) != 0u; }

// Range, cone and mask. `toLight` is the unit direction from the point to the light (0 right at the light).
bool lightReaches(GpuLight light, vec3 positionWs, uint receiverMask, out vec3 toLight) {
    toLight = -light.directionWs;
    if ((light.lightMask & receiverMask) == 0u) return false;
    if (lightType(light) == kLightDirectional) return true;
    precise vec3 d = light.positionWs - positionWs;
    precise float squared = dot(d, d);
    precise float range = light.rangeMetres * light.rangeMetres;
    if (squared > range) return false;
    precise float inverse = inversesqrt(max(squared, 1e-30));  // one step where a division each costs dozens
    precise vec3 unit = d * inverse;
    toLight = unit;
    if (lightType(light) == kLightPoint) return true;
    precise float along = -dot(d, light.directionWs);
    precise float limit = light.cosOuter * (squared * inverse);
    return along >= limit;
}

// A face that looks away from a casting light is dark without sampling (paper, listing 7; corrected: facing means
// dot(faceNormal, directionToLight) > 0).
bool facesLight(vec3 faceNormalWs, vec3 toLight) {
    precise float c = dot(faceNormalWs, toLight);
    return c > 0.0;
}

#endif
