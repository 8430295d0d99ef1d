#include "renderer/shadow_atlas/part_extent.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gnomon::renderer {
namespace {

// Of a box, from its centre.
double reachAlong(const ScenePart& part, const glm::dvec3& axis) {
    return std::abs(glm::dot(part.halfAxes[0], axis)) + std::abs(glm::dot(part.halfAxes[1], axis)) +
           std::abs(glm::dot(part.halfAxes[2], axis));
}

double heightAbove(const Plane& plane, const glm::dvec3& point) {
    return glm::dot(plane.normal, point) + plane.offset;
}

// What Sutherland and Hodgman's way leaves of a polygon on the inner side of a plane.
void cut(std::vector<glm::dvec3>& polygon, const Plane& plane, std::vector<glm::dvec3>& scratch) {
    scratch.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3 &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
        const double a = heightAbove(plane, from), b = heightAbove(plane, to);
        if (a >= 0.0) scratch.push_back(from);
        if ((a < 0.0) != (b < 0.0)) scratch.push_back(from + (to - from) * (a / (a - b)));
    }
    polygon.swap(scratch);
}

}  // namespace

std::vector<Plane> planesOf(const CullVolume& volume) {
    std::vector<Plane> planes;
    for (int i = 0; i < volume.planeCount; ++i) {
        const glm::dvec3 normal(volume.planes[i]);
        planes.push_back({normal, static_cast<double>(volume.planes[i].w) - glm::dot(normal, volume.origin)});
    }
    return planes;
}

std::optional<Extent> extentWithin(const ScenePart& part, std::span<const Plane> planes, const glm::dvec3& axis) {
    const double middle = glm::dot(part.centre, axis), reach = reachAlong(part, axis);
    std::vector<Plane> crossed;
    for (const Plane& plane : planes) {
        const double height = heightAbove(plane, part.centre), radius = reachAlong(part, plane.normal);
        if (height < -radius) return std::nullopt;
        if (height < radius) crossed.push_back(plane);
    }
    if (crossed.empty()) return Extent{middle - reach, middle + reach};
    Extent extent = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    std::vector<glm::dvec3> polygon, scratch;
    for (int face = 0; face < 6; ++face) {
        const glm::dvec3 out = part.halfAxes[face / 2] * (face % 2 == 0 ? 1.0 : -1.0);
        const glm::dvec3 &u = part.halfAxes[(face / 2 + 1) % 3], &v = part.halfAxes[(face / 2 + 2) % 3];
        const glm::dvec3 at = part.centre + out;
        polygon = {at - u - v, at + u - v, at + u + v, at - u + v};
        for (const Plane& plane : crossed) cut(polygon, plane, scratch);
        for (const glm::dvec3& corner : polygon) {
            extent.low = std::min(extent.low, glm::dot(corner, axis));
            extent.high = std::max(extent.high, glm::dot(corner, axis));
        }
    }
    if (extent.low > extent.high) return std::nullopt;  // it stands beside an edge
    return extent;
}

bool holds(const ScenePart& part, const glm::dvec3& point) {
    if (!(std::abs(glm::determinant(part.halfAxes)) > 0.0)) return false;
    const glm::dvec3 within = glm::abs(glm::inverse(part.halfAxes) * (point - part.centre));
    return std::max({within.x, within.y, within.z}) <= 1.0;
}

std::optional<Plane> planeOfFlat(const ScenePart& part, const glm::dvec3& direction) {
    constexpr double kThickness = 1e-6;  // of the box's length
    constexpr double kGrazing = 0.02;    // sine of the angle between light and plane
    int thin = 0;
    for (int i = 1; i < 3; ++i)
        if (glm::length(part.halfAxes[i]) < glm::length(part.halfAxes[thin])) thin = i;
    const glm::dvec3 &u = part.halfAxes[(thin + 1) % 3], &v = part.halfAxes[(thin + 2) % 3];
    glm::dvec3 normal = glm::cross(u, v);
    const double area = glm::length(normal);
    if (!(area > 0.0) || glm::length(part.halfAxes[thin]) > kThickness * part.radius) return std::nullopt;
    normal /= area;
    const double towards = glm::dot(normal, direction);
    if (std::abs(towards) < kGrazing) return std::nullopt;
    if (towards > 0.0) normal = -normal;
    return Plane{normal, -glm::dot(normal, part.centre)};
}

std::optional<ScenePart> shadowOn(const Plane& plane, const ScenePart& part, const glm::dvec3& direction) {
    constexpr double kRounding = 4e-7;  // of coordinates in floats
    constexpr double kPenumbra = 0.02;  // of the way that light travels; the sun's is half of that
    const double falls = -glm::dot(plane.normal, direction);
    const double height = heightAbove(plane, part.centre), top = height + reachAlong(part, plane.normal);
    if (top <= kRounding * (glm::length(part.centre) + part.radius)) return std::nullopt;
    const auto along = [&](const glm::dvec3& v) { return v + direction * (glm::dot(plane.normal, v) / falls); };
    ScenePart shadow;
    shadow.centre = part.centre + direction * (height / falls);
    for (int i = 0; i < 3; ++i) {
        shadow.halfAxes[i] = along(part.halfAxes[i]);
        shadow.radius += glm::length(shadow.halfAxes[i]);
    }
    const double wider = 1.0 + kPenumbra * (top / falls) / std::max(shadow.radius, 1e-30);
    shadow.halfAxes *= wider;
    shadow.radius *= wider;
    return shadow;
}

}  // namespace gnomon::renderer
