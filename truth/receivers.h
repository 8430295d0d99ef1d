#pragma once
// The points that pixels show: each on its own triangle, in double.

#include <cstdint>
#include <span>
#include <vector>

#include "truth/traced_scene.h"

namespace gnomon::renderer {

struct TruthReceiver {
    glm::dvec3 position{0.0};        ///< relative to the traced scene's origin
    glm::dvec3 normal{0.0};          ///< of the face, unit, on the side that the camera sees
    glm::dvec3 toEye{0.0};           ///< unit
    std::uint32_t triangle = kNone;  ///< kNone: background, or a triangle without area
    double pixelMetres = 0.0;        ///< width of a pixel at this depth
    bool subsurface = false;
};

/// Per pixel, rows from the top. `triangleIds` as Renderer::readTriangleIds() gives them; the camera posed.
/// A point is where the pixel's ray meets the plane of its triangle, or the point of the triangle nearest to that: a
/// rasterizer draws up to a fraction of a pixel beyond an edge.
[[nodiscard]] std::vector<TruthReceiver> receiversOf(const TracedScene& scene, const SceneCamera& camera,
                                                     std::uint32_t widthPx, std::uint32_t heightPx,
                                                     std::span<const std::uint32_t> triangleIds);

}  // namespace gnomon::renderer
