#pragma once
// What is drawn in a pose, thing by thing: a thing is one primitive of one instance.

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "scene/pose.h"

namespace gnomon::renderer {

using WorldTriangle = std::array<glm::dvec3, 3>;

struct Thing {
    Bounds box;  ///< world, around all of it
    std::uint32_t instance = 0, primitive = 0;
    std::size_t triangles = 0;
    /// Null where the vertices are gone: of something that deforms, after its pose.
    const std::vector<glm::vec3>* positions = nullptr;
    const std::vector<std::uint32_t>* indices = nullptr;
    glm::dmat4 worldFromObject{1.0};
    bool deforms = false;
};

/// World, of a thing with vertices.
[[nodiscard]] WorldTriangle triangleOf(const Thing& thing, std::size_t triangle);

/// Per instance: true where two times may show it elsewhere or deformed.
[[nodiscard]] std::vector<bool> movingInstances(const Scene& scene);

/// Those of the instances whose `moves` is `moving`. They point into the scene and, where they deform, into the pose.
[[nodiscard]] std::vector<Thing> thingsOf(const Scene& scene, const Pose& pose, const std::vector<bool>& moves,
                                          bool moving);

}  // namespace gnomon::renderer
