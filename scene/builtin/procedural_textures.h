#pragma once
// Textures painted by code from height fields: every one repeats seamlessly and is the same for the same arguments.

#include "scene/scene.h"

namespace gnomon::renderer {

struct PaintedTexture {
    Image colour;             // sRGB
    Image normal;             // glTF convention: green points to the top of the image
    Image metallicRoughness;  // green roughness, blue metallic (0)
    float metres = 1.0f;      // edge length of one repeat
};

PaintedTexture paintCobbles(std::uint32_t size);
// Stone courses, shifted by half a block per row. `tint` is the sRGB colour of the stone, 0 to 1.
PaintedTexture paintBlocks(std::uint32_t size, float metres, int across, int rows, const glm::vec3& tint);
PaintedTexture paintPlaster(std::uint32_t size, const glm::vec3& tint);
PaintedTexture paintPlanks(std::uint32_t size, const glm::vec3& tint);
PaintedTexture paintStripes(std::uint32_t size, const glm::vec3& first, const glm::vec3& second);
PaintedTexture paintClay(std::uint32_t size, const glm::vec3& tint);

}  // namespace gnomon::renderer
