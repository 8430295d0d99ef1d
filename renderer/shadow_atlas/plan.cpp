#include "renderer/shadow_atlas/plan.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <queue>

#include "gpu_interface/numbers.h"
#include "renderer/shadow_atlas/pack.h"

namespace gnomon::renderer {

namespace {

// A wish changes its power of two only when it is this far (in log2) from the one it has.
constexpr float kHysteresisLog2 = 0.75f;
// What is outside of the camera's frustum counts this much less when squares are shrunk.
constexpr float kUnseenImportance = 0.125f;
// A directional light is everywhere on the screen; shrunk only after everything else.
constexpr float kCascadeImportance = 1e5f;

struct Sphere {
    glm::dvec3 centre;
    float radius;
};

// The sphere around what the light reaches: for a spot, around its cone with its round cap.
Sphere reachOf(const ShadowLight& light) {
    const float c = std::cos(light.outerConeAngle);
    if (light.kind != LightKind::Spot || c < 0.5f) return {light.position, light.rangeMetres};
    const float radius = light.rangeMetres / (2.0f * c);
    return {light.position + glm::dvec3(light.direction) * static_cast<double>(radius), radius};
}

}  // namespace

ShadowLight shadowLightOf(const SceneLight& light) {
    ShadowLight out;
    out.kind = light.kind;
    out.position = glm::dvec3(light.position);
    out.direction = glm::normalize(light.direction);
    out.rangeMetres = light.kind == LightKind::Directional ? 1e30f : light.rangeMetres;  // reaches everything
    out.outerConeAngle = light.outerConeAngle;
    out.casts = light.casts;
    return out;
}

float shadowNearMetres(float rangeMetres) {
    return 1e-8f * rangeMetres;
}

std::uint32_t shadowFaces(const ShadowLight& light) {
    if (light.kind == LightKind::Point) return gpu::kPointLightFaces;
    // One view of half-width tan(angle) has the texels of six faces, each of half-width 1, where tan^2 is 6.
    constexpr float kLargestTangent = 2.44948974f;
    return light.outerConeAngle > std::atan(kLargestTangent) ? gpu::kPointLightFaces : 1;
}

std::uint32_t guardTexelsOf(const ShadowPlanSettings& settings, const ShadowLight& light, std::uint32_t sizePx) {
    const bool faces = shadowFaces(light) > 1;
    return settings.guardTexels + (faces ? std::min(settings.faceGuardTexels, sizePx / 8) : 0);
}

ShadowView makeShadowView(const ShadowLight& light, std::uint32_t face, std::uint32_t sizePx, std::uint32_t guardTexels,
                          const glm::dvec3& origin) {
    static constexpr glm::vec3 kForward[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    const bool faces = shadowFaces(light) > 1;
    const glm::vec3 forward = faces ? kForward[face] : light.direction;
    const glm::vec3 helper = std::abs(forward.y) > 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
    const glm::vec3 right = glm::normalize(glm::cross(forward, helper));
    const glm::vec3 up = glm::cross(right, forward);
    const float guarded = static_cast<float>(sizePx) / static_cast<float>(sizePx - 2 * guardTexels);
    const float scale = 1.0f / ((faces ? 1.0f : std::tan(light.outerConeAngle)) * guarded);
    const float nearZ = shadowNearMetres(light.rangeMetres), farZ = light.rangeMetres;
    // Reversed Z: 1 at near, 0 at far, device depth = a + b / linear depth.
    const float a = -nearZ / (farZ - nearZ), b = nearZ * farZ / (farZ - nearZ);
    const glm::vec3 rows[4] = {right * scale, -up * scale, forward * a, forward};
    const glm::vec3 position(light.position - origin);
    ShadowView view;
    for (int r = 0; r < 4; ++r) {
        for (int c = 0; c < 3; ++c) view.clipFromWorld[c * 4 + r] = rows[r][c];
        view.clipFromWorld[12 + r] = -glm::dot(rows[r], position) + (r == 2 ? b : 0.0f);
    }
    view.widthPx = view.heightPx = sizePx;
    view.nearMetres = nearZ;
    view.farMetres = farZ;
    return view;
}

struct ShadowPlanner::Wish {
    std::uint32_t light, faces;
    std::uint32_t wanted, size, smallest;
    float importance;
};

ShadowPlanner::Wish ShadowPlanner::wishOfLocal(std::uint32_t index, const ShadowLight& light,
                                               const ShadowPlanCamera& camera) {
    const Sphere reach = reachOf(light);
    const auto distance = static_cast<float>(glm::length(reach.centre - camera.position));
    float diameterPx = 2.0f * reach.radius * camera.pixelsPerMetre;
    if (!camera.orthographic) {
        // Inside the sphere it fills the view; the nearest point of interest is taken no nearer than half a radius.
        diameterPx = 2.0f * reach.radius * camera.pixelsPerRadian / std::max(distance, 0.5f * reach.radius);
    }
    const std::uint32_t faces = shadowFaces(light);
    const std::uint32_t low = faces > 1 ? settings_.minFacePx : settings_.minSpotPx;
    const std::uint32_t high = std::min(faces > 1 ? settings_.maxFacePx : settings_.maxSpotPx, settings_.atlasSizePx);
    const float wishLog2 =
        std::log2(std::clamp(diameterPx * settings_.texelsPerPixel, static_cast<float>(low), static_cast<float>(high)));
    auto [known, isNew] = wishedLog2_.try_emplace(index, static_cast<std::uint32_t>(std::lround(wishLog2)));
    if (std::abs(wishLog2 - static_cast<float>(known->second)) > kHysteresisLog2) {
        known->second = static_cast<std::uint32_t>(std::lround(wishLog2));
    }
    const std::uint32_t size = std::clamp(1u << known->second, low, high);
    const bool seen = camera.frustum.planeCount == 0 || camera.frustum.mayHold(reach.centre, reach.radius);
    return {index, faces, size, size, low, diameterPx * (seen ? 1.0f : kUnseenImportance)};
}

ShadowPlanner::Wish ShadowPlanner::wishOfDirectional(std::uint32_t index) const {
    const std::uint32_t high = std::max(std::min(settings_.maxCascadePx, settings_.atlasSizePx / 4), 1u);
    return {index, settings_.cascades.count, high, high, std::min(settings_.minCascadePx, high), kCascadeImportance};
}

std::vector<ShadowPlanner::Wish> ShadowPlanner::wishes(std::span<const ShadowLight> lights,
                                                       const ShadowPlanCamera& camera, bool anything) {
    std::vector<Wish> out;
    for (std::uint32_t l = 0; l < lights.size(); ++l) {
        const ShadowLight& light = lights[l];
        if (!light.casts) continue;
        if (light.kind == LightKind::Directional) {
            if (anything) out.push_back(wishOfDirectional(l));
            continue;
        }
        const bool usable = light.rangeMetres > 0.0f && std::isfinite(light.rangeMetres) && light.outerConeAngle > 0.0f;
        if (usable) out.push_back(wishOfLocal(l, light, camera));
    }
    return out;
}

void ShadowPlanner::shrinkToFit(std::vector<Wish>& wishes, ShadowPlan& plan) const {
    auto texels = [](const Wish& w) { return std::uint64_t{w.size} * w.size * w.faces; };
    std::uint64_t sum = 0;
    for (const Wish& w : wishes) sum += texels(w);
    plan.wantedTexels = sum;
    // The heaviest for its importance first; ties by the light's index, so that plans are reproducible.
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry> heap;
    auto weight = [&](const Wish& w) {
        return static_cast<double>(texels(w)) / std::max(1e-3, static_cast<double>(w.importance) * w.importance);
    };
    for (std::uint32_t i = 0; i < wishes.size(); ++i) {
        if (wishes[i].size > wishes[i].smallest) heap.emplace(weight(wishes[i]), i);
    }
    while (sum > plan.atlasTexels && !heap.empty()) {
        const std::uint32_t i = heap.top().second;
        heap.pop();
        sum -= texels(wishes[i]);
        wishes[i].size /= 2;
        sum += texels(wishes[i]);
        ++plan.halvings;
        if (wishes[i].size > wishes[i].smallest) heap.emplace(weight(wishes[i]), i);
    }
    if (sum > plan.atlasTexels) {
        std::stable_sort(wishes.begin(), wishes.end(),
                         [](const Wish& a, const Wish& b) { return a.importance > b.importance; });
        while (sum > plan.atlasTexels) {
            sum -= texels(wishes.back());
            wishes.pop_back();
            ++plan.lightsWithout;
        }
        std::sort(wishes.begin(), wishes.end(), [](const Wish& a, const Wish& b) { return a.light < b.light; });
    }
    for (const Wish& w : wishes) plan.lightsShrunk += w.size < w.wanted ? 1u : 0u;
    plan.usedTexels = sum;
}

void ShadowPlanner::place(ShadowPlan& plan) {
    const std::uint32_t cell =
        std::min({settings_.minFacePx, settings_.minSpotPx, settings_.minCascadePx, settings_.atlasSizePx / 4});
    const std::uint32_t side = settings_.atlasSizePx / cell, cellsPerLayer = side * side;
    std::vector<std::uint32_t> order(plan.views.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return plan.views[a].size > plan.views[b].size; });

    auto attempt = [&](bool keep) {
        MortonSpace space(side, settings_.layers);
        std::unordered_map<std::uint64_t, Place> places;
        auto keyOf = [](const PlannedView& v) { return std::uint64_t{v.light} * 8 + v.face; };
        for (const PlannedView& v : plan.views) {
            const auto old = places_.find(keyOf(v));
            if (!keep || old == places_.end() || old->second.size != v.size) continue;
            const Place& p = old->second;
            space.reserve(p.layer * cellsPerLayer + MortonSpace::cellOf(p.x / cell, p.y / cell), v.size / cell);
            places.emplace(keyOf(v), p);
        }
        for (const std::uint32_t i : order) {
            const PlannedView& v = plan.views[i];
            if (places.contains(keyOf(v))) continue;
            std::uint32_t first = 0;
            if (!space.take(v.size / cell, first)) return false;
            Place p{0, 0, first / cellsPerLayer, v.size};
            MortonSpace::placeOf(first % cellsPerLayer, p.x, p.y);
            p.x *= cell, p.y *= cell;
            places.emplace(keyOf(v), p);
        }
        places_ = std::move(places);
        for (PlannedView& v : plan.views) {
            const Place& p = places_.at(keyOf(v));
            v.x = p.x, v.y = p.y, v.layer = p.layer;
        }
        return true;
    };
    if (attempt(true)) return;
    plan.repacked = true;
    attempt(false);  // sorted by size without gaps: fits whenever the sum of areas does
}

PlannedView ShadowPlanner::planView(const Wish& wish, std::uint32_t face, const ShadowLight& light,
                                    const ShadowPlanCamera& camera, const SeenRange& seen,
                                    std::span<const ScenePart> parts, const glm::dvec3& origin) const {
    PlannedView planned;
    planned.light = wish.light;
    planned.face = face;
    planned.size = wish.size;
    if (light.kind == LightKind::Directional) {
        planned.cascade =
            cascadeAround(settings_.cascades, camera.cascades, seen, parts, light.direction, face, wish.size);
        planned.view = cascadeView(planned.cascade, light.direction, wish.size, origin);
    } else {
        planned.guardTexels = guardTexelsOf(settings_, light, wish.size);
        planned.view = makeShadowView(light, face, wish.size, planned.guardTexels, origin);
    }
    return planned;
}

ShadowPlan ShadowPlanner::plan(std::span<const ShadowLight> lights, const ShadowPlanCamera& camera,
                               std::span<const ScenePart> parts, const glm::dvec3& origin, bool history) {
    if (!history) {
        wishedLog2_.clear();
        places_.clear();
    }
    ShadowPlan plan;
    plan.atlasTexels = std::uint64_t{settings_.atlasSizePx} * settings_.atlasSizePx * settings_.layers;
    std::vector<Wish> granted = wishes(lights, camera, !parts.empty());
    shrinkToFit(granted, plan);
    plan.firstView.assign(lights.size(), kNoShadowViews);
    plan.cascadeCount = settings_.cascades.count;
    for (const Wish& wish : granted) {
        const ShadowLight& light = lights[wish.light];
        SeenRange seen;
        if (light.kind == LightKind::Directional)
            seen = seenRangeOf(camera.cascades, camera.frustum, parts, light.direction);
        plan.firstView[wish.light] = static_cast<std::uint32_t>(plan.views.size());
        for (std::uint32_t f = 0; f < wish.faces; ++f)
            plan.views.push_back(planView(wish, f, light, camera, seen, parts, origin));
    }
    place(plan);
    for (PlannedView& v : plan.views) {
        v.view.layer = v.layer;
        v.view.xPx = v.x;
        v.view.yPx = v.y;
    }
    return plan;
}

}  // namespace gnomon::renderer
