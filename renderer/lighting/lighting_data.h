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
    vec3 intensity;      // candela (directional: lux) per colour channel
    float coneScale;     // spot: smooth edge = saturate(cos * scale + offset)^2, as KHR_lights_punctual recommends
    float coneOffset;    // else scale 0, offset 1
    float reserved0;
    float reserved1;
    float reserved2;
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
