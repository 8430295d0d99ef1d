#pragma once
// Where a scene's coordinates begin.
//
// Problem: a file in earth coordinates has its content 6,400 km from zero, where a float step is half a metre. Lights,
// cameras and bounds are floats.
// Here: nodes are composed in double, and everything else counts from an origin near the content. A scene near zero
// keeps zero, so that no bit of it depends on this rule.
//
//     middle    m = median of the centres of what is drawn, per axis; lights count, with 1 m, where nothing is drawn
//     reach     s = median distance of these centres from m, each with its own radius
//     size      r = median of the radii
//     far       m is farther than 4 s from zero, and farther than 1024 r: a float step there exceeds r / 8192
//     origin    the place of the outermost node within 4 s of m; without one, m to a power of two above s
//
// Medians, so that a parked object or a sky dome has no say. A node, because it is where the modeller had zero: drawn
// from there, the file is drawn as its content alone.

#include <glm/glm.hpp>
#include <span>

#include "scene/scene.h"

namespace gnomon::renderer {

/// `nodes`: places of nodes, parents first. The scene's own origin must still be zero. Throws PoseError where
/// the scene at rest does.
[[nodiscard]] glm::dvec3 originFor(const Scene& scene, std::span<const glm::dvec3> nodes,
                                   std::span<const glm::dvec3> lights);

}  // namespace gnomon::renderer
