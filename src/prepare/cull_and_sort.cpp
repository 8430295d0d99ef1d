// Cull and sort. Source: the paper, section 2.1.1 (lights sorted by their closest distance to the near plane).
//
// Problem: out of all lights of the scene, find those that can reach a visible surface. At most 1024 of them, and in an
// order that makes zBins tight.
// Plain way: test, sort by depth, cut off at 1024.
// What we do: the same, but the cut is by importance, not by depth.
// - Importance is priority * intensity * the share of the view sphere that the range subtends. A light kept last frame
//   counts a little more, so that the choice does not flicker.
// - Directional lights go first, whatever their importance: each of them lights the whole view.
// - Sort keys are 64-bit integers that end with the host's index. So equal depths (rounded to float) have one order on
//   every machine.
//
// Limits: importance knows nothing of occlusion. Hysteresis goes by host index, so a host that renumbers its lights
// loses it.

#include "prepare/cull_and_sort.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "gpu_interface/numbers.h"

namespace gnomon::prepare {
namespace {

constexpr double kDirectionalRange = 3.0e38;  // metres; what structs.h states
constexpr float kLargestCoordinate = 1e9f;    // metres; squares of it are far from a float's end
constexpr float kLargestConeAngle = 0.5f * std::numbers::pi_v<float>;  // what scene.h states
constexpr float kLargestAngularRadius = 0.5f;                          // radians; what scene.h states

Vec3 toVec3(const float* f) {
    return {f[0], f[1], f[2]};
}
gpu::vec3 toGpu(Vec3 v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
Vec3 normalized(const float* direction) {
    const Vec3 v = toVec3(direction);
    return v * (1.0 / length(v));
}

bool finite3(const float* f) {
    return std::isfinite(f[0]) && std::isfinite(f[1]) && std::isfinite(f[2]);
}
bool notNegative(float f) {
    return std::isfinite(f) && f >= 0.0f;
}
bool fadeInOrder(float start, float end) {
    return start <= end && end >= 0.0f;
}  // false for NaN; infinity is fine

const char* whatIsWrong(const Light& light) {
    const bool local = light.type != LightType::Directional;
    if (light.type != LightType::Point && light.type != LightType::Spot && local) {
        return "its type is none of LightType";
    }
    if (local && !finite3(light.position)) return "its position is not finite";
    if (local && largestCoordinate(toVec3(light.position)) > kLargestCoordinate) {
        return "its position is beyond 1e9 m; choose the frame's origin near the camera";
    }
    if (light.type != LightType::Point) {
        if (!finite3(light.direction)) return "its direction is not finite";
        if (!(length(toVec3(light.direction)) > 1e-12)) return "its direction has no length";
    }
    if (local && !notNegative(light.rangeMetres)) return "its rangeMetres must be finite and at least 0";
    if (!notNegative(light.intensity)) return "its intensity must be finite and at least 0";
    if (light.type == LightType::Spot && !(light.outerConeAngle > 0.0f && light.outerConeAngle <= kLargestConeAngle)) {
        return "its outerConeAngle must be above 0 and at most pi/2";
    }
    if (!notNegative(light.sourceRadius)) return "its sourceRadius must be finite and at least 0";
    if (!notNegative(light.biasMetres)) return "its biasMetres must be finite and at least 0";
    if (!notNegative(light.priority)) return "its priority must be finite and at least 0";
    if (local && !fadeInOrder(light.fadeStartMetres, light.fadeEndMetres)) {
        return "its fadeEndMetres must be at least fadeStartMetres and 0";
    }
    if (!fadeInOrder(light.shadowFadeStartMetres, light.shadowFadeEndMetres)) {
        return "its shadowFadeEndMetres must be at least shadowFadeStartMetres and 0";
    }
    if (static_cast<std::uint32_t>(light.filter) >= gpu::kFilterCount) return "its filter is none of Filter";
    if (light.pcssPreset >= gpu::kMaxPcssPresets) return "its pcssPreset must be below 4";
    if (!local && light.casts && light.sourceRadius > kLargestAngularRadius) {
        return "its sourceRadius, an angle as it is directional, must be at most 0.5 radians";
    }
    return nullptr;
}

double fade(double distance, float start, float end) {
    if (distance <= start) return 1.0;
    if (distance >= end) return 0.0;
    return std::isinf(end) ? 1.0 : (end - distance) / (static_cast<double>(end) - start);
}

double rangeOf(const Light& light, const PrepareDesc& desc) {
    const double range = light.rangeMetres > 0.0f
                             ? light.rangeMetres
                             : std::sqrt(static_cast<double>(light.intensity) / desc.rangeCutoffLux);
    return std::min<double>(range, kLargestCoordinate);
}

// Bits whose unsigned order is the order of the floats.
std::uint32_t orderedBits(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value + 0.0f);
    return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

// Directional lights have depth bits 0, which no finite float has.
std::uint64_t makeSortKey(std::uint32_t depthBits, std::uint32_t hostIndex) {
    return (static_cast<std::uint64_t>(depthBits) << 32) | hostIndex;
}
std::uint32_t hostIndexOf(std::uint64_t sortKey) {
    return static_cast<std::uint32_t>(sortKey);
}
bool isDirectional(std::uint64_t sortKey) {
    return (sortKey >> 32) == 0;
}

double importanceOf(const Light& light, double range, double distance) {
    const double apparent = range / std::max(distance, range);
    return static_cast<double>(light.priority) * light.intensity * apparent * apparent;
}

void fillCommon(const Light& light, std::uint32_t hostIndex, gpu::GpuLight& out) {
    out.sourceRadius = light.sourceRadius;
    out.lightMask = light.mask;
    out.hostIndex = hostIndex;
    out.biasMetres = light.biasMetres;
    out.shadowView = gpu::kNoShadowView;
    out.cosOuter = -2.0f;
}

void fillDirectional(const Light& light, const ViewCamera& camera, VisibleLight& out) {
    const Vec3 directionWs = normalized(light.direction);
    out.gpu.typeAndFlags = gpu::kLightDirectional;
    out.gpu.rangeMetres = static_cast<float>(kDirectionalRange);
    out.gpu.directionWs = toGpu(directionWs);
    out.gpu.directionVs = toGpu(camera.directionVs(directionWs));
    out.gpu.lightFade = 1.0f;
    out.casts = light.casts;
    // fade() as saturate(x * distance + y); a step, where it starts and ends at once, falls within a millimetre.
    const double start = light.shadowFadeStartMetres, end = light.shadowFadeEndMetres;
    double scale = 0.0, offset = 1.0;
    if (std::isfinite(end)) {
        scale = -1.0 / std::max(end - start, 1e-3);
        offset = -end * scale;
        out.shadowFlags = gpu::kLightShadowFadesBit;
    }
    out.shadowFadePerMetre = static_cast<float>(scale);
    out.shadowFade = static_cast<float>(offset);
    out.shadowSourceRadius = static_cast<float>(std::tan(static_cast<double>(light.sourceRadius)));
}

}  // namespace

Result validateLights(std::span<const Light> lights) noexcept {
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (const char* wrong = whatIsWrong(lights[i])) {
            return Result::failure(Status::BadArgument, "Light %zu: %s.", i, wrong);
        }
    }
    return {};
}

const char* whatIsWrong(const VisibleLight& light, const LightShadowViews& views,
                        std::uint32_t shadowViewCount) noexcept {
    const std::uint32_t type = light.gpu.typeAndFlags & gpu::kLightTypeMask;
    if (type == gpu::kLightPoint && views.count != gpu::kPointLightFaces) return "a point light has six shadow views";
    if (type == gpu::kLightSpot && views.count != 1 && views.count != gpu::kPointLightFaces) {
        return "a spot has one shadow view, or six like a point light";
    }
    if (type == gpu::kLightDirectional && (views.count < 1 || views.count > gpu::kMaxCascades)) {
        return "a directional light has 1 to 8 shadow views, one per cascade";
    }
    if (views.count > shadowViewCount || views.first > shadowViewCount - views.count) {
        return "its shadow views are out of bounds of FrameDesc::shadowViews";
    }
    return nullptr;
}

void giveShadow(const VisibleLight& light, const LightShadowViews& views, gpu::GpuLight& out) noexcept {
    out.typeAndFlags |= gpu::kLightCastsBit | light.shadowFlags |
                        static_cast<std::uint32_t>(light.filter) << gpu::kLightFilterShift |
                        std::uint32_t{light.pcssPreset} << gpu::kLightPcssPresetShift;
    if (light.directional)
        out.typeAndFlags |= views.count << gpu::kLightCascadesShift;
    else if (views.count == gpu::kPointLightFaces)
        out.typeAndFlags |= gpu::kLightSixFacesBit;
    out.shadowView = views.first;
    out.shadowFade = light.shadowFade;
    out.shadowFadePerMetre = light.shadowFadePerMetre;
    out.sourceRadius = light.shadowSourceRadius;
}

void CullAndSort::run(std::span<const Light> lights, const ViewCamera& camera, const Frustum& frustum,
                      const PrepareDesc& desc) {
    candidates_.reserve(lights.size());
    kept_.resize(std::max(kept_.size(), lights.size()), 0);
    reaches_.resize(kMaxReaches);
    visible_.resize(gpu::kMaxLightsPerView);
    candidates_.clear();
    std::uint32_t reachCount = 0;
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
        const Light& light = lights[i];
        if (light.mask == 0 || !(light.intensity > 0.0f)) continue;
        const float keep = kept_[i] != 0 ? desc.keepFactor : 1.0f;
        if (light.type == LightType::Directional) {
            candidates_.push_back({makeSortKey(0, i), light.priority * light.intensity * keep, 0});
            continue;
        }
        Reach& reach = reaches_[reachCount];
        if (!findReach(light, camera, frustum, desc, reach)) continue;
        const double importance = importanceOf(light, reach.volume.range, reach.volume.distance);
        candidates_.push_back({makeSortKey(orderedBits(static_cast<float>(reach.depth.nearest)), i),
                               static_cast<float>(importance * keep), reachCount});
        if (reachCount < kReachNotKept) ++reachCount;
    }
    choose();
    visibleCount_ = 0;
    directionalCount_ = 0;
    for (const Candidate& candidate : candidates_) {
        const Light& light = lights[hostIndexOf(candidate.sortKey)];
        const bool local = !isDirectional(candidate.sortKey);
        Reach& reach = reaches_[candidate.reach];
        if (local && candidate.reach == kReachNotKept) findReach(light, camera, frustum, desc, reach);
        VisibleLight& out = visible_[visibleCount_++];
        out = {};
        out.hostIndex = hostIndexOf(candidate.sortKey);
        out.directional = !local;
        out.filter = light.filter;
        out.pcssPreset = light.pcssPreset;
        fillCommon(light, out.hostIndex, out.gpu);
        if (local) {
            fillLocal(light, reach, out);
        } else {
            ++directionalCount_;
            fillDirectional(light, camera, out);
        }
    }
}

