#pragma once
// The bulk of a scene: what a picture frames and what scattered lights light.
//
// Problem: one parked vertex, a sky dome or a plate to the horizon makes the bounds say nothing about the rest.
// Here: medians over triangles, then whatever is not far joins.
//
//     middle    m = median of the centres of the triangles, per axis
//     reach     R = median of how far they reach from m
//     joins     what comes nearer to m than 4 R, and is not longer than 64 R. Then R is as far as that reaches, and so
//               on, until nothing joins
//     shells    have no say in m and R: things all of which is farther than 4 R from the middle of those that are less
//               than a quarter of their size, and that are around it. A sky may have more triangles than all below it
//
// So only what has a gap around the rest is left out, or a plate that is 64 times as long. Medians take 2^16 triangles.
// Limit: a sky that is one primitive with the rest, and has more triangles than it, is the bulk.

#include <glm/glm.hpp>
#include <span>

#include "scene/things.h"

namespace gnomon::renderer {

class Bulk {
public:
    /// `have` decide; `more` only join: the same things later in an animation.
    explicit Bulk(std::span<const Thing> have, std::span<const Thing> more = {});

    [[nodiscard]] const glm::dvec3& middle() const { return middle_; }
    [[nodiscard]] double reach() const { return reach_; }
    [[nodiscard]] bool holds(const WorldTriangle& triangle) const;
    /// Of what has no vertices: the box stands for it.
    [[nodiscard]] bool holds(const Bounds& box) const;
    /// Triangles of `have`, and those of them that are not held.
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] std::size_t leftOut() const { return leftOut_; }
    /// Everything of the thing is held, or nothing; its triangles need not be asked.
    [[nodiscard]] bool holdsAllOf(const Thing& thing) const;
    [[nodiscard]] bool holdsNothingOf(const Thing& thing) const;

private:
    glm::dvec3 middle_{0.0};
    double reach_ = 0.0;
    std::size_t size_ = 0, leftOut_ = 0;
};

}  // namespace gnomon::renderer
