#pragma once
// A finished frame's images on the CPU, in the scene's own terms. Images may be larger than the frame: `extent` is its
// active extent, in their upper left corner. All wait for the device and throw GpuError.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "gnomon/scene.h"
#include "picture/picture.h"
#include "renderer/gbuffer/gbuffer.h"

namespace gnomon::renderer {

/// `image`: of halves or floats, in GENERAL.
[[nodiscard]] HdrPicture pictureIn(const Device& device, const GpuImage& image, VkExtent2D extent);
/// As drawn, kNone at background.
[[nodiscard]] std::vector<std::uint32_t> triangleIdsIn(const Device& device, const GBuffer& gbuffer, VkExtent2D extent);
/// Distances along the view axis, infinity at background. `camera`: the frame's, by cameraOf().
[[nodiscard]] std::vector<float> depthsIn(const Device& device, const GBuffer& gbuffer, VkExtent2D extent,
                                          const Camera& camera);
/// Shading normals in world space, unit; zero at background.
[[nodiscard]] std::vector<glm::vec3> normalsIn(const Device& device, const GBuffer& gbuffer, VkExtent2D extent);

}  // namespace gnomon::renderer
