#include "renderer/frame/lights.h"

#include <algorithm>
#include <cstring>
#include <numbers>

#include "gpu_interface/numbers.h"

namespace gnomon::renderer {
namespace {

LightType typeOf(LightKind kind) {
    switch (kind) {
        case LightKind::Point:
            return LightType::Point;
        case LightKind::Spot:
            return LightType::Spot;
        case LightKind::Directional:
            return LightType::Directional;
    }
    return LightType::Point;
}

Filter filterOf(const SceneLight& light, std::size_t index, const FrameSettings& settings) {
    return light.filter ? *light.filter : settings.filters[index % settings.filters.size()];
}

/// From `first` on, those of one light.
std::uint32_t viewsFrom(std::uint32_t first, const ShadowPlan& plan) {
    std::uint32_t count = 1;
    while (first + count < plan.views.size() && plan.views[first + count].light == plan.views[first].light) ++count;
    return count;
}

}  // namespace

std::optional<float> statedBias(const SceneLight& light, const FrameSettings& settings) {
    return light.biasMetres >= 0.0f ? light.biasMetres : settings.biasMetres;
}

std::vector<Light> libraryLights(std::span<const SceneLight> lights, const glm::dvec3& origin,
                                 const FrameSettings& settings) {
    std::vector<Light> out;
    out.reserve(lights.size());
    std::uint32_t soft = 0;  // lights with soft shadows so far: presets take turns among them alone
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const SceneLight& light = lights[i];
        Light l;
        l.type = typeOf(light.kind);
        const glm::vec3 position(glm::dvec3(light.position) - origin);
        std::memcpy(l.position, &position, sizeof(l.position));
        std::memcpy(l.direction, &light.direction, sizeof(l.direction));
        l.rangeMetres = light.rangeMetres;
        l.intensity = light.intensity * std::max({light.colour.x, light.colour.y, light.colour.z});
        l.outerConeAngle = std::min(light.outerConeAngle, 0.5f * std::numbers::pi_v<float>);
        l.sourceRadius = light.sourceRadius;
        l.biasMetres = statedBias(light, settings).value_or(kBiasMetres);
        l.casts = light.casts;
        l.filter = filterOf(light, i, settings);
        if (isSoft(l.filter)) l.pcssPreset = static_cast<std::uint8_t>(soft++ % settings.shadows.pcssPresetCount);
        out.push_back(l);
    }
    return out;
}

ShadowSettings librarySettings(std::span<const SceneLight> lights, const FrameSettings& settings) {
    ShadowSettings out = settings.shadows;
    out.filters = 0;
    for (const Filter filter : settings.filters) out.filters |= only(filter);
    for (const SceneLight& light : lights)
        if (light.filter) out.filters |= only(*light.filter);
    // Without PCSS nothing asks the bounds.
    out.shadowBounds = out.shadowBounds && (out.filters & (only(Filter::Pcss) | only(Filter::PcssShared))) != 0;
    out.subsurfaceBiasMetres = settings.drawing.subsurfaceFronts ? settings.subsurfaceBiasMetres : 0.0f;
    return out;
}

void chooseCasters(std::span<const SceneLight> lights, const PreparedLights& prepared, std::span<ShadowLight> out) {
    const bool all = lights.size() <= gpu::kMaxLightsPerView;
    for (std::size_t i = 0; i < lights.size(); ++i) out[i].casts = all && lights[i].casts;
    if (all) return;
    for (const LightOnScreen& light : prepared.visible) out[light.light].casts = lights[light.light].casts;
}

void limitBiases(std::span<const SceneLight> lights, const FrameSettings& settings, std::span<PlannedView> views) {
    for (PlannedView& planned : views) {
        const SceneLight& light = lights[planned.light];
        if (statedBias(light, settings)) continue;
        const bool local = light.kind != LightKind::Directional;
        const float reach = local ? 1.0f : static_cast<float>(planned.cascade.halfExtent);
        planned.view.mostBias = kMostBias * reach;
        planned.view.leastBias = kLeastBias * reach;
    }
}

std::vector<LightShadowViews> lightViews(const PreparedLights& prepared, const ShadowPlan& plan) {
    std::vector<LightShadowViews> out;
    out.reserve(prepared.visible.size());
    for (const LightOnScreen& light : prepared.visible) {
        const std::uint32_t first = plan.firstView[light.light];
        out.push_back(first == kNoShadowViews ? LightShadowViews{} : LightShadowViews{first, viewsFrom(first, plan)});
    }
    return out;
}

}  // namespace gnomon::renderer
