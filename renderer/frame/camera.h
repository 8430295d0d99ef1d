#pragma once
// From the scene's camera to the library's.

#include <glm/glm.hpp>

#include "gnomon/scene.h"
#include "scene/scene.h"

namespace gnomon::renderer {

/// The frame's origin for a camera: the nearest point of a grid of 1024 m, so the world's own origin while the camera
/// is within 512 m of it. A float step there is at most 0.06 mm.
glm::dvec3 frameOriginOf(const SceneCamera& camera);

/// Matrices relative to `origin`, for the camera as fittedCamera() has it, for an extent in pixels. Clip space is
/// Vulkan's, y down.
Camera cameraOf(const SceneCamera& camera, const glm::dvec3& origin, std::uint32_t widthPx, std::uint32_t heightPx,
                DeviceDepth depth);

/// How far along the view axis that lies which has this device depth, for a camera by cameraOf(): the inverse of its
/// projection, in double.
double axisDistanceOf(const Camera& camera, float deviceDepth);

}  // namespace gnomon::renderer
