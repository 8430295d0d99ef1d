// Scattering lights over any scene, of any size.
//
// Place. A random point of a random upward-facing triangle is chosen by area (normal within 60 degrees of up; all
// triangles where there is none). From there the light goes a random way up: 2 to 15 % of the scene's height, but at
// most half of the free way to whatever is above. Three kinds of places are refused: outside the bounds, closer than
// 0.2 % of the bounds' radius to a triangle, and inside a solid. After 64 refusals per light the scene is taken to be
// full.
//
// Range. As in a lit game level, the mean number of lights in range of a random surface point shall be 4.5, whatever
// the scene and the count. Instead of a formula for an ideal floor, the range is found by bisection over 512 random
// surface points. Spots count by the share of the sphere they cover. Each light then varies the range by up to a
// quarter.
// With a TileDensity the range is found by bisection over tiles of the picture instead, every light's variation
// included. Then 64 lights and 1024 cost the same per tile.
//
// Intensity. About 8 lux at a third of the range, times 0.6 to 1.6. So a picture's exposure depends neither on the
// scene's unit nor on the count. Source radius: 0.8 to 4 % of the free way that was used, 2 to 10 cm in a room.

#include "scene/builtin/builtin.h"
#include "scene/builtin/random.h"
#include "scene/builtin/tile_samples.h"
#include "scene/builtin/triangle_grid.h"

#include <algorithm>
#include <cmath>

namespace gnomon::renderer {
namespace {

constexpr float kMeanLightsPerPoint = 4.5f;
constexpr int kTriesPerLight = 64;
constexpr int kSurfacePoints = 512;
constexpr float kDegree = 0.01745329252f;

// Chooses triangles by area among those that `accept` takes.
class SurfaceSampler {
public:
    template <class Accept>
    SurfaceSampler(const TriangleGrid& grid, Accept accept) : grid_(grid) {
        double sum = 0.0;
        for (std::uint32_t i = 0; i < grid.triangles().size(); ++i) {
            const glm::vec3 n = grid.triangles()[i].areaNormal();
            if (!accept(glm::normalize(n))) continue;
            sum += glm::length(n);
            sums_.push_back(sum);
            triangles_.push_back(i);
        }
    }
    [[nodiscard]] bool empty() const { return triangles_.empty(); }

