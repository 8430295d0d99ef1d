// Ranges and source sizes for lights that come without.
//
// Problem: the inverse square never ends, but a tiled renderer wants an end. A cut-off in lux would need the scene's
// unit and exposure. Files give neither: intensities run from 1 to 109,000, and sizes from 1.8 to 250,000 units.
// Here: the rule uses ratios of the scene alone.
//
//     spacing   d = diagonal of the scene / (2 * cube root of the number of local lights)
//               how far a light is from what it lights
//     middle    I = median peak intensity of the local lights that shine
//     cut-off   E = I / d^2 / kFaintest
//               what such a light gives at that distance, lowered until nobody sees it go
//     range     r = sqrt(peak / E), at most 2 * diagonal
//
// kFaintest = 100 is 6.6 stops below what the picture is exposed for. The lighting also fades to zero towards the
// range, so there is no edge. docs/scenes.md repeats the rule for users.

#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/scene.h"

namespace gnomon::renderer {
namespace {

constexpr float kFaintest = 100.0f;
constexpr float kSunRadius = 0.00465f;                      // radians; the sun's disc is 0.53 degrees across
constexpr float kLeastRadius = 0.01f, kMostRadius = 0.25f;  // metres: a bare bulb to a large shade
constexpr float kRadiusOfSpacing = 0.01f;
constexpr float kMetricDiagonal = 1000.0f;  // beyond, the unit is hardly the metre
constexpr float kFaintLux = 0.05f;          // for one light in an empty scene, where there is nothing to compare with
constexpr float kMostRange = 1.0e18f;       // its square is still a float

float peakIntensity(const SceneLight& light) {
    return light.intensity * std::max({light.colour.r, light.colour.g, light.colour.b});
}

bool isLocal(const SceneLight& light) {
    return light.kind != LightKind::Directional;
}

}  // namespace

void completeLights(Scene& scene) {
    Bounds bounds = worldBounds(scene);
    std::vector<float> peaks;
    std::size_t localCount = 0;
    for (const SceneLight& light : scene.lights) {
        if (!isLocal(light)) continue;
        ++localCount;
        // A lamp far outside says nothing about the size of what it lights.
        if (scene.instances.empty()) bounds.add(light.position);
        if (peakIntensity(light) > 0.0f) peaks.push_back(peakIntensity(light));
    }
    const float diagonal = 2.0f * bounds.radius();
    const float spacing = diagonal / (2.0f * std::cbrt(static_cast<float>(std::max<std::size_t>(localCount, 1))));
    float middle = 1.0f;
    if (!peaks.empty()) {
        const auto median = peaks.begin() + static_cast<std::ptrdiff_t>(peaks.size() / 2);
        std::nth_element(peaks.begin(), median, peaks.end());
        middle = *median;
    }
    const bool sized = diagonal > 0.0f;
    for (SceneLight& light : scene.lights) {
        if (!isLocal(light)) {
            if (!(light.sourceRadius > 0.0f)) light.sourceRadius = kSunRadius;
            continue;
        }
        if (!(light.rangeMetres > 0.0f)) {
            // One that does not shine gets the range of a middling one, so that whoever turns it up finds it usable.
            const float peak = peakIntensity(light) > 0.0f ? peakIntensity(light) : middle;
            const float range = sized ? std::min(spacing * std::sqrt(kFaintest * (peak / middle)), 2.0f * diagonal)
                                      : std::max(std::sqrt(peak / kFaintLux), 1.0f);
            // A light outside the bounds must still reach them.
            const float away =
                bounds.empty()
                    ? 0.0f
                    : glm::length(glm::max(glm::max(bounds.min - light.position, light.position - bounds.max),
                                           glm::vec3(0.0f)));
            light.rangeMetres = std::clamp(range + away, 1.0e-6f, kMostRange);
        }
        if (!(light.sourceRadius > 0.0f)) {
            float radius = sized ? spacing * kRadiusOfSpacing : kLeastRadius;
            if (diagonal <= kMetricDiagonal) radius = std::clamp(radius, kLeastRadius, kMostRadius);
            light.sourceRadius = std::min(radius, 0.05f * light.rangeMetres);
        }
    }
}

}  // namespace gnomon::renderer
