#pragma once
// Lights scattered over any scene. The same arguments give the same lights.

#include <cstdint>

#include "scene/scene.h"

namespace gnomon::renderer {

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
