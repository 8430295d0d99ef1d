#pragma once
// How far a triangle is from a point.

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace gnomon::renderer {

/// Of the origin from the segment.
[[nodiscard]] inline double distanceToSegment(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 along = b - a;
    const double squared = glm::dot(along, along);
    const double t = squared > 0.0 ? std::clamp(-glm::dot(a, along) / squared, 0.0, 1.0) : 0.0;
    return glm::length(a + t * along);
}

/// Of the origin from the triangle, which may be a line or a point.
[[nodiscard]] inline double distanceToTriangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double area = glm::length(normal);
    const bool above = area > 0.0 && glm::dot(glm::cross(b - a, normal), a) >= 0.0 &&
                       glm::dot(glm::cross(c - b, normal), b) >= 0.0 && glm::dot(glm::cross(a - c, normal), c) >= 0.0;
    if (above) return std::abs(glm::dot(normal, a)) / area;
    return std::min({distanceToSegment(a, b), distanceToSegment(b, c), distanceToSegment(c, a)});
}

}  // namespace gnomon::renderer
