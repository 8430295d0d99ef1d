#include "scene/builtin/triangle_grid.h"

#include <algorithm>
#include <cmath>

#include "scene/pose.h"

namespace gnomon::renderer {
namespace {

// Ericson, Real-Time Collision Detection (2005), section 5.1.5, by regions.
float squaredDistance(const glm::vec3& p, const TriangleGrid::Triangle& t) {
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

void addTriangles(const Scene& scene, const glm::mat4& worldFromObject, const Primitive& primitive,
                  const std::vector<glm::vec3>& positions, std::vector<TriangleGrid::Triangle>& triangles) {
    const bool mirrored = turnsWinding(glm::dmat3(glm::mat3(worldFromObject)));
    const auto world = [&](std::uint32_t i) { return glm::vec3(worldFromObject * glm::vec4(positions[i], 1.0f)); };
    const Material& material = scene.materials[primitive.material];
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
        TriangleGrid::Triangle t{world(primitive.indices[i]), world(primitive.indices[i + 1]),
                                 world(primitive.indices[i + 2]), material.doubleSided, material.subsurface};
        if (mirrored) std::swap(t.b, t.c);
        const float area = glm::length(t.areaNormal());
        if (area > 0.0f && std::isfinite(area)) triangles.push_back(t);
    }
}

}  // namespace

TriangleGrid::TriangleGrid(const Scene& scene) {
    const Pose rest = restPose(scene);
    auto posed = rest.deformed.begin();
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        for (const Primitive& primitive : scene.meshes[scene.instances[i].mesh].primitives)
            addTriangles(scene, glm::mat4(rest.worldFromObject[i]), primitive,
                         deforms(scene.instances[i], primitive) ? (posed++)->positions : primitive.positions,
                         triangles_);
    for (const Triangle& t : triangles_)
        for (const glm::vec3& p : {t.a, t.b, t.c}) bounds_.add(p);
    if (triangles_.empty()) return;
    // About two cells per triangle if they were spread evenly, at most 2 million cells.
    const glm::vec3 extent = glm::max(bounds_.max - bounds_.min, glm::vec3(1e-4f * bounds_.radius()));
    const float cells = std::clamp(2.0f * static_cast<float>(triangles_.size()), 64.0f, 2.0e6f);
    const float edge = std::cbrt(extent.x * extent.y * extent.z / cells);
    for (int k = 0; k < 3; ++k) {
        size_[static_cast<std::size_t>(k)] = std::clamp(static_cast<int>(extent[k] / edge) + 1, 1, 256);
        cellSize_[k] = extent[k] / static_cast<float>(size_[static_cast<std::size_t>(k)]);
    }
    fillCells();
}

void TriangleGrid::fillCells() {
    starts_.assign(
        static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(size_[2]) +
            1,
        0);
    const float cellRadius = 0.5f * glm::length(cellSize_);
    const auto forCells = [&](const Triangle& t, auto&& use) {
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
    for (const Triangle& t : triangles_) forCells(t, [&](std::size_t cell) { ++starts_[cell + 1]; });
    for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    members_.resize(starts_.back());
    std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
    for (std::uint32_t i = 0; i < triangles_.size(); ++i)
        forCells(triangles_[i], [&](std::size_t cell) { members_[next[cell]++] = i; });
}

TriangleGrid::Cell TriangleGrid::cellOf(const glm::vec3& point) const {
    Cell cell{};
    for (int k = 0; k < 3; ++k) {
        const auto i = static_cast<std::size_t>(k);
        const float at = (point[k] - bounds_.min[k]) / cellSize_[k];
        cell[i] = static_cast<int>(std::clamp(at, 0.0f, static_cast<float>(size_[i] - 1)));
    }
    return cell;
}

std::size_t TriangleGrid::indexOf(const Cell& cell) const {
    return (static_cast<std::size_t>(cell[2]) * static_cast<std::size_t>(size_[1]) +
            static_cast<std::size_t>(cell[1])) *
               static_cast<std::size_t>(size_[0]) +
           static_cast<std::size_t>(cell[0]);
}

// Möller and Trumbore 1997, both sides.
void TriangleGrid::castInCell(std::size_t cell, const glm::vec3& origin, const glm::vec3& direction,
                              std::optional<Hit>& nearest) const {
    for (std::uint32_t m = starts_[cell]; m < starts_[cell + 1]; ++m) {
        const Triangle& t = triangles_[members_[m]];
        const glm::vec3 e1 = t.b - t.a, e2 = t.c - t.a, p = glm::cross(direction, e2);
        const float determinant = glm::dot(e1, p);
        if (determinant == 0.0f) continue;
        const glm::vec3 s = (origin - t.a) / determinant;
        const float u = glm::dot(s, p);
        const glm::vec3 q = glm::cross(s, e1);
        const float v = glm::dot(direction, q), distance = glm::dot(e2, q);
        if (u < 0.0f || v < 0.0f || u + v > 1.0f || distance <= 0.0f) continue;
        if (!nearest || distance < nearest->distance)
            nearest = Hit{distance, members_[m], determinant < 0.0f && !t.doubleSided};
    }
}

std::optional<TriangleGrid::Hit> TriangleGrid::cast(const glm::vec3& origin, const glm::vec3& direction,
                                                    float reach) const {
    if (triangles_.empty()) return std::nullopt;
    float enter = 0.0f, leave = reach;
    for (int k = 0; k < 3; ++k) {
        if (direction[k] == 0.0f) {
            if (origin[k] < bounds_.min[k] || origin[k] > bounds_.max[k]) return std::nullopt;
            continue;
        }
        const float a = (bounds_.min[k] - origin[k]) / direction[k], b = (bounds_.max[k] - origin[k]) / direction[k];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b) + 1e-4f * std::abs(b - a));
    }
    if (enter > leave) return std::nullopt;
    Cell cell = cellOf(origin + enter * direction);
    std::optional<Hit> nearest;
    for (;;) {
        castInCell(indexOf(cell), origin, direction, nearest);
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
    if (nearest && nearest->distance >= reach) nearest.reset();
    return nearest;
}

bool TriangleGrid::anythingWithin(const glm::vec3& point, float distance) const {
    if (triangles_.empty()) return false;
    const Cell low = cellOf(point - distance), high = cellOf(point + distance);
    for (int z = low[2]; z <= high[2]; ++z)
        for (int y = low[1]; y <= high[1]; ++y)
            for (int x = low[0]; x <= high[0]; ++x) {
                const std::size_t cell = indexOf({x, y, z});
                for (std::uint32_t m = starts_[cell]; m < starts_[cell + 1]; ++m)
                    if (squaredDistance(point, triangles_[members_[m]]) < distance * distance) return true;
            }
    return false;
}

bool TriangleGrid::insideSolid(const glm::vec3& point) const {
    const float reach = 2.5f * bounds_.radius() + glm::length(point - bounds_.centre());
    int backs = 0, rays = 0;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z) {
                const int length = x * x + y * y + z * z;
                if (length != 1 && length != 3) continue;  // six axes, eight diagonals
                // A small tilt keeps rays off the edges of axis-aligned geometry.
                const glm::vec3 direction = glm::normalize(glm::vec3(x, y, z) + glm::vec3(0.013f, 0.029f, 0.021f));
                const std::optional<Hit> hit = cast(point, direction, reach);
                ++rays;
                backs += hit && hit->backFace ? 1 : 0;
            }
    return 4 * backs > rays;
}

}  // namespace gnomon::renderer
