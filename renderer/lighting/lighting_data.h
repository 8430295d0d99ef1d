// What the reference renderer's lighting shaders read beyond the library's buffers. Compiled as C++ and as GLSL.
#ifndef GNOMON_RENDERER_LIGHTING_DATA_H
#define GNOMON_RENDERER_LIGHTING_DATA_H

#include "gpu_interface/structs.h"
#ifdef __cplusplus
namespace gnomon::renderer {
using namespace gnomon::gpu;
#endif

// By the index of the light in the scene (GpuLight::hostIndex).
struct HostLight {
    vec3 intensity;  // candela (directional: lux) per colour channel
    // Spot: smooth edge = saturate((coneVersine - versine) * coneScale)^2, versine = 1 - cos of the angle to the axis.
    // It is KHR_lights_punctual's edge, by what stays exact in a narrow cone.
    float coneVersine;
    float coneScale;
    // The light fades by 1 - (d * d * windowPerSquareMetre)^2 towards its range, as KHR_lights_punctual has it. 0: it
    // is the inverse square alone, and its range only culls.
    float windowPerSquareMetre;
    float reserved0;
    float reserved1;
};

struct SceneConstants {
    vec4 skyRadiance;     // from above and as background
    vec4 groundRadiance;  // from below
};

#ifdef __cplusplus
static_assert(sizeof(HostLight) == 32);
}  // namespace gnomon::renderer
#endif
#endif
