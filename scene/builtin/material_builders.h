#pragma once
// Materials that several built-in scenes share.

#include "scene/builtin/procedural_textures.h"
#include "scene/builtin/shapes.h"

namespace gnomon::renderer {

std::uint32_t plainMaterial(SceneBuilder& builder, const char* name, const glm::vec3& colour, float roughness = 0.8f,
                            float metallic = 0.0f);
// Textures of a painted set, one repeat per its edge length.
std::uint32_t texturedMaterial(SceneBuilder& builder, const char* name, PaintedTexture painted,
                               float normalScale = 1.0f);

}  // namespace gnomon::renderer