// False where the view does not see the light.
bool CullAndSort::findReach(const Light& light, const ViewCamera& camera, const Frustum& frustum,
                            const PrepareDesc& desc, Reach& out) {
    out.volume = ballVolume(camera, toVec3(light.position), rangeOf(light, desc));
    if (!(fade(out.volume.distance, light.fadeStartMetres, light.fadeEndMetres) > 0)) return false;
    if (!mayBeVisible(out.volume, frustum)) return false;
    if (light.type == LightType::Spot) {
        out.directionWs = normalized(light.direction);
        out.cosConeAngle = std::cos(static_cast<double>(light.outerConeAngle));
        narrowToCone(out.volume, camera, out.directionWs, out.cosConeAngle);
        if (!mayBeVisible(out.volume, frustum)) return false;
    }
    out.depth = depthRange(out.volume);
    return true;
}

// Cuts the candidates down to 1024, sorts them, and remembers them for the next frame.
void CullAndSort::choose() {
    droppedCount_ = 0;
    if (candidates_.size() > gpu::kMaxLightsPerView) {
        const auto mattersMore = [](const Candidate& a, const Candidate& b) {
            if (isDirectional(a.sortKey) != isDirectional(b.sortKey)) return isDirectional(a.sortKey);
            if (a.importance != b.importance) return a.importance > b.importance;
            return hostIndexOf(a.sortKey) < hostIndexOf(b.sortKey);
        };
        std::nth_element(candidates_.begin(), candidates_.begin() + gpu::kMaxLightsPerView, candidates_.end(),
                         mattersMore);
        droppedCount_ = static_cast<std::uint32_t>(candidates_.size() - gpu::kMaxLightsPerView);
        candidates_.erase(candidates_.begin() + gpu::kMaxLightsPerView, candidates_.end());
    }
    std::sort(candidates_.begin(), candidates_.end(),
              [](const Candidate& a, const Candidate& b) { return a.sortKey < b.sortKey; });
    std::fill(kept_.begin(), kept_.end(), std::uint8_t{0});
    for (const Candidate& candidate : candidates_) kept_[hostIndexOf(candidate.sortKey)] = 1;
}

