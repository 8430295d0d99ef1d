#include "scene/scatter/triangle_cells.h"

#include <algorithm>
#include <cmath>

namespace gnomon::renderer {
namespace {

// Ericson, Real-Time Collision Detection (2005), section 5.1.5, by regions.
float squaredDistance(const glm::vec3& p, const GridTriangle& t) {
    const glm::vec3 ab = t.b - t.a, ac = t.c - t.a, n = glm::cross(ab, ac);
    const auto toSegment = [&](const glm::vec3& s, const glm::vec3& e) {
        const glm::vec3 d = e - s;
        const float k = std::clamp(glm::dot(p - s, d) / glm::dot(d, d), 0.0f, 1.0f);
        return glm::dot(p - s - k * d, p - s - k * d);
    };
    const bool inside = glm::dot(glm::cross(ab, p - t.a), n) >= 0.0f &&
                        glm::dot(glm::cross(t.c - t.b, p - t.b), n) >= 0.0f &&
                        glm::dot(glm::cross(t.a - t.c, p - t.c), n) >= 0.0f;
    if (inside) {
        const float d = glm::dot(p - t.a, n);
        return d * d / glm::dot(n, n);
    }
    return std::min({toSegment(t.a, t.b), toSegment(t.b, t.c), toSegment(t.c, t.a)});
}

bool meet(const Bounds& a, const Bounds& b) {
    return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

}  // namespace

TriangleCells::TriangleCells(std::span<const GridTriangle> triangles, const std::vector<bool>& wanted,
                             const Bounds& box)
    : bounds_(box) {
    std::vector<std::uint32_t> inBox;
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
        if (wanted[i] && meet(triangles[i].bounds(), box)) inBox.push_back(i);
    // About two cells per triangle if they were spread evenly, at most 2 million cells.
    const glm::vec3 extent = glm::max(bounds_.max - bounds_.min, glm::vec3(1e-4f * bounds_.radius()));
    const float cells = std::clamp(2.0f * static_cast<float>(inBox.size()), 64.0f, 2.0e6f);
    const float edge = std::cbrt(extent.x * extent.y * extent.z / cells);
    for (int k = 0; k < 3; ++k) {
        size_[static_cast<std::size_t>(k)] = std::clamp(static_cast<int>(extent[k] / edge) + 1, 1, 256);
        cellSize_[k] = extent[k] / static_cast<float>(size_[static_cast<std::size_t>(k)]);
    }
    fill(triangles, inBox);
}

void TriangleCells::fill(std::span<const GridTriangle> triangles, const std::vector<std::uint32_t>& inBox) {
    starts_.assign(
        static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(size_[2]) +
            1,
        0);
    const float cellRadius = 0.5f * glm::length(cellSize_);
    const auto forCells = [&](const GridTriangle& t, auto&& use) {
        const glm::vec3 slack = 1e-3f * cellSize_;  // rounding in cast() may not step past a triangle
        const Cell low = cellOf(glm::min(glm::min(t.a, t.b), t.c) - slack),
                   high = cellOf(glm::max(glm::max(t.a, t.b), t.c) + slack);
        const glm::vec3 n = glm::normalize(t.areaNormal());
        for (int z = low[2]; z <= high[2]; ++z)
            for (int y = low[1]; y <= high[1]; ++y)
                for (int x = low[0]; x <= high[0]; ++x) {
                    const glm::vec3 centre = bounds_.min + (glm::vec3(x, y, z) + 0.5f) * cellSize_;
                    if (std::abs(glm::dot(centre - t.a, n)) <= 1.01f * cellRadius) use(indexOf({x, y, z}));
                }
    };
    for (const std::uint32_t i : inBox) forCells(triangles[i], [&](std::size_t cell) { ++starts_[cell + 1]; });
    for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    members_.resize(starts_.back());
    std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
    for (const std::uint32_t i : inBox) forCells(triangles[i], [&](std::size_t cell) { members_[next[cell]++] = i; });
}

TriangleCells::Cell TriangleCells::cellOf(const glm::vec3& point) const {
    Cell cell{};
    for (int k = 0; k < 3; ++k) {
        const auto i = static_cast<std::size_t>(k);
        const float at = (point[k] - bounds_.min[k]) / cellSize_[k];
        cell[i] = static_cast<int>(std::clamp(at, 0.0f, static_cast<float>(size_[i] - 1)));
    }
    return cell;
}

std::size_t TriangleCells::indexOf(const Cell& cell) const {
    return (static_cast<std::size_t>(cell[2]) * static_cast<std::size_t>(size_[1]) +
            static_cast<std::size_t>(cell[1])) *
               static_cast<std::size_t>(size_[0]) +
           static_cast<std::size_t>(cell[0]);
}

// Möller and Trumbore 1997, both sides.
void TriangleCells::castInCell(std::span<const GridTriangle> triangles, std::size_t cell, const glm::vec3& origin,
                               const glm::vec3& direction, std::optional<GridHit>& nearest) const {
    for (std::uint32_t m = starts_[cell]; m < starts_[cell + 1]; ++m) {
        const GridTriangle& t = triangles[members_[m]];
        const glm::vec3 e1 = t.b - t.a, e2 = t.c - t.a, p = glm::cross(direction, e2);
        const float determinant = glm::dot(e1, p);
        if (determinant == 0.0f) continue;
        const glm::vec3 s = (origin - t.a) / determinant;
        const float u = glm::dot(s, p);
        const glm::vec3 q = glm::cross(s, e1);
        const float v = glm::dot(direction, q), distance = glm::dot(e2, q);
        if (u < 0.0f || v < 0.0f || u + v > 1.0f || distance <= 0.0f) continue;
        if (!nearest || distance < nearest->distance)
            nearest = GridHit{distance, members_[m], determinant < 0.0f && !t.doubleSided};
    }
}

void TriangleCells::cast(std::span<const GridTriangle> triangles, const glm::vec3& origin, const glm::vec3& direction,
                         float reach, std::optional<GridHit>& found) const {
    float enter = 0.0f, leave = reach;
    for (int k = 0; k < 3; ++k) {
        if (direction[k] == 0.0f) {
            if (origin[k] < bounds_.min[k] || origin[k] > bounds_.max[k]) return;
            continue;
        }
        const float a = (bounds_.min[k] - origin[k]) / direction[k], b = (bounds_.max[k] - origin[k]) / direction[k];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b) + 1e-4f * std::abs(b - a));
    }
    if (enter > leave) return;
    Cell cell = cellOf(origin + enter * direction);
    std::optional<GridHit> nearest;
    for (;;) {
        castInCell(triangles, indexOf(cell), origin, direction, nearest);
        float exit = std::numeric_limits<float>::infinity();
        int axis = 0;
        for (int k = 0; k < 3; ++k) {
            if (direction[k] == 0.0f) continue;
            const float wall =
                bounds_.min[k] +
                static_cast<float>(cell[static_cast<std::size_t>(k)] + (direction[k] > 0.0f)) * cellSize_[k];
            const float at = (wall - origin[k]) / direction[k];
            if (at < exit) {
                exit = at;
                axis = k;
            }
        }
        if (nearest && nearest->distance <= exit) break;
        const auto i = static_cast<std::size_t>(axis);
        cell[i] += direction[axis] > 0.0f ? 1 : -1;
        if (exit > leave || cell[i] < 0 || cell[i] >= size_[i]) break;
    }
    if (nearest && nearest->distance < reach && !(found && found->distance <= nearest->distance)) found = nearest;
}

bool TriangleCells::anythingWithin(std::span<const GridTriangle> triangles, const glm::vec3& point,
                                   float distance) const {
    const Cell low = cellOf(point - distance), high = cellOf(point + distance);
    for (int z = low[2]; z <= high[2]; ++z)
        for (int y = low[1]; y <= high[1]; ++y)
            for (int x = low[0]; x <= high[0]; ++x) {
                const std::size_t cell = indexOf({x, y, z});
                for (std::uint32_t m = starts_[cell]; m < starts_[cell + 1]; ++m)
                    if (squaredDistance(point, triangles[members_[m]]) < distance * distance) return true;
            }
    return false;
}

}  // namespace gnomon::renderer
