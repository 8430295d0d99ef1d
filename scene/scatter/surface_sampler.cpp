#include "scene/scatter/surface_sampler.h"

#include <algorithm>
#include <cmath>

namespace gnomon::renderer {
namespace {

// Sutherland and Hodgman 1974, against one side of a box.
std::vector<glm::vec3> clippedBy(const std::vector<glm::vec3>& polygon, int axis, float limit, float sign) {
    std::vector<glm::vec3> out;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::vec3 &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
        const float begin = sign * (limit - from[axis]), end = sign * (limit - to[axis]);
        if (begin >= 0.0f) out.push_back(from);
        if ((begin > 0.0f && end < 0.0f) || (begin < 0.0f && end > 0.0f)) {
            out.push_back(from + (to - from) * (begin / (begin - end)));
            out.back()[axis] = limit;
        }
    }
    return out;
}

std::vector<glm::vec3> clippedTo(const GridTriangle& t, const Bounds& box) {
    std::vector<glm::vec3> polygon = {t.a, t.b, t.c};
    for (int axis = 0; axis < 3; ++axis) {
        polygon = clippedBy(polygon, axis, box.max[axis], 1.0f);
        polygon = clippedBy(polygon, axis, box.min[axis], -1.0f);
    }
    return polygon;
}

}  // namespace

SurfaceSampler::SurfaceSampler(const TriangleGrid& grid, const std::function<bool(const glm::vec3&)>& accept)
    : grid_(grid) {
    double sum = 0.0;
    for (std::uint32_t i = 0; i < grid.triangles().size(); ++i) {
        const glm::vec3 n = grid.triangles()[i].areaNormal();
        if (!accept(glm::normalize(n))) continue;
        if (!isWithin(grid.triangles()[i].bounds(), grid.bounds())) {
            addClipped(i, sum);
            continue;
        }
        sum += glm::length(n);
        sums_.push_back(sum);
        pieces_.push_back(i);
    }
}

void SurfaceSampler::addClipped(std::uint32_t triangle, double& sum) {
    const std::vector<glm::vec3> polygon = clippedTo(grid_.triangles()[triangle], grid_.bounds());
    for (std::size_t i = 2; i < polygon.size(); ++i) {
        const float area = 0.5f * glm::length(glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]));
        if (!(area > 0.0f)) continue;
        sum += area;
        sums_.push_back(sum);
        pieces_.push_back(static_cast<std::uint32_t>(grid_.triangles().size() + clipped_.size()));
        clipped_.push_back({polygon[0], polygon[i - 1], polygon[i], triangle});
    }
}

SurfaceSampler::Piece SurfaceSampler::pieceOf(std::uint32_t index) const {
    const std::size_t whole = grid_.triangles().size();
    if (index >= whole) return clipped_[index - whole];
    const GridTriangle& t = grid_.triangles()[index];
    return {t.a, t.b, t.c, index};
}

SurfacePoint SurfaceSampler::point(Random& random) const {
    const double at = sums_.back() * static_cast<double>(random.unit()) + sums_.back() * random.unit() / 16777216.0;
    const auto found = std::lower_bound(sums_.begin(), sums_.end() - 1, at) - sums_.begin();
    const Piece t = pieceOf(pieces_[static_cast<std::size_t>(found)]);
    const float root = std::sqrt(random.unit()), along = random.unit();
    const float size = std::max({glm::length(t.b - t.a), glm::length(t.c - t.b), glm::length(t.a - t.c)});
    return {(1.0f - root) * t.a + root * (1.0f - along) * t.b + root * along * t.c, t.triangle, size};
}

}  // namespace gnomon::renderer
