#pragma once
// Triangles in a uniform grid over a box, for rays and distances.

#include "scene/scene.h"

#include <array>
#include <optional>
#include <span>

namespace gnomon::renderer {

[[nodiscard]] inline bool isWithin(const Bounds& inner, const Bounds& outer) {
    return glm::all(glm::lessThanEqual(outer.min, inner.min)) && glm::all(glm::lessThanEqual(inner.max, outer.max));
}

struct GridTriangle {
    glm::vec3 a, b, c;
    bool doubleSided, subsurface;
    [[nodiscard]] glm::vec3 areaNormal() const { return 0.5f * glm::cross(b - a, c - a); }  // length: the area
    [[nodiscard]] Bounds bounds() const {
        Bounds box;
        for (const glm::vec3& p : {a, b, c}) box.add(p);
        return box;
    }
};

struct GridHit {
    float distance;
    std::uint32_t triangle;
    bool backFace;  // the ray met the back of a single-sided triangle: it came from inside a solid
};

class TriangleCells {
public:
    using Cell = std::array<int, 3>;

    // Those of the triangles that touch the box and are wanted.
    TriangleCells(std::span<const GridTriangle> triangles, const std::vector<bool>& wanted, const Bounds& box);

    // The nearest hit in (0, reach) within the box, where `found` has no nearer one.
    void cast(std::span<const GridTriangle> triangles, const glm::vec3& origin, const glm::vec3& direction, float reach,
              std::optional<GridHit>& found) const;
    [[nodiscard]] bool anythingWithin(std::span<const GridTriangle> triangles, const glm::vec3& point,
                                      float distance) const;

private:
    [[nodiscard]] Cell cellOf(const glm::vec3& point) const;
    [[nodiscard]] std::size_t indexOf(const Cell& cell) const;
    void castInCell(std::span<const GridTriangle> triangles, std::size_t cell, const glm::vec3& origin,
                    const glm::vec3& direction, std::optional<GridHit>& nearest) const;
    void fill(std::span<const GridTriangle> triangles, const std::vector<std::uint32_t>& inBox);

    Bounds bounds_;
    Cell size_{1, 1, 1};
    glm::vec3 cellSize_{1.0f};
    std::vector<std::uint32_t> starts_, members_;  // members_[starts_[i] .. starts_[i + 1]) lie in cell i
};

}  // namespace gnomon::renderer