    glm::vec3 point(Random& random) const {
        const double at = sums_.back() * static_cast<double>(random.unit()) + sums_.back() * random.unit() / 16777216.0;
        const auto found = std::lower_bound(sums_.begin(), sums_.end() - 1, at) - sums_.begin();
        const TriangleGrid::Triangle& t = grid_.triangles()[triangles_[static_cast<std::size_t>(found)]];
        const float root = std::sqrt(random.unit()), along = random.unit();
        return (1.0f - root) * t.a + root * (1.0f - along) * t.b + root * along * t.c;
    }

private:
    const TriangleGrid& grid_;
    std::vector<double> sums_;
    std::vector<std::uint32_t> triangles_;
};

glm::vec3 pleasantColour(Random& random) {
    // Half warm (orange to yellow), a third cool (teal to blue), the rest pink and violet; never fully saturated.
    const float kind = random.unit();
    const float hue = kind < 0.5f    ? random.between(0.04f, 0.14f)
                      : kind < 0.83f ? random.between(0.48f, 0.62f)
                                     : random.between(0.78f, 0.95f);
    const float saturation = random.between(0.55f, 0.85f);
    glm::vec3 colour;
    for (int c = 0; c < 3; ++c) {
        const float k = std::fmod(hue * 6.0f + (c == 0 ? 5.0f : c == 1 ? 3.0f : 1.0f), 6.0f);
        colour[c] = 1.0f - saturation * std::clamp(std::min(k, 4.0f - k), 0.0f, 1.0f);
    }
    return colour;
}

struct Place {
    glm::vec3 position;
    float free;  // metres of air below, down to the surface it was thrown from
};

std::optional<Place> findPlace(const TriangleGrid& grid, const SurfaceSampler& surfaces, Random& random) {
    const float radius = grid.bounds().radius(), clearance = 0.002f * radius;
    const float height = std::max(grid.bounds().max.y - grid.bounds().min.y, 0.2f * radius);
    for (int i = 0; i < kTriesPerLight; ++i) {
        const glm::vec3 foot = surfaces.point(random) + glm::vec3(0, 1e-5f * radius, 0);
        const float wanted = height * random.between(0.02f, 0.15f);
        const auto above = grid.cast(foot, {0, 1, 0}, 2.0f * wanted);
        if (above && above->backFace) continue;
        const float up = above ? std::min(wanted, 0.5f * above->distance) : wanted;
        const Place place{foot + glm::vec3(0, up, 0), up};
        // A flat scene has no height: there, lights hang above its bounds.
        const bool flat = grid.bounds().max.y - grid.bounds().min.y < 0.02f * radius;
        if (place.position.y > grid.bounds().max.y && !flat) continue;
        if (up < clearance || grid.anythingWithin(place.position, clearance) || grid.insideSolid(place.position))
            continue;
        return place;
    }
    return std::nullopt;
}

SceneLight makeLight(const Place& place, Random& random, std::uint32_t index) {
    SceneLight light;
    light.name = "scattered " + std::to_string(index);
    light.position = place.position;
    light.colour = pleasantColour(random);
    light.sourceRadius = place.free * random.between(0.008f, 0.04f);
    const bool spot = random.unit() < 0.4f;
    const float turn = 360.0f * kDegree * random.unit(), tilt = kDegree * random.between(0.0f, 50.0f);
    const float cone = kDegree * random.between(20.0f, 60.0f);
    if (spot) {
        light.kind = LightKind::Spot;
        light.direction = glm::normalize(
            glm::vec3(std::sin(tilt) * std::cos(turn), -std::cos(tilt), std::sin(tilt) * std::sin(turn)));
        light.outerConeAngle = cone;
        light.innerConeAngle = 0.7f * cone;
    }
    return light;
}

// Mean over surface points of the number of lights within `range`.
float meanLightsPerPoint(const std::vector<SceneLight>& lights, const std::vector<glm::vec3>& points, float range) {
    double sum = 0.0;
    for (const SceneLight& light : lights) {
        const float share = light.kind == LightKind::Spot ? 0.5f * (1.0f - std::cos(light.outerConeAngle)) : 1.0f;
        for (const glm::vec3& p : points)
            sum += glm::length(p - light.position) < range ? static_cast<double>(share) : 0.0;
    }
    return static_cast<float>(sum / static_cast<double>(points.size()));
}

float commonRange(const std::vector<SceneLight>& lights, const std::vector<glm::vec3>& points, float radius) {
    float low = 0.01f * radius, high = 1.0f * radius;  // never beyond the scene's own radius
    for (int i = 0; i < 20; ++i) {
        const float middle = 0.5f * (low + high);
        (meanLightsPerPoint(lights, points, middle) < kMeanLightsPerPoint ? low : high) = middle;
    }
    return high;
}

void finish(std::vector<SceneLight>& lights, float range, Random& random) {
    for (SceneLight& light : lights) {
        light.rangeMetres = range * random.between(0.75f, 1.25f);
        const float third = light.rangeMetres / 3.0f;
        light.intensity = 8.0f * third * third * random.between(0.6f, 1.6f);
        light.sourceRadius = std::min(light.sourceRadius, 0.05f * light.rangeMetres);
    }
}

// The range at which so many shadowed lights reach a tile in the mean, `random` as finish() will get it.
float rangeForTiles(Scene& scene, const std::vector<SceneLight>& lights, const TileSamples& tiles, float wanted,
                    float radius, const Random& random) {
    const auto meanAt = [&](float range) {
        std::vector<SceneLight> tried = lights;
        Random same = random;
        finish(tried, range, same);
        return tiles.meanShadowed(scene.lights) + tiles.meanShadowed(tried);
    };
    float low = 1e-4f * radius, high = 2.0f * radius;
    for (int i = 0; i < 16; ++i) {
        const float middle = std::sqrt(low * high);
        (meanAt(middle) < wanted ? low : high) = middle;
    }
    const float reached = meanAt(high);
    if (std::abs(reached - wanted) > 0.1f * wanted)
        scene.notes.push_back("The scattered lights give about " + std::to_string(reached) +
                              " shadowed lights per tile in this picture: no range gives what was asked for.");
    return high;
}

// Without geometry the lights fill a box of two metres around the origin.
std::vector<SceneLight> lightsInEmptySpace(std::uint32_t count, Random& random) {
    std::vector<SceneLight> lights;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec3 at(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
        lights.push_back(makeLight({at, 1.0f}, random, i));
    }
    return lights;
}

}  // namespace

void scatterLights(Scene& scene, std::uint32_t count, std::uint64_t seed, const TileDensity* density) {
    if (count == 0) return;
    if (density != nullptr)
        std::erase_if(scene.lights, [](const SceneLight& light) { return light.kind != LightKind::Directional; });
    Random random(seed);
    const TriangleGrid grid(scene);
    std::vector<SceneLight> lights;
    float range = 2.0f * std::cbrt(kMeanLightsPerPoint / static_cast<float>(count));  // metres, in empty space
    if (grid.triangles().empty()) {
        lights = lightsInEmptySpace(count, random);
        scene.notes.push_back("No geometry: the scattered lights fill a box of 2 m around the origin.");
    } else {
        const SurfaceSampler all(grid, [](const glm::vec3&) { return true; });
        const SurfaceSampler upward(grid, [](const glm::vec3& n) { return n.y > 0.5f; });
        const SurfaceSampler& feet = upward.empty() ? all : upward;
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::optional<Place> place = findPlace(grid, feet, random);
            if (!place) break;
            lights.push_back(makeLight(*place, random, i));
        }
        if (lights.size() < count)
            scene.notes.push_back("Only " + std::to_string(lights.size()) + " of " + std::to_string(count) +
                                  " scattered lights found a free place.");
        std::vector<glm::vec3> points;
        for (int i = 0; i < kSurfacePoints; ++i) points.push_back(all.point(random));
        const float radius = grid.bounds().radius();
        range = commonRange(lights, points, radius);
        const TileSamples tiles = density != nullptr ? TileSamples(grid, *density) : TileSamples();
        if (!tiles.empty()) range = rangeForTiles(scene, lights, tiles, density->shadowedPerTile, radius, random);
    }
    finish(lights, range, random);
    scene.lights.insert(scene.lights.end(), lights.begin(), lights.end());
}

}  // namespace gnomon::renderer
