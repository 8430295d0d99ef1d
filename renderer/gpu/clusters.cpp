#include "renderer/gpu/clusters.h"

#include <algorithm>
#include <numeric>

namespace gnomon::renderer {

namespace {

// Spreads the low 10 bits two apart.
std::uint32_t spread(std::uint32_t v) {
    v = (v | (v << 16)) & 0x030000FFu;
    v = (v | (v << 8)) & 0x0300F00Fu;
    v = (v | (v << 4)) & 0x030C30C3u;
    return (v | (v << 2)) & 0x09249249u;
}

std::vector<std::uint32_t> mortonOrder(const std::vector<glm::vec3>& positions,
                                       const std::vector<std::uint32_t>& indices) {
    const std::size_t count = indices.size() / 3;
    std::vector<glm::vec3> centroids(count);
    glm::vec3 low(std::numeric_limits<float>::infinity()), high(-std::numeric_limits<float>::infinity());
    for (std::size_t t = 0; t < count; ++t) {
        centroids[t] =
            (positions[indices[3 * t]] + positions[indices[3 * t + 1]] + positions[indices[3 * t + 2]]) / 3.0f;
        low = glm::min(low, centroids[t]);
        high = glm::max(high, centroids[t]);
    }
    // One scale for all axes, so that cells are cubes.
    const float extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-20f});
    std::vector<std::uint32_t> codes(count);
    for (std::size_t t = 0; t < count; ++t) {
        const glm::vec3 cell = glm::clamp((centroids[t] - low) * (1023.0f / extent), 0.0f, 1023.0f);
        codes[t] = spread(static_cast<std::uint32_t>(cell.x)) | (spread(static_cast<std::uint32_t>(cell.y)) << 1) |
                   (spread(static_cast<std::uint32_t>(cell.z)) << 2);
    }
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return codes[a] < codes[b]; });
    return order;
}

}  // namespace

ClusteredTriangles makeClusters(const std::vector<glm::vec3>& positions, const std::vector<std::uint32_t>& indices) {
    ClusteredTriangles result;
    const auto count = static_cast<std::uint32_t>(indices.size() / 3);
    if (count > kClusterTriangles) {
        result.order = mortonOrder(positions, indices);
    } else {
        result.order.resize(count);
        std::iota(result.order.begin(), result.order.end(), 0u);
    }
    for (std::uint32_t first = 0; first < count; first += kClusterTriangles) {
        Cluster cluster;
        cluster.firstTriangle = first;
        cluster.triangleCount = std::min(kClusterTriangles, count - first);
        glm::vec3 low(std::numeric_limits<float>::infinity()), high(-std::numeric_limits<float>::infinity());
        auto forEachVertex = [&](auto&& visit) {
            for (std::uint32_t i = first; i < first + cluster.triangleCount; ++i) {
                for (std::uint32_t c = 0; c < 3; ++c) visit(positions[indices[3 * result.order[i] + c]]);
            }
        };
        forEachVertex([&](const glm::vec3& p) { low = glm::min(low, p), high = glm::max(high, p); });
        cluster.centre = 0.5f * (low + high);
        cluster.halfExtent = 0.5f * (high - low);
        float radius2 = 0.0f;
        forEachVertex(
            [&](const glm::vec3& p) { radius2 = std::max(radius2, glm::dot(p - cluster.centre, p - cluster.centre)); });
        // Rounded up: the sphere must hold every vertex in spite of float arithmetic.
        cluster.radius = std::sqrt(radius2) * (1.0f + 1e-6f) + 1e-6f * glm::length(cluster.centre);
        result.clusters.push_back(cluster);
    }
    return result;
}

}  // namespace gnomon::renderer
