// Ranges and source sizes for lights that come without.
//
// Problem: the inverse square never ends, but a tiled renderer wants an end. Files give neither unit nor exposure:
// intensities run from 1 to 109,000, and scenes are 4 mm to 100 km across. So no length and no illuminance may be
// assumed. Nor may a length follow from the scene's outermost vertex: a sky dome says nothing about a lamp.
// Here:
//
//     range    to the farthest corner of all that is drawn: beyond there is nothing to be lit. It culls, and the
//              lighting has no window towards it (SceneLight::rangeIsGuessed). So nothing of the light is lost, however
//              far out that corner may be.
//     source   a fortieth of the distance to the nearest surface that the light shines on. So it fits into every
//              housing, and a lamp two metres above a floor is a bulb of five centimetres.
//
// Both look at all of an animation, never at the pose that the file stores. docs/scenes.md repeats this for users.

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/nearest_surface.h"
#include "scene/pose.h"

namespace gnomon::renderer {
namespace {

constexpr float kSunRadius = 0.00465f;  // radians; the sun's disc is 0.53 degrees across
constexpr float kSourceOfNearest = 1.0f / 40.0f;
constexpr float kSourceOfRange = 1.0e-3f;    // where there is nothing that a source could show on
constexpr float kMoreThanFarthest = 1.001f;  // floats round
constexpr float kFaintLux = 0.05f;           // for one light in an empty scene, where nothing has a size
constexpr float kLeastRange = 1.0e-6f, kMostRange = 1.0e18f;  // the square of the latter is still a float

float peakIntensity(const SceneLight& light) {
    return light.intensity * std::max({light.colour.r, light.colour.g, light.colour.b});
}

bool isLocal(const SceneLight& light) {
    return light.kind != LightKind::Directional;
}

// To the farthest corner of `bounds` from anywhere in `places`.
float farthestFrom(const Bounds& places, const Bounds& bounds) {
    return glm::length(glm::max(bounds.max - places.min, places.max - bounds.min));
}

void completeRanges(Scene& scene) {
    const auto lacksRange = [](const SceneLight& light) { return isLocal(light) && !(light.rangeMetres > 0.0f); };
    const auto lacking = std::ranges::count_if(scene.lights, lacksRange);
    if (lacking == 0) return;
    const auto all = std::ranges::count_if(scene.lights, isLocal);
    const AnimatedExtent extent = animatedExtent(scene);
    Bounds bounds = extent.drawn;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        if (!scene.instances.empty() || !isLocal(scene.lights[i])) continue;
        bounds.add(extent.lights[i].min);
        bounds.add(extent.lights[i].max);
    }
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        SceneLight& light = scene.lights[i];
        if (!lacksRange(light)) continue;
        const float range = bounds.radius() > 0.0f ? kMoreThanFarthest * farthestFrom(extent.lights[i], bounds)
                                                   : std::max(std::sqrt(peakIntensity(light) / kFaintLux), 1.0f);
        light.rangeMetres = std::clamp(range, kLeastRange, kMostRange);
        light.rangeIsGuessed = true;
    }
    scene.notes.push_back(
        fmt::format("{} of {} point and spot lights state no range: they follow the inverse square "
                    "alone, and are culled beyond all that is drawn.",
                    lacking, all));
}

void completeSources(Scene& scene) {
    std::vector<bool> lacks;
    for (const SceneLight& light : scene.lights) lacks.push_back(!(light.sourceRadius > 0.0f));
    const std::vector<float> nearest = nearestSurfaces(scene, lacks);
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        SceneLight& light = scene.lights[i];
        if (!lacks[i]) continue;
        light.sourceIsGuessed = true;
        light.sourceRadius = !isLocal(light)             ? kSunRadius
                             : std::isfinite(nearest[i]) ? kSourceOfNearest * nearest[i]
                                                         : kSourceOfRange * light.rangeMetres;
    }
}

}  // namespace

void completeLights(Scene& scene) {
    completeRanges(scene);
    completeSources(scene);
}

}  // namespace gnomon::renderer
