#pragma once
// The bulk of a scene: what a picture frames and what scattered lights light.
//
// Problem: one parked vertex, a sky dome or a plate to the horizon makes the bounds say nothing about the rest.
// Here: medians over triangles, then whatever is not far joins.
//
//     weights   a triangle's area, but at most 256 times the median one, and at most a sixth of all: neither a fine
//               bulb in a room, nor a coarse plate under a town, nor a broken vertex has more to say than the rest
//     middle    m = weighted median of the centres, per axis
//     reach     R = weighted median of how far they reach from m
//     joins     what comes nearer to m than 4 R, and is not longer than 64 R. Then R is as far as that reaches, and so
//               on, until nothing joins. So only what has a gap around the rest is left out, or is as a horizon to it
//
// Some things are left out before, since they may outweigh all else. Each is judged by the middle and reach of smaller
// things, where these are no fewer than the others:
//
//     a sky     is around the middle of what is less than 0.6 times its size, and all of it is beyond R. Either it is
//               beyond 4 R, and its farthest point no farther than 4 times its nearest; or it is round, so that this is
//               1.4 times, which no room is
//     a plate   is flat, longer than 64 R of what is less than a quarter of its size, and has no more triangles
//               than that
//
// Medians take 2^12 triangles. Limit: a sky of many triangles within the same primitive as all the rest is the bulk.

#include <glm/glm.hpp>
#include <set>
#include <span>
#include <utility>

#include "scene/things.h"

namespace gnomon::renderer {

class Bulk {
public:
    /// `have` decide; `more` only join: the same things later in an animation.
    explicit Bulk(std::span<const Thing> have, std::span<const Thing> more = {});

    [[nodiscard]] const glm::dvec3& middle() const { return middle_; }
    [[nodiscard]] double reach() const { return reach_; }
    /// Triangles of `have`, and those of them that are not held.
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] std::size_t leftOut() const { return leftOut_; }

    /// True where no triangle need be asked.
    [[nodiscard]] bool holdsAllOf(const Thing& thing) const;
    /// Of a thing without vertices: its box stands for it.
    [[nodiscard]] bool holdsBoxOf(const Thing& thing) const;
    [[nodiscard]] bool holds(const Thing& thing, const WorldTriangle& triangle) const;
    /// Calls `work` with each triangle that is held of a thing with vertices.
    template <class Work>
    void forEachHeld(const Thing& thing, Work work) const {
        if (isLeftOut(thing) || isBeyond(thing)) return;
        for (std::size_t i = 0; i < thing.triangles; ++i)
            if (const WorldTriangle t = triangleOf(thing, i); holds(thing, t)) work(t);
    }

private:
    using Key = std::pair<std::uint32_t, std::uint32_t>;  // instance and primitive
    [[nodiscard]] bool isLeftOut(const Thing& thing) const;
    [[nodiscard]] bool isBeyond(const Thing& thing) const;

    std::set<Key> leftOutThings_;
    glm::dvec3 middle_{0.0};
    double reach_ = 0.0;
    std::size_t size_ = 0, leftOut_ = 0;
};

}  // namespace gnomon::renderer
