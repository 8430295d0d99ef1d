#pragma once
// World-space triangles of a scene in a uniform grid: ray casts and distances for placing lights in free space.

#include "scene/scene.h"

#include <array>
#include <optional>

namespace gnomon::renderer {

class TriangleGrid {
public:
    struct Triangle {
        glm::vec3 a, b, c;
        bool doubleSided, subsurface;
        [[nodiscard]] glm::vec3 areaNormal() const { return 0.5f * glm::cross(b - a, c - a); }  // length: the area
    };
    struct Hit {
        float distance;
        std::uint32_t triangle;  // into triangles()
        bool backFace;           // the ray met the back of a single-sided triangle: it came from inside a solid
    };

    // The scene at rest. Triangles without area are left out. Mirroring instances keep their outward winding.
    explicit TriangleGrid(const Scene& scene);

    [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
    [[nodiscard]] const Bounds& bounds() const { return bounds_; }

    // The nearest hit within (0, reach); `direction` is unit.
    [[nodiscard]] std::optional<Hit> cast(const glm::vec3& origin, const glm::vec3& direction, float reach) const;
    [[nodiscard]] bool anythingWithin(const glm::vec3& point, float distance) const;
    // More than a quarter of 14 rays all around meet the inside of a surface first.
    [[nodiscard]] bool insideSolid(const glm::vec3& point) const;

private:
    using Cell = std::array<int, 3>;
    [[nodiscard]] Cell cellOf(const glm::vec3& point) const;
    [[nodiscard]] std::size_t indexOf(const Cell& cell) const;
    void castInCell(std::size_t cell, const glm::vec3& origin, const glm::vec3& direction,
                    std::optional<Hit>& nearest) const;
    void fillCells();

    std::vector<Triangle> triangles_;
    Bounds bounds_;
    Cell size_{1, 1, 1};
    glm::vec3 cellSize_{1.0f};
    std::vector<std::uint32_t> starts_, members_;  // members_[starts_[i] .. starts_[i + 1]) lie in cell i
};

}  // namespace gnomon::renderer