void CullAndSort::fillLocal(const Light& light, const Reach& reach, VisibleLight& out) {
    out.volume = reach.volume;
    out.depth = reach.depth;
    gpu::GpuLight& g = out.gpu;
    g.typeAndFlags = gpu::kLightPoint;
    g.positionWs = toGpu(toVec3(light.position));
    g.rangeMetres = static_cast<float>(reach.volume.range);
    g.positionVs = toGpu(reach.volume.apexVs);
    if (reach.volume.spot) {
        g.typeAndFlags = gpu::kLightSpot;
        g.directionWs = toGpu(reach.directionWs);
        g.directionVs = toGpu(reach.volume.axisVs);
        g.cosOuter = static_cast<float>(reach.cosConeAngle);
        g.sinOuter = static_cast<float>(std::sin(static_cast<double>(light.outerConeAngle)));
    }
    const double distance = reach.volume.distance;
    g.lightFade = static_cast<float>(fade(distance, light.fadeStartMetres, light.fadeEndMetres));
    out.shadowFade = static_cast<float>(fade(distance, light.shadowFadeStartMetres, light.shadowFadeEndMetres));
    out.casts = light.casts && out.shadowFade > 0.0f;
    if (out.shadowFade < 1.0f) out.shadowFlags = gpu::kLightShadowFadesBit;
    out.shadowSourceRadius = light.sourceRadius;
}

}  // namespace gnomon::prepare
