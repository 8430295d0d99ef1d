#pragma once
// Scenes made by code: the courtyard of the README, small scenes for tests, and lights scattered over any scene.
// Everything here is deterministic: the same arguments give the same scene.

#include "scene/scene.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon::renderer {

struct BuiltinInfo {
    std::string name;
    std::string description;  // one line
};

// What `seed` and `lightCount` mean to a scene stands in its description; 0 lights: the scene's own number.
struct BuiltinOptions {
    std::uint64_t seed = 1;
    std::uint32_t lightCount = 0;  // `columns` only: how many lights stand between the columns
};

// All built-in scenes, in the order in which they are listed to people.
std::vector<BuiltinInfo> builtinScenes();

// Empty for a name that builtinScenes() does not list.
std::optional<Scene> makeBuiltinScene(std::string_view name, const BuiltinOptions& options = {});

// What scattered lights shall cost in one picture.
struct TileDensity {
    float shadowedPerTile = 3.0f;  // mean over the shadow tiles (8x8 pixels) that show geometry, directional lights too
    SceneCamera camera;
    std::uint32_t widthPx = 1280, heightPx = 720;
};

// Adds `count` shadowed lights at plausible places of any scene; the rule stands at the head of scatter_lights.cpp.
// Where a scene is so full that no free place is found, fewer are added and scene.notes says so. With `density` they
// take the place of the scene's own point and spot lights, and their ranges follow from the picture's tiles.
void scatterLights(Scene& scene, std::uint32_t count, std::uint64_t seed, const TileDensity* density = nullptr);

}  // namespace gnomon::renderer
