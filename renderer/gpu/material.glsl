// One material: descriptor set 1 (gpu_scene.h). Included by fragment shaders.
#ifndef GNOMON_RENDERER_MATERIAL_GLSL
#define GNOMON_RENDERER_MATERIAL_GLSL
#include "renderer/gpu/scene_data.h"

layout(set = 1, binding = 0, std140) uniform MaterialBlock { GpuMaterial material; };
layout(set = 1, binding = 1) uniform sampler2D baseColourTexture;
layout(set = 1, binding = 2) uniform sampler2D metallicRoughnessTexture;
layout(set = 1, binding = 3) uniform sampler2D normalTexture;
layout(set = 1, binding = 4) uniform sampler2D emissiveTexture;

bool hasTexture(GpuTextureUse use) { return use.offsetTexcoordPresent.w > 0.5; }

// Equal to the material's cut-off is opaque, roundings included: leastOpaqueAlpha() is what is compared with.
bool isCutOut(float alpha) { return alpha < material.emissiveAlphaCutoff.w; }

vec2 textureUv(GpuTextureUse use, vec2 uv0, vec2 uv1) {
    const vec2 uv = use.offsetTexcoordPresent.z > 0.5 ? uv1 : uv0;
    return vec2(dot(use.matrix.xy, uv), dot(use.matrix.zw, uv)) + use.offsetTexcoordPresent.xy;
}
#endif
