#include "scene/builtin/material_builders.h"

namespace gnomon::renderer {

std::uint32_t plainMaterial(SceneBuilder& builder, const char* name, const glm::vec3& colour, float roughness,
                            float metallic) {
    Material material;
    material.name = name;
    material.baseColour = glm::vec4(colour, 1.0f);
    material.roughness = roughness;
    material.metallic = metallic;
    return builder.material(std::move(material));
}

std::uint32_t texturedMaterial(SceneBuilder& builder, const char* name, PaintedTexture painted, float normalScale) {
    Material material;
    material.name = name;
    material.metallic = 0.0f;
    material.normalScale = normalScale;
    material.roughness = 1.0f;
    const auto use = [&](Image& image) {
        TextureUse texture;
        texture.image = builder.image(std::move(image));
        texture.uvTransform = glm::mat2(1.0f / painted.metres);
        return texture;
    };
    material.baseColourTexture = use(painted.colour);
    material.normalTexture = use(painted.normal);
    material.metallicRoughnessTexture = use(painted.metallicRoughness);
    return builder.material(std::move(material));
}

}  // namespace gnomon::renderer
