#pragma once
// How far parts of the scene reach along an axis within some planes, and where their shadows fall on a plane.

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "renderer/gpu/cull_volume.h"

namespace gnomon::renderer {

/// Inside where dot(normal, p) + offset >= 0.
struct Plane {
    glm::dvec3 normal{0.0};
    double offset = 0.0;
};
/// The planes of a volume, in world space. Its sphere is left out.
[[nodiscard]] std::vector<Plane> planesOf(const CullVolume& volume);

struct Extent {
    double low = 0.0, high = 0.0;
};
/// Of a part's box along `axis`, as far as it lies within the planes. Nothing where none of it does. The planes must
/// leave one side open, so that no box holds all that is within them.
[[nodiscard]] std::optional<Extent> extentWithin(const ScenePart& part, std::span<const Plane> planes,
                                                 const glm::dvec3& axis);

/// Whether a point lies in a part's box.
[[nodiscard]] bool holds(const ScenePart& part, const glm::dvec3& point);

/// The plane of a part without thickness, its normal towards where `direction` comes from. Nothing for any other part,
/// and where the direction grazes it.
[[nodiscard]] std::optional<Plane> planeOfFlat(const ScenePart& part, const glm::dvec3& direction);

/// Where the shadow of a part falls on a plane, with room for a penumbra. Light travels in `direction`, and the normal
/// of the plane points towards where it comes from. Nothing for parts that do not stand above the plane.
[[nodiscard]] std::optional<ScenePart> shadowOn(const Plane& plane, const ScenePart& part, const glm::dvec3& direction);

}  // namespace gnomon::renderer
