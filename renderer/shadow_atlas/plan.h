#pragma once
// Which light gets which squares of the shadow atlas this frame: pure CPU, no Vulkan device needed.
//
// - Every casting light wishes for a resolution by its size on screen.
// - If the wishes exceed the atlas, squares are halved, first those that are largest for their importance. Nothing is
//   dropped unless even the smallest squares do not fit.
// - Squares are powers of two along a Morton curve, so they pack without loss.
// - A square whose size did not change keeps its place, so that its contents can be kept from frame to frame.

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "gnomon/scene.h"
#include "renderer/gpu/cull_volume.h"
#include "renderer/shadow_atlas/cascades.h"
#include "scene/scene.h"

namespace gnomon::renderer {

/// One light of the scene; its index in the span given to plan() identifies it from frame to frame.
struct ShadowLight {
    LightKind kind = LightKind::Point;
    glm::dvec3 position{0.0};  ///< world
    glm::vec3 direction{0.0f, -1.0f, 0.0f};
    float rangeMetres = 1.0f;
    float outerConeAngle = 0.785398163f;  ///< half-angle
    bool casts = true;
};
ShadowLight shadowLightOf(const SceneLight& light);

struct ShadowPlanSettings {
    std::uint32_t atlasSizePx = 4096;  ///< power of two
    std::uint32_t layers = 1;
    std::uint32_t guardTexels = 4;      ///< beyond 90 degrees or the cone on each side: the widest PCF kernel and one
    std::uint32_t faceGuardTexels = 0;  ///< more of them, where a light has six faces: see guardTexelsOf()
    std::uint32_t minFacePx = 32, maxFacePx = 1024;
    std::uint32_t minSpotPx = 64, maxSpotPx = 2048;
    std::uint32_t minCascadePx = 256, maxCascadePx = 2048;  ///< a quarter of the atlas' side at most
    CascadeSettings cascades;
    float texelsPerPixel = 1.0f;  ///< of the screen, where the light's range ends
};

struct ShadowPlanCamera {
    glm::dvec3 position{0.0};
    float pixelsPerRadian = 1000.0f;  ///< image height / (2 tan(vertical field of view / 2))
    bool orthographic = false;
    float pixelsPerMetre = 100.0f;  ///< orthographic only
    CullVolume frustum;             ///< optional (no planes: everything counts as visible)
    CascadeCamera cascades;
};

/// A square of one light; six for a point light or a wide spot, one per cascade for a directional light.
struct PlannedView {
    std::uint32_t light = 0, face = 0;
    std::uint32_t x = 0, y = 0, layer = 0, size = 0;
    std::uint32_t guardTexels = 0;  ///< of point lights and spots, on each side
    Cascade cascade;                ///< directional lights
    ShadowView view;                ///< clipFromWorld relative to the frame's origin
};

struct ShadowPlan {
    std::vector<PlannedView> views;
    std::vector<std::uint32_t> firstView;  ///< per light: index into views, or kNoShadowViews
    std::uint32_t cascadeCount = 0;        ///< of every directional light that has views
    std::uint32_t lightsShrunk = 0;        ///< got less than they wished for
    std::uint32_t halvings = 0;            ///< summed over those
    std::uint32_t lightsWithout = 0;       ///< cast no shadow, because not even the smallest squares fit
    bool repacked = false;                 ///< every square may have moved
    std::uint64_t wantedTexels = 0, usedTexels = 0, atlasTexels = 0;
};

/// A hundred-millionth of the range: a housing that a light has room in is never cut, at any range. Depths are then
/// range times as small, and with reversed-Z floats they lose nothing by that: a float's step is a share of its value.
float shadowNearMetres(float rangeMetres);

/// Local lights: 6 views along the axes of world space for point lights and wide spots, else 1. A spot is wide where
/// six faces need fewer texels than one view, for the same sharpness along its axis: beyond 68 degrees.
std::uint32_t shadowFaces(const ShadowLight& light);

/// How many texels on each side of a point light's or a spot's square lie beyond 90 degrees or the cone.
/// - Always settings.guardTexels, so that PCF is seamless across faces.
/// - Of six faces settings.faceGuardTexels more, but at most an eighth of the square. Taps of soft shadows then leave
///   their face less often, and leaving costs time.
/// - The square keeps its size. So 90 degrees get fewer texels: 376 in place of 504 with 64 more guard texels of 512.
std::uint32_t guardTexelsOf(const ShadowPlanSettings& settings, const ShadowLight& light, std::uint32_t sizePx);

/// The view of one square: one of shadowFaces(), of six in the order +X -X +Y -Y +Z -Z.
ShadowView makeShadowView(const ShadowLight& light, std::uint32_t face, std::uint32_t sizePx, std::uint32_t guardTexels,
                          const glm::dvec3& origin);

/// Keeps sizes and places from frame to frame, if it is let. Not thread safe.
class ShadowPlanner {
public:
    explicit ShadowPlanner(const ShadowPlanSettings& settings) : settings_(settings) {}
    /// `history`: a light keeps its resolution while that is little too fine or too coarse, and squares keep their
    /// places. Without it the plan follows from its arguments alone, and what was kept before is forgotten.
    /// `parts`: of the scene; without any, directional lights get no views.
    ShadowPlan plan(std::span<const ShadowLight> lights, const ShadowPlanCamera& camera,
                    std::span<const ScenePart> parts, const glm::dvec3& origin, bool history = true);
    [[nodiscard]] const ShadowPlanSettings& settings() const { return settings_; }
    /// ShadowPlanSettings::faceGuardTexels of the plans to come. Sizes and places stay.
    void setFaceGuardTexels(std::uint32_t texels) { settings_.faceGuardTexels = texels; }

private:
    struct Wish;
    std::vector<Wish> wishes(std::span<const ShadowLight> lights, const ShadowPlanCamera& camera, bool anything);
    Wish wishOfLocal(std::uint32_t index, const ShadowLight& light, const ShadowPlanCamera& camera);
    [[nodiscard]] Wish wishOfDirectional(std::uint32_t index) const;
    [[nodiscard]] PlannedView planView(const Wish& wish, std::uint32_t face, const ShadowLight& light,
                                       const ShadowPlanCamera& camera, const SeenRange& seen,
                                       std::span<const ScenePart> parts, const glm::dvec3& origin) const;
    void shrinkToFit(std::vector<Wish>& wishes, ShadowPlan& plan) const;
    void place(ShadowPlan& plan);

    struct Place {
        std::uint32_t x, y, layer, size;
    };
    ShadowPlanSettings settings_;
    std::unordered_map<std::uint32_t, std::uint32_t> wishedLog2_;  // per light, for the hysteresis
    std::unordered_map<std::uint64_t, Place> places_;              // per light * 8 + face
};

}  // namespace gnomon::renderer
