#include "scene/outline.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gnomon::renderer {
namespace {

constexpr std::size_t kMorePoints = 2;  // the hull is thinned whenever it has grown so many times as large

bool turnsLeft(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0.0;
}

// Most points are within an octagon of eight outermost ones, and quickly told (Akl and Toussaint 1978).
void dropInner(std::vector<glm::dvec2>& points) {
    constexpr std::array<glm::dvec2, 8> kWays = {
        {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
    std::array<glm::dvec2, 8> corners;
    corners.fill(points.front());
    for (const glm::dvec2& p : points)
        for (std::size_t i = 0; i < kWays.size(); ++i)
            if (glm::dot(p, kWays[i]) > glm::dot(corners[i], kWays[i])) corners[i] = p;
    std::erase_if(points, [&](const glm::dvec2& p) {
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const glm::dvec2 &from = corners[i], &to = corners[(i + 1) % corners.size()];
            if (from != to && !turnsLeft(from, to, p)) return false;
        }
        return corners[0] != corners[4];
    });
}

// Andrew 1979: sorted points, the lower chain and then the upper one.
std::vector<glm::dvec2> convexHull(std::vector<glm::dvec2> points) {
    dropInner(points);
    std::ranges::sort(points, [](const auto& a, const auto& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    std::vector<glm::dvec2> hull;
    for (int chain = 0; chain < 2; ++chain) {
        const std::size_t first = hull.size();
        for (const glm::dvec2& p : points) {
            while (hull.size() >= first + 2 && !turnsLeft(hull[hull.size() - 2], hull.back(), p)) hull.pop_back();
            hull.push_back(p);
        }
        std::ranges::reverse(points);
    }
    return hull;
}

// The points that touch first when a line of this slope comes from either side: largest and least x + slope z.
struct Touched {
    glm::dvec2 most, least;
};
Touched touched(const Hull& hull, double slope) {
    const std::vector<glm::dvec2>& points = hull.points();
    Touched out{points.front(), points.front()};
    for (const glm::dvec2& p : points) {
        if (p.x + slope * p.y > out.most.x + slope * out.most.y) out.most = p;
        if (-p.x + slope * p.y > -out.least.x + slope * out.least.y) out.least = p;
    }
    return out;
}

double eyeZOf(const Hull& hull, double slope) {
    const auto [most, least] = touched(hull, slope);
    return 0.5 * ((most.x - least.x) / slope + most.y + least.y);
}

// Where both lines through the eye touch. Newton's method: the room between them is convex and piecewise linear in the
// slope, so it ends.
Span spanOf(const Hull& hull, double eyeZ) {
    constexpr int kMostSteps = 64;
    Span span;
    for (int step = 0; step < kMostSteps; ++step) {
        const auto [most, least] = touched(hull, span.slope);
        const double slope = (most.x - least.x) / (2.0 * eyeZ - most.y - least.y);
        span.centre = 0.5 * (most.x + least.x + slope * (most.y - least.y));
        if (slope <= span.slope) break;
        span.slope = slope;
    }
    return span;
}

}  // namespace

void Hull::add(const glm::dvec2& point) {
    points_.push_back(point);
    if (points_.size() < most_) return;
    points_ = convexHull(std::move(points_));
    most_ = std::max(most_, kMorePoints * points_.size());
}

void Outline::add(const glm::dvec3& point) {
    nearestZ_ = empty() ? point.z : std::max(nearestZ_, point.z);
    farthestZ_ = empty() ? point.z : std::min(farthestZ_, point.z);
    across_.add({point.x, point.z});
    up_.add({point.y, point.z});
}

double Outline::eyeZ(double slopeAcross, double slopeUp) const {
    if (empty()) return 0.0;
    return std::max(eyeZOf(across_, slopeAcross), eyeZOf(up_, slopeUp));
}

Span Outline::across(double eyeZ) const {
    return spanOf(across_, eyeZ);
}

Span Outline::up(double eyeZ) const {
    return spanOf(up_, eyeZ);
}

}  // namespace gnomon::renderer
