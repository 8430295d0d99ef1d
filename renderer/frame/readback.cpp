#include "renderer/frame/readback.h"

#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "renderer/frame/camera.h"

namespace gnomon::renderer {
namespace {

/// The active pixels of an image, row by row, `perPixel` values of T each.
template <typename T>
std::vector<T> activePixels(const Device& device, const GpuImage& image, VkImageLayout layout, VkExtent2D extent,
                            std::size_t perPixel = 1) {
    const std::vector<std::uint8_t> bytes = readImage(device, image, layout);
    const std::size_t row = perPixel * extent.width, rowBytes = perPixel * image.desc().width * sizeof(T);
    std::vector<T> values(row * extent.height);
    for (std::size_t y = 0; y < extent.height; ++y)
        std::memcpy(values.data() + y * row, bytes.data() + y * rowBytes, row * sizeof(T));
    return values;
}

constexpr VkImageLayout kDrawnLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;

// As src/shading/octahedral.glsl has it.
glm::vec3 unitVectorOf(std::uint32_t stored) {
    const glm::dvec2 e = glm::dvec2(stored & 0xFFFFu, stored >> 16) * (2.0 / 65535.0) - 1.0;
    glm::dvec3 n(e, 1.0 - std::abs(e.x) - std::abs(e.y));
    if (n.z < 0.0) {
        n.x = (1.0 - std::abs(e.y)) * (e.x >= 0.0 ? 1.0 : -1.0);
        n.y = (1.0 - std::abs(e.x)) * (e.y >= 0.0 ? 1.0 : -1.0);
    }
    return glm::normalize(n);
}

}  // namespace

HdrPicture pictureIn(const Device& device, const GpuImage& image, VkExtent2D extent) {
    HdrPicture picture{extent.width, extent.height, {}};
    if (image.desc().format == VK_FORMAT_R32G32B32A32_SFLOAT) {
        picture.rgba = activePixels<float>(device, image, VK_IMAGE_LAYOUT_GENERAL, extent, 4);
        picture.brightest = std::numeric_limits<float>::max();
        return picture;
    }
    const auto halves = activePixels<std::uint16_t>(device, image, VK_IMAGE_LAYOUT_GENERAL, extent, 4);
    picture.rgba.reserve(halves.size());
    for (const std::uint16_t half : halves) picture.rgba.push_back(glm::unpackHalf1x16(half));
    return picture;
}

std::vector<std::uint32_t> triangleIdsIn(const Device& device, const GBuffer& gbuffer, VkExtent2D extent) {
    return activePixels<std::uint32_t>(device, gbuffer.image(GBuffer::TriangleId), kDrawnLayout, extent);
}

std::vector<float> depthsIn(const Device& device, const GBuffer& gbuffer, VkExtent2D extent, const Camera& camera) {
    std::vector<float> depths = activePixels<float>(device, gbuffer.depth(), kDrawnLayout, extent);
    const float background = camera.deviceDepth == DeviceDepth::ReversedZ ? 0.0f : 1.0f;
    for (float& depth : depths)
        depth = depth == background ? std::numeric_limits<float>::infinity()
                                    : static_cast<float>(axisDistanceOf(camera, depth));
    return depths;
}

std::vector<glm::vec3> normalsIn(const Device& device, const GBuffer& gbuffer, VkExtent2D extent) {
    const auto stored = activePixels<std::uint32_t>(device, gbuffer.image(GBuffer::Normal), kDrawnLayout, extent);
    const std::vector<std::uint32_t> ids = triangleIdsIn(device, gbuffer, extent);
    std::vector<glm::vec3> normals(stored.size(), glm::vec3(0.0f));
    for (std::size_t i = 0; i < stored.size(); ++i)
        if (ids[i] != kNone) normals[i] = unitVectorOf(stored[i]);
    return normals;
}

}  // namespace gnomon::renderer
