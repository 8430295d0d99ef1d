#pragma once
// From the scene's lights to the library's.

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "gnomon/gnomon.h"
#include "renderer/frame/frame_settings.h"
#include "renderer/shadow_atlas/plan.h"
#include "scene/scene.h"

namespace gnomon::renderer {

/// All lights of the scene, positions relative to `origin`.
std::vector<Light> libraryLights(std::span<const SceneLight> lights, const glm::dvec3& origin,
                                 const FrameSettings& settings);

/// The settings with the filters of these lights.
ShadowSettings librarySettings(std::span<const SceneLight> lights, const FrameSettings& settings);

/// Which lights deserve shadowmaps: those that cast; where more are given than a view can have, only visible ones.
void chooseCasters(std::span<const SceneLight> lights, const PreparedLights& prepared, std::span<ShadowLight> out);

/// Per visible light its shadow views in the plan.
std::vector<LightShadowViews> lightViews(const PreparedLights& prepared, const ShadowPlan& plan);

}  // namespace gnomon::renderer
