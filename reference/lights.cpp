// See lights.h.
#include "reference/lights.h"

#include "gpu_interface/numbers.h"

namespace gnomon::reference {
namespace {

/// 1 up to `start`, 0 from `end` on, linear between.
double fade(double distance, double start, double end) {
    if (distance <= start) return 1.0;
    if (distance >= end) return 0.0;
    return (end - distance) / (end - start);
}

bool near(double a, double b, double relative, double absolute) {
    if (a == b) return true;
    return std::abs(a - b) <= absolute + relative * std::max(std::abs(a), std::abs(b));
}

bool near(gpu::vec3 a, Vec3 b, double relative, double absolute) {
    return length(Vec3{a.x, a.y, a.z} - b) <= absolute + relative * length(b);
}

std::uint32_t typeNumber(LightType type) {
    switch (type) {
        case LightType::Point:
            return gpu::kLightPoint;
        case LightType::Spot:
            return gpu::kLightSpot;
        case LightType::Directional:
            return gpu::kLightDirectional;
    }
    return 0;
}

std::uint32_t filterNumber(Filter filter) {
    switch (filter) {
        case Filter::Hard:
            return gpu::kFilterHard;
        case Filter::Pcf:
            return gpu::kFilterPcf;
        case Filter::Pcss:
            return gpu::kFilterPcss;
        case Filter::Host:
            return gpu::kFilterHost;
        case Filter::PcssShared:
            return gpu::kFilterPcssShared;
    }
    return 0;
}

void checkShadowFadeOf(Findings& findings, std::size_t index, const LightModel& light, const gpu::GpuLight& gpuLight) {
    const bool fades = (gpuLight.typeAndFlags & gpu::kLightShadowFadesBit) != 0;
    const bool closeToCall = light.shadowFade < 1.0 && light.shadowFade > 1.0 - 1e-4;
    if (fades != light.shadowFades && !closeToCall)
        findings.add("light %zu %s told to have a fading shadow", index, fades ? "must not be" : "is not");
    if (light.type != LightType::Directional) {
        if (!near(gpuLight.shadowFade, light.shadowFade, 1e-4, 1e-4))
            findings.add("light %zu has shadow fade %g instead of %g", index, gpuLight.shadowFade, light.shadowFade);
        return;
    }
    if (!near(gpuLight.shadowFadePerMetre, light.shadowFadeScale, 1e-6, 0.0) ||
        !near(gpuLight.shadowFade, light.shadowFadeOffset, 1e-6, 0.0))
        findings.add("light %zu: shadow fade by %g d + %g instead of %g d + %g", index, gpuLight.shadowFadePerMetre,
                     gpuLight.shadowFade, light.shadowFadeScale, light.shadowFadeOffset);
}

void checkShadowOf(Findings& findings, std::size_t index, const LightModel& light, const gpu::GpuLight& gpuLight) {
    const bool casts = (gpuLight.typeAndFlags & gpu::kLightCastsBit) != 0;
    if (casts && !light.casts) findings.add("light %zu casts without a wish or without shadow views", index);
    if (!casts && light.casts && light.shadowFade > 1e-4)
        findings.add("light %zu lost its shadow at shadow fade %g", index, light.shadowFade);
    if (!casts) return;
    if (gpuLight.shadowView != light.firstShadowView)
        findings.add("light %zu has shadow view %u instead of %u", index, gpuLight.shadowView, light.firstShadowView);
    const std::uint32_t cascades = gpuLight.typeAndFlags >> gpu::kLightCascadesShift & gpu::kLightCascadesMask;
    if (cascades != light.cascadeCount)
        findings.add("light %zu has %u cascades instead of %u", index, cascades, light.cascadeCount);
    if (((gpuLight.typeAndFlags & gpu::kLightSixFacesBit) != 0) != light.sixFaces)
        findings.add("light %zu %s told to have six faces", index, light.sixFaces ? "is not" : "must not be");
    const std::uint32_t filter = gpuLight.typeAndFlags >> gpu::kLightFilterShift & gpu::kLightFilterMask;
    if (filter != filterNumber(light.filter))
        findings.add("light %zu has filter %u instead of %u", index, filter, filterNumber(light.filter));
    const std::uint32_t preset = gpuLight.typeAndFlags >> gpu::kLightPcssPresetShift & gpu::kLightPcssPresetMask;
    if (preset != light.pcssPreset)
        findings.add("light %zu has PCSS preset %u instead of %u", index, preset, light.pcssPreset);
    if (!near(gpuLight.sourceRadius, light.sourceRadius, 1e-6, 0.0))
        findings.add("light %zu has source radius %g instead of %g", index, gpuLight.sourceRadius, light.sourceRadius);
    checkShadowFadeOf(findings, index, light, gpuLight);
    if (!near(gpuLight.biasMetres, light.biasMetres, 1e-6, 0.0))
        findings.add("light %zu has bias %g instead of %g", index, gpuLight.biasMetres, light.biasMetres);
}

void checkShapeOf(Findings& findings, std::size_t index, const LightModel& light, const CameraModel& camera,
                  const gpu::GpuLight& gpuLight) {
    constexpr double kRelative = 16 * kFloatRoundoff;
    if (light.type != LightType::Point && !near(gpuLight.directionWs, light.direction, 1e-6, 0.0))
        findings.add("light %zu: direction differs from the host's", index);
    if (light.type == LightType::Directional) return;
    if (!near(gpuLight.positionWs, light.position, kRelative, 0.0))
        findings.add("light %zu: position differs from the host's", index);
    if (!near(gpuLight.rangeMetres, light.rangeMetres, kRelative, 0.0))
        findings.add("light %zu: range %g instead of %g", index, gpuLight.rangeMetres, light.rangeMetres);
    const double tolerance = kRelative * (sumOfMagnitudes(light.position) + sumOfMagnitudes(camera.eye));
    if (!near(gpuLight.positionVs.z, viewDepth(camera, light.position), 0.0, tolerance + 1e-6))
        findings.add("light %zu: view depth %g instead of %g", index, gpuLight.positionVs.z,
                     viewDepth(camera, light.position));
    if (light.type != LightType::Spot) return;
    if (!near(gpuLight.cosOuter, std::cos(light.outerAngle), kRelative, kRelative) ||
        !near(gpuLight.sinOuter, std::sin(light.outerAngle), kRelative, kRelative))
        findings.add("light %zu: cone differs from the host's", index);
}

}  // namespace

namespace {

/// fade() as a straight line cut to [0, 1]; one that is shorter than a millimetre is drawn out to that.
void fadeByPixel(const Light& light, LightModel& model) {
    const double start = light.shadowFadeStartMetres, end = light.shadowFadeEndMetres;
    if (!std::isfinite(end)) return;
    model.shadowFades = true;
    model.shadowFadeScale = -1.0 / std::max(end - start, 1e-3);
    model.shadowFadeOffset = -model.shadowFadeScale * end;
}

}  // namespace

std::vector<LightModel> makeLightModels(std::span<const Light> lights, std::span<const LightShadowViews> views,
                                        const CameraModel& camera, double rangeCutoffLux) {
    std::vector<LightModel> result;
    for (const Light& light : lights) {
        LightModel model;
        model.type = light.type;
        model.mask = light.mask;
        model.hostIndex = static_cast<std::uint32_t>(result.size());
        if (light.type != LightType::Point) model.direction = normalize(vec3(light.direction));
        const bool directional = light.type == LightType::Directional;
        model.sourceRadius = directional ? std::tan(double(light.sourceRadius)) : light.sourceRadius;
        model.wantsShadow = light.casts;
        const LightShadowViews own = result.size() < views.size() ? views[result.size()] : LightShadowViews{};
        model.casts = light.casts && own.first != kNoShadowViews;
        if (model.casts) model.firstShadowView = own.first;
        model.sixFaces = model.casts && !directional && own.count == gpu::kPointLightFaces;
        model.filter = light.filter;
        model.pcssPreset = light.pcssPreset;
        model.biasMetres = light.biasMetres;
        if (light.type == LightType::Spot) model.outerAngle = light.outerConeAngle;
        if (light.type != LightType::Directional) {
            model.position = vec3(light.position);
            // An unshadowed surface that faces the light receives intensity / distance^2 lux.
            model.rangeMetres = light.rangeMetres > 0 ? light.rangeMetres : std::sqrt(light.intensity / rangeCutoffLux);
            const double distance = length(model.position - camera.eye);
            model.lightFade = fade(distance, light.fadeStartMetres, light.fadeEndMetres);
            model.shadowFade = fade(distance, light.shadowFadeStartMetres, light.shadowFadeEndMetres);
            model.shadowFades = model.shadowFade < 1.0;
        } else if (model.casts) {
            model.cascadeCount = own.count;
            fadeByPixel(light, model);
        }
        result.push_back(model);
    }
    return result;
}

std::vector<LightModel> orderLights(const std::vector<LightModel>& all, std::span<const gpu::GpuLight> gpuLights) {
    std::vector<LightModel> result;
    for (const gpu::GpuLight& gpuLight : gpuLights) {
        LightModel model;
        model.mask = 0;
        model.rangeMetres = 0;
        if (gpuLight.hostIndex < all.size()) model = all[gpuLight.hostIndex];
        model.casts = model.casts && (gpuLight.typeAndFlags & gpu::kLightCastsBit) != 0;
        model.shadowFades = (gpuLight.typeAndFlags & gpu::kLightShadowFadesBit) != 0;
        result.push_back(model);
    }
    return result;
}

Findings checkGpuLights(const std::vector<LightModel>& all, const CameraModel& camera,
                        std::span<const gpu::GpuLight> gpuLights) {
    Findings findings;
    std::vector<bool> seen(all.size(), false);
    if (gpuLights.size() > gpu::kMaxLightsPerView) findings.add("%zu lights are too many", gpuLights.size());
    for (std::size_t i = 0; i < gpuLights.size(); ++i) {
        const gpu::GpuLight& gpuLight = gpuLights[i];
        if (gpuLight.hostIndex >= all.size()) {
            findings.add("light %zu names host light %u of %zu", i, gpuLight.hostIndex, all.size());
            continue;
        }
        if (seen[gpuLight.hostIndex]) findings.add("host light %u is in the list twice", gpuLight.hostIndex);
        seen[gpuLight.hostIndex] = true;
        const LightModel& light = all[gpuLight.hostIndex];
        if ((gpuLight.typeAndFlags & gpu::kLightTypeMask) != typeNumber(light.type))
            findings.add("light %zu has type %u instead of %u", i, gpuLight.typeAndFlags, typeNumber(light.type));
        if ((gpuLight.lightMask & 0xFFu) != light.mask)
            findings.add("light %zu has mask %x instead of %x", i, gpuLight.lightMask, light.mask);
        if (!near(gpuLight.lightFade, light.lightFade, 1e-4, 1e-4))
            findings.add("light %zu has fade %g instead of %g", i, gpuLight.lightFade, light.lightFade);
        checkShapeOf(findings, i, light, camera, gpuLight);
        checkShadowOf(findings, i, light, gpuLight);
    }
    return findings;
}

}  // namespace gnomon::reference
