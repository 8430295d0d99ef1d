#include "scene/bulk.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/medians.h"
#include "scene/triangle_distance.h"

namespace gnomon::renderer {
namespace {

constexpr double kGap = 4.0;    // reaches of empty space that part the bulk from what is far
constexpr double kLong = 64.0;  // reaches; the plane below a ball, 40 times as long as the ball's radius, is no horizon
constexpr double kSmaller = 0.25;
constexpr std::size_t kMostSamples = 1u << 16;
constexpr std::size_t kMostShells = 16;  // the largest things are looked at

struct Middle {
    glm::dvec3 at{0.0};
    double reach = 0.0;
};

double diagonal(const Bounds& box) {
    return glm::length(glm::dvec3(box.max) - glm::dvec3(box.min));
}

double nearest(const Bounds& box, const glm::dvec3& p) {
    return glm::length(glm::max(glm::max(glm::dvec3(box.min) - p, p - glm::dvec3(box.max)), glm::dvec3(0.0)));
}

double farthest(const Bounds& box, const glm::dvec3& p) {
    return glm::length(glm::max(glm::dvec3(box.max) - p, p - glm::dvec3(box.min)));
}

double nearest(const WorldTriangle& t, const glm::dvec3& p) {
    return distanceToTriangle(t[0] - p, t[1] - p, t[2] - p);
}

double farthest(const WorldTriangle& t, const glm::dvec3& p) {
    return std::max({glm::length(t[0] - p), glm::length(t[1] - p), glm::length(t[2] - p)});
}

double longestEdge(const WorldTriangle& t) {
    return std::max({glm::length(t[1] - t[0]), glm::length(t[2] - t[1]), glm::length(t[0] - t[2])});
}

bool joins(const WorldTriangle& t, const Middle& m) {
    return longestEdge(t) <= kLong * m.reach && nearest(t, m.at) <= kGap * m.reach;
}

bool joins(const Bounds& box, const Middle& m) {
    return diagonal(box) <= kLong * m.reach && nearest(box, m.at) <= kGap * m.reach;
}

Ball ballAround(const WorldTriangle& t) {
    const glm::dvec3 centre = (t[0] + t[1] + t[2]) / 3.0;
    return {centre, farthest(t, centre)};
}

Ball ballAround(const Bounds& box) {
    return {0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max)), 0.5 * diagonal(box)};
}

// Evenly over the triangles. What is a point shows nothing, and counts only where there is nothing else.
std::vector<Ball> samplesOf(const std::vector<const Thing*>& things) {
    std::size_t triangles = 0;
    for (const Thing* thing : things) triangles += thing->triangles;
    const std::size_t stride = triangles / kMostSamples + 1;
    std::vector<Ball> balls, points;
    std::size_t next = 0;  // counted from the first triangle of the thing
    for (const Thing* thing : things) {
        for (; next < thing->triangles; next += stride) {
            const Ball ball =
                thing->positions != nullptr ? ballAround(triangleOf(*thing, next)) : ballAround(thing->box);
            (ball.radius > 0.0 ? balls : points).push_back(ball);
        }
        next -= thing->triangles;
    }
    return balls.empty() ? points : balls;
}

Middle medianOf(const std::vector<const Thing*>& things) {
    const std::vector<Ball> balls = samplesOf(things);
    if (balls.empty()) return {};
    const glm::dvec3 at = medianCentre(balls);
    return {at, medianReach(balls, at)};
}

// How far the middle reaches with what joins of the thing.
double reachWith(const Thing& thing, const Middle& m) {
    const double most = farthest(thing.box, m.at);
    if (most <= m.reach || nearest(thing.box, m.at) > kGap * m.reach) return m.reach;
    if (thing.positions == nullptr) return joins(thing.box, m) ? most : m.reach;
    double reach = m.reach;
    for (std::size_t i = 0; i < thing.triangles; ++i) {
        const WorldTriangle t = triangleOf(thing, i);
        const double far = farthest(t, m.at);
        if (far > reach && joins(t, m)) reach = far;
    }
    return reach;
}

void grow(const std::vector<const Thing*>& things, Middle& m) {
    for (double before = -1.0; m.reach > before;) {
        before = m.reach;
        double reach = m.reach;
        for (const Thing* thing : things) reach = std::max(reach, reachWith(*thing, m));
        m.reach = reach;
    }
}

bool isShellAround(const Thing& thing, const Middle& m) {
    if (nearest(thing.box, m.at) > m.reach || thing.positions == nullptr) return false;
    for (std::size_t i = 0; i < thing.triangles; ++i)
        if (!(nearest(triangleOf(thing, i), m.at) > kGap * m.reach)) return false;
    return true;
}

// `bySize` with the largest first.
std::vector<const Thing*> withoutShells(const std::vector<const Thing*>& bySize) {
    std::vector<const Thing*> kept = bySize;
    for (std::size_t i = 0; i < std::min(bySize.size(), kMostShells); ++i) {
        const Thing& thing = *bySize[i];
        std::vector<const Thing*> smaller;
        for (const Thing* other : bySize)
            if (diagonal(other->box) < kSmaller * diagonal(thing.box)) smaller.push_back(other);
        if (smaller.empty()) continue;
        Middle m = medianOf(smaller);
        if (!isShellAround(thing, m)) continue;
        grow(smaller, m);
        if (isShellAround(thing, m)) std::erase(kept, &thing);
    }
    return kept;
}

}  // namespace

Bulk::Bulk(std::span<const Thing> have, std::span<const Thing> more) {
    std::vector<const Thing*> things;
    for (const Thing& thing : have) things.push_back(&thing);
    std::ranges::stable_sort(things,
                             [](const Thing* a, const Thing* b) { return diagonal(a->box) > diagonal(b->box); });
    Middle m = medianOf(withoutShells(things));
    for (const Thing& thing : more) things.push_back(&thing);
    grow(things, m);
    middle_ = m.at;
    reach_ = m.reach;
    for (const Thing& thing : have) {
        size_ += thing.triangles;
        if (holdsAllOf(thing)) continue;
        if (holdsNothingOf(thing))
            leftOut_ += thing.triangles;
        else
            for (std::size_t i = 0; i < thing.triangles; ++i) leftOut_ += holds(triangleOf(thing, i)) ? 0 : 1;
    }
}

bool Bulk::holds(const WorldTriangle& triangle) const {
    return joins(triangle, {middle_, reach_});
}

bool Bulk::holds(const Bounds& box) const {
    return joins(box, {middle_, reach_});
}

bool Bulk::holdsAllOf(const Thing& thing) const {
    return thing.positions == nullptr ? holds(thing.box) : farthest(thing.box, middle_) <= reach_;
}

bool Bulk::holdsNothingOf(const Thing& thing) const {
    return thing.positions == nullptr ? !holds(thing.box) : nearest(thing.box, middle_) > kGap * reach_;
}

}  // namespace gnomon::renderer
