#pragma once
// Splits a primitive into clusters: runs of neighbouring triangles with a bounding sphere and box, small enough to be
// culled per view and large enough that a draw call per cluster costs nothing. Pure CPU.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace gnomon::renderer {

/// 512 triangles: a scene of 3 million triangles has some 6000 clusters, which a light's sphere test walks in 50 us.
inline constexpr std::uint32_t kClusterTriangles = 512;

struct Cluster {
    std::uint32_t firstTriangle = 0, triangleCount = 0;
    glm::vec3 centre{0.0f};  ///< object space; of the box and of the sphere
    float radius = 0.0f;
    glm::vec3 halfExtent{0.0f};  ///< of the box along the axes
};

struct ClusteredTriangles {
    std::vector<std::uint32_t> order;  ///< order[i]: index, in the primitive, of the triangle drawn as i-th
    std::vector<Cluster> clusters;     ///< firstTriangle counts from the primitive's first
};

/// Triangles sorted by the Morton code of their centroid (kept as they are if one cluster holds them all), then cut.
/// Deterministic. Thread safe.
ClusteredTriangles makeClusters(const std::vector<glm::vec3>& positions, const std::vector<std::uint32_t>& indices);

}  // namespace gnomon::renderer
