// Over floors. A random point of a random upward-facing triangle is chosen by area (normal within 60 degrees of up).
// From there the light goes a random way up: 2 to 15 % of the scene's height, but at most half of the free way to
// whatever is above. Three kinds of places are refused: outside the bounds, closer than 0.2 % of the bounds' radius to
// a triangle, and inside a solid. Bounds are those of the bulk of the scene. After 64 refusals the scene is taken to be
// full. Its measures are shares of the whole, which gives an even picture where rooms are of one size. It fails where
// the whole says nothing about the rooms (many small ones, far apart), where nothing looks up (ceilings and walls
// alone, or a town turned inside out), and where triangles are turned at random.
//
// By room. So the rest of the lights go by what is near. A random point of any surface is chosen by area, those that
// look up first. The room there is the free way up or, on other surfaces, along the normal; or the median of twelve
// rays around the point, if that is less; in the open, a part of the triangle's size. The light hangs at 20 to 50 % of
// that, with a quarter of its height free all around. It is never behind its own surface, so it shines on something
// that is drawn: a town turned inside out is drawn from its inside, and lit there. What else is demanded becomes less
// every 64 refusals:
//
//     within the bounds, outside solids, and not below all else
//     within the bounds, with no more backs of faces around it than fronts: files have them turned at random
//     outside solids
//     nothing

#include "scene/scatter/light_places.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gnomon::renderer {
namespace {

constexpr int kTriesPerLight = 64;  // by each rule
constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr float kGoldenAngle = 2.39996323f;

// Enough to step off a surface: floats are no finer at the place, nor is the triangle.
float liftOff(const SurfacePoint& foot) {
    const glm::vec3 p = glm::abs(foot.position);
    return std::max(1.0e-6f * std::max({p.x, p.y, p.z}), 1.0e-5f * foot.sizeMetres);
}

}  // namespace

glm::vec3 tilted(const glm::vec3& axis, float angle, float turn) {
    glm::vec3 x(1, 0, 0), z(0, 0, 1);
    if (std::abs(axis.y) != 1.0f) {
        x = glm::normalize(glm::cross(axis, glm::vec3(0, 1, 0)));
        z = glm::cross(x, axis);
    }
    return glm::normalize(std::sin(angle) * std::cos(turn) * x + std::cos(angle) * axis +
                          std::sin(angle) * std::sin(turn) * z);
}

LightPlaces::LightPlaces(const TriangleGrid& grid)
    : grid_(grid),
      all_(grid, [](const glm::vec3&) { return true; }),
      upward_(grid, [](const glm::vec3& n) { return n.y > 0.5f; }) {}

std::optional<LightPlace> LightPlaces::overFloors(Random& random) const {
    if (upward_.empty()) return std::nullopt;
    const Bounds& bounds = grid_.bounds();
    const float radius = bounds.radius(), clearance = 0.002f * radius, high = bounds.max.y - bounds.min.y;
    const float height = std::max(high, 0.2f * radius);
    for (int i = 0; i < kTriesPerLight; ++i) {
        const glm::vec3 foot = upward_.point(random).position + glm::vec3(0, 1e-5f * radius, 0);
        const float wanted = height * random.between(0.02f, 0.15f);
        const auto above = grid_.castInBulk(foot, {0, 1, 0}, 2.0f * wanted);
        if (above && above->backFace) continue;
        const float up = above ? std::min(wanted, 0.5f * above->distance) : wanted;
        const glm::vec3 position = foot + glm::vec3(0, up, 0);
        // A flat scene has no height: there, lights hang above its bounds.
        if (position.y > bounds.max.y && high >= 0.02f * radius) continue;
        if (up < clearance || grid_.anythingWithin(position, clearance) || grid_.insideSolid(position)) continue;
        return LightPlace{position, up, {0, -1, 0}, false};
    }
    return std::nullopt;
}

std::optional<LightPlace> LightPlaces::byRoom(Random& random, float mostMetres) const {
    for (const Demand demand : {Demand::All, Demand::WithinBounds, Demand::OutsideSolids, Demand::None})
        for (int i = 0; i < kTriesPerLight; ++i) {
            const bool floors = !upward_.empty() && 2 * i < kTriesPerLight;
            if (const auto place = tryRoom(floors ? upward_ : all_, random, mostMetres, demand)) return place;
        }
    return std::nullopt;
}

std::optional<LightPlace> LightPlaces::tryRoom(const SurfaceSampler& feet, Random& random, float mostMetres,
                                               Demand demand) const {
    constexpr float kFreeAround = 0.25f;
    const SurfacePoint foot = feet.point(random);
    const float share = random.between(0.2f, 0.5f);
    const GridTriangle& triangle = grid_.triangles()[foot.triangle];
    glm::vec3 up = glm::normalize(triangle.areaNormal());
    if (triangle.doubleSided && up.y < 0.0f) up = -up;
    if (up.y > 0.5f) up = {0, 1, 0};
    const glm::vec3 from = foot.position + liftOff(foot) * up;
    const auto above = grid_.castInBulk(from, up, kFar);
    if (demand == Demand::All && up.y < -0.5f && !above) return std::nullopt;  // below the world
    float room = roomAround(from, up, foot.sizeMetres);
    if (above) room = std::min(room, above->distance);
    const float height = std::min(share * room, mostMetres);
    const glm::vec3 position = from + height * up;
    const bool withinBounds = demand == Demand::All || demand == Demand::WithinBounds;
    if (withinBounds && !isWithin({position, position}, grid_.bounds())) return std::nullopt;
    if (position == from || grid_.anythingWithin(position, kFreeAround * height)) return std::nullopt;
    const TriangleGrid::Sight sight = grid_.sightFrom(position);
    const bool refused =
        demand == Demand::WithinBounds ? sight.backs > sight.fronts : demand != Demand::None && sight.isInsideSolid();
    if (refused) return std::nullopt;
    return LightPlace{position, height, -up, true};
}

float LightPlaces::roomAround(const glm::vec3& foot, const glm::vec3& up, float otherwise) const {
    constexpr int kRays = 12;
    constexpr float kLow = 1.4f, kHigh = 1.0f;  // radians off the normal
    constexpr float kOfTriangle = 0.4f;
    std::vector<float> distances;
    for (int i = 0; i < kRays; ++i) {
        const glm::vec3 way = tilted(up, i % 2 == 0 ? kLow : kHigh, kGoldenAngle * static_cast<float>(i));
        if (const auto hit = grid_.castInBulk(foot, way, kFar)) distances.push_back(hit->distance);
    }
    if (distances.empty()) return kOfTriangle * std::min(otherwise, grid_.bounds().radius());
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    return *middle;
}

bool LightPlaces::shinesOnAnything(const SceneLight& light) const {
    constexpr int kRays = 128;
    const bool spot = light.kind == LightKind::Spot;
    const glm::vec3 axis = spot ? light.direction : glm::vec3(0, -1, 0);
    const float least = spot ? std::cos(light.outerConeAngle) : -1.0f;
    for (int i = 0; i < kRays; ++i) {  // from the axis outwards, evenly over the sphere
        const float cosine = 1.0f - (1.0f - least) * static_cast<float>(i) / kRays;
        const glm::vec3 way = tilted(axis, std::acos(cosine), kGoldenAngle * static_cast<float>(i));
        const auto hit = grid_.castInBulk(light.position, way, light.rangeMetres);
        if (hit && !hit->backFace) return true;
    }
    return false;
}

}  // namespace gnomon::renderer
