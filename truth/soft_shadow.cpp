#include "truth/soft_shadow.h"

#include <cmath>
#include <numbers>

#include "truth/random.h"

namespace gnomon::renderer {
namespace {

// From the unit square to the unit disk, keeping areas. Source: Shirley and Chiu 1997, "A Low Distortion Map Between
// Disk and Square".
glm::dvec2 diskOf(double u, double v) {
    const double a = 2.0 * u - 1.0, b = 2.0 * v - 1.0;
    if (a == 0.0 && b == 0.0) return glm::dvec2(0.0);
    constexpr double kEighth = std::numbers::pi / 4.0;
    const bool wide = std::abs(a) > std::abs(b);
    const double r = wide ? a : b, angle = wide ? kEighth * b / a : 2.0 * kEighth - kEighth * a / b;
    return r * glm::dvec2(std::cos(angle), std::sin(angle));
}

}  // namespace

glm::dvec3 directionTo(const LightSource& source, const glm::dvec3& position) {
    if (source.kind == LightKind::Directional) return -source.direction;
    const glm::dvec3 way = source.position - position;
    const double length = glm::length(way);
    return length > 0.0 ? way / length : glm::dvec3(0.0, 1.0, 0.0);
}

glm::dvec3 endOfRay(const LightSource& source, const glm::dvec3& position, double reachMetres) {
    return source.kind == LightKind::Directional ? position - reachMetres * source.direction : source.position;
}

double softVisibility(const TracedScene& scene, const TruthReceiver& receiver, const LightSource& source,
                      std::uint32_t raysPerSide, std::uint64_t seed) {
    const double reach = scene.reachMetres() + 1.0;
    const glm::dvec3 centre = endOfRay(source, receiver.position, reach);
    const glm::dvec3 axis = source.kind == LightKind::Spot ? source.direction : directionTo(source, receiver.position);
    const glm::dvec3 helper = std::abs(axis.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 right = glm::normalize(glm::cross(axis, helper)), up = glm::cross(axis, right);
    const double radius = source.kind == LightKind::Directional ? reach * std::tan(source.radius) : source.radius;
    std::uint32_t free = 0;
    for (std::uint32_t i = 0; i < raysPerSide * raysPerSide; ++i) {
        const double u = (i % raysPerSide + unitOf(mixedBits(seed + 2ull * i))) / raysPerSide;
        const double v = (i / raysPerSide + unitOf(mixedBits(seed + 2ull * i + 1ull))) / raysPerSide;
        const glm::dvec2 at = radius * diskOf(u, v);
        const glm::dvec3 end = centre + at.x * right + at.y * up;
        const bool below = !receiver.subsurface && glm::dot(receiver.normal, end - receiver.position) <= 0.0;
        const ShadowRay ray = {receiver.position, end, receiver.triangle, 0.0, receiver.subsurface};
        if (!below && !scene.blocked(ray)) ++free;
    }
    return static_cast<double>(free) / (raysPerSide * raysPerSide);
}

}  // namespace gnomon::renderer
