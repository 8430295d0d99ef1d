#pragma once
// The outline of many points for an eye that looks one way: what decides where it must stand, and how wide it sees.
//
// Points are as a camera has them: x to the right, y up, z backwards. The eye looks along -z. A picture touches points
// on the convex hulls of (x, z) and (y, z) alone. So no more than these are kept, however many points there are.

#include <glm/glm.hpp>
#include <vector>

namespace gnomon::renderer {

class Hull {
public:
    void add(const glm::dvec2& point);
    /// Corners, and perhaps some points within.
    [[nodiscard]] const std::vector<glm::dvec2>& points() const { return points_; }

private:
    std::vector<glm::dvec2> points_;
    std::size_t most_ = 4096;  // then those within are dropped
};

/// Where along one axis of the picture, and how widely, an eye must look that stands at depth z.
struct Span {
    double centre = 0.0;  // of the eye
    double slope = 0.0;   // tangent of half the angle
};

class Outline {
public:
    void add(const glm::dvec3& point);
    [[nodiscard]] bool empty() const { return across_.points().empty(); }
    [[nodiscard]] double nearestZ() const { return nearestZ_; }
    [[nodiscard]] double farthestZ() const { return farthestZ_; }
    /// The least z of an eye that sees all points within these slopes; 0 where there is no point.
    [[nodiscard]] double eyeZ(double slopeAcross, double slopeUp) const;
    /// The narrowest spans that show all points. `eyeZ` is above nearestZ().
    [[nodiscard]] Span across(double eyeZ) const;
    [[nodiscard]] Span up(double eyeZ) const;

private:
    Hull across_, up_;
    double nearestZ_ = 0.0, farthestZ_ = 0.0;  // nearest to the eye: largest
};

}  // namespace gnomon::renderer
