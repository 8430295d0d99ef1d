// Scattering lights over any scene, of any size.
//
// Place. light_places.cpp has two rules. The first one hangs lights over floors, by shares of the scene's size. Where
// it finds no place for a light, the second one takes over, for this light and all after it: it goes by the room around
// a place. Once ranges are known, it also moves the lights that shine on nothing within their range, so that each of
// them lights something. With a TileDensity these stay: ranges were chosen by what each light reaches.
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

#include "scene/scatter/scatter_lights.h"
#include "scene/random.h"
#include "scene/scatter/light_places.h"
#include "scene/scatter/scatter_lights.h"
#include "scene/scatter/tile_samples.h"
#include "scene/scatter/triangle_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gnomon::renderer {
namespace {

constexpr float kMeanLightsPerPoint = 4.5f;
constexpr int kSurfacePoints = 512;
constexpr std::uint64_t kSeedsApart = 1u << 20;  // between the seeds of lights that are moved
constexpr float kLeastRange = 1e-6f;             // radii of the bulk
constexpr float kDegree = 0.01745329252f;

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

SceneLight makeLight(const LightPlace& place, Random& random, std::uint32_t index) {
    SceneLight light;
    light.name = "scattered " + std::to_string(index);
    light.position = place.position;
    light.colour = pleasantColour(random);
    light.sourceRadius = place.freeMetres * random.between(0.008f, 0.04f);
    const bool spot = random.unit() < 0.4f;
    const float turn = 360.0f * kDegree * random.unit(), tilt = kDegree * random.between(0.0f, 50.0f);
    const float cone = kDegree * random.between(20.0f, 60.0f);
    if (spot) {
        light.kind = LightKind::Spot;
        light.direction = tilted(place.down, place.spotsLookDown ? std::min(tilt, 0.5f * cone) : tilt, turn);
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
    float low = 0.01f * radius, high = 1.0f * radius;  // never beyond the bulk's own radius
    while (low > kLeastRange * radius && meanLightsPerPoint(lights, points, low) >= kMeanLightsPerPoint) {
        high = low;
        low *= 0.01f;
    }
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
        lights.push_back(makeLight({at, 1.0f, {0, -1, 0}, false}, random, i));
    }
    return lights;
}

// Fewer than `count` where not even the second rule finds a place, with a note.
std::vector<SceneLight> lightsInPlaces(Scene& scene, const LightPlaces& places, std::uint32_t count, Random& random) {
    std::vector<SceneLight> lights;
    bool byRoom = false;
    for (std::uint32_t i = 0; i < count; ++i) {
        std::optional<LightPlace> place;
        if (!byRoom) place = places.overFloors(random);
        byRoom = !place;
        if (byRoom) place = places.byRoom(random, std::numeric_limits<float>::infinity());
        if (!place) break;
        lights.push_back(makeLight(*place, random, i));
    }
    if (lights.size() < count)
        scene.notes.push_back("Only " + std::to_string(lights.size()) + " of " + std::to_string(count) +
                              " scattered lights found a free place: everywhere else surfaces are too close together.");
    return lights;
}

// Each by numbers of its own, so that the others stay as they are.
void moveWhatShinesOnNothing(std::vector<SceneLight>& lights, const LightPlaces& places, std::uint64_t seed) {
    for (std::size_t i = 0; i < lights.size(); ++i) {
        SceneLight& light = lights[i];
        if (places.shinesOnAnything(light)) continue;
        Random own(seed * kSeedsApart + i + 1);
        const std::optional<LightPlace> place = places.byRoom(own, 0.5f * light.rangeMetres);
        if (!place) continue;
        light.position = place->position;
        light.direction = place->down;
        light.sourceRadius = std::min(light.sourceRadius, 0.04f * place->freeMetres);
    }
}

}  // namespace

void scatterLights(Scene& scene, std::uint32_t count, std::uint64_t seed, const TileDensity* density) {
    if (count == 0) return;
    if (density != nullptr)
        std::erase_if(scene.lights, [](const SceneLight& light) { return light.kind != LightKind::Directional; });
    Random random(seed);
    const TriangleGrid grid(scene);
    std::vector<SceneLight> lights;
    if (grid.triangles().empty()) {
        lights = lightsInEmptySpace(count, random);
        scene.notes.push_back("No geometry: the scattered lights fill a box of 2 m around the origin.");
        finish(lights, 2.0f * std::cbrt(kMeanLightsPerPoint / static_cast<float>(count)), random);  // metres
    } else {
        const LightPlaces places(grid);
        lights = lightsInPlaces(scene, places, count, random);
        std::vector<glm::vec3> points;
        for (int i = 0; i < kSurfacePoints; ++i) points.push_back(places.surfaces().point(random).position);
        const float radius = grid.bounds().radius();
        float range = commonRange(lights, points, radius);
        const TileSamples tiles = density != nullptr ? TileSamples(grid, *density) : TileSamples();
        if (!tiles.empty()) range = rangeForTiles(scene, lights, tiles, density->shadowedPerTile, radius, random);
        finish(lights, range, random);
        if (tiles.empty()) moveWhatShinesOnNothing(lights, places, seed);
    }
    scene.lights.insert(scene.lights.end(), lights.begin(), lights.end());
}

}  // namespace gnomon::renderer
