#pragma once
// Scenes with shadows in closed form, and pixels that look at them without any GPU.

#include <vector>

#include "truth/figures.h"

namespace gnomon::renderer::truth_test {

/// A still scene of one instance per part.
class SceneBuilder {
public:
    SceneBuilder();
    /// Corners in order around; `cellsPerSide` squared cells of two triangles each.
    std::uint32_t quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d,
                       std::uint32_t cellsPerSide = 1);
    std::uint32_t sphere(const glm::vec3& centre, float radius, std::uint32_t segments);
    Scene scene;

private:
    std::uint32_t add(Primitive primitive);
};

/// Where the pixels of a camera at `eye` that looks at `target` lie, and on which triangles: every triangle is tried.
struct Seen {
    TruthExtent extent;
    std::vector<TruthReceiver> receivers;
};
Seen lookAt(const TracedScene& scene, const glm::dvec3& eye, const glm::dvec3& target, TruthExtent extent);

/// A receiver on the horizontal plane y = 0 that faces up; `own` is its triangle.
TruthReceiver onFloor(double x, double z, std::uint32_t own = kNone);

}  // namespace gnomon::renderer::truth_test
