#pragma once
// From the scene's lights to the library's.

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "gnomon/gnomon.h"
#include "renderer/frame/frame_settings.h"
#include "renderer/shadow_atlas/plan.h"
#include "scene/scene.h"

namespace gnomon::renderer {

/// The depth bias that the file or the settings state for a light, which is taken as it is.
std::optional<float> statedBias(const SceneLight& light, const FrameSettings& settings);

/// Limits kBiasMetres, where none is stated: a share of the distance from a local light, or of half a cascade's width.
/// A thousandth does on precise rasterizers; SwiftShader has then four times as much acne in the bias lab as with 2 mm.
inline constexpr float kMostBias = 2.0e-3f;
/// The other limit, of the same. Where a triangle passes close by a light, rasterizers round its depths by shares of
/// those nearest ones: an NVIDIA H100 needs more than 2e-5. It is a twentieth of a texel in a face of 1024.
inline constexpr float kLeastBias = 1.0e-4f;

/// All lights of the scene, positions relative to `origin`.
std::vector<Light> libraryLights(std::span<const SceneLight> lights, const glm::dvec3& origin,
                                 const FrameSettings& settings);

/// The settings with the filters of these lights.
ShadowSettings librarySettings(std::span<const SceneLight> lights, const FrameSettings& settings);

/// Which lights deserve shadowmaps: those that cast; where more are given than a view can have, only visible ones.
void chooseCasters(std::span<const SceneLight> lights, const PreparedLights& prepared, std::span<ShadowLight> out);

/// Gives the views of lights for which no bias was stated their limit.
void limitBiases(std::span<const SceneLight> lights, const FrameSettings& settings, std::span<PlannedView> views);

/// Per visible light its shadow views in the plan.
std::vector<LightShadowViews> lightViews(const PreparedLights& prepared, const ShadowPlan& plan);

}  // namespace gnomon::renderer
