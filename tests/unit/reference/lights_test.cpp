// Lights from the host's descriptions, and the check of GpuLight.
#include <gtest/gtest.h>

#include "gpu_interface/numbers.h"
#include "reference/lights.h"
#include "reference/test_scene.h"
#include "reference/test_shadows.h"

namespace gnomon::reference {
namespace {

TEST(Lights, RangeAndFades) {
    CameraSetup setup;
    setup.eye = {0, 0, 0};
    setup.target = {0, 0, -1};
    const CameraModel camera = makeCameraModel(makeCamera(setup, 64, 64), 64, 64);
    Light light;
    light.position[2] = -5;
    light.intensity = 2.0f;
    light.fadeStartMetres = 4;
    light.fadeEndMetres = 8;
    light.shadowFadeStartMetres = 1;
    light.shadowFadeEndMetres = 5;
    const LightModel model = makeLightModels(std::span(&light, 1), {}, camera)[0];
    EXPECT_NEAR(model.rangeMetres, 10, 1e-5);  // 2 cd / 100 m^2 = 0.02 lux
    EXPECT_NEAR(model.lightFade, 0.75, 1e-9);
    EXPECT_EQ(model.shadowFade, 0);
    EXPECT_TRUE(model.wantsShadow);
    EXPECT_FALSE(model.casts);  // without views
    const LightShadowViews views = {6, 6};
    EXPECT_TRUE(makeLightModels(std::span(&light, 1), std::span(&views, 1), camera)[0].casts);
    light.casts = false;
    EXPECT_FALSE(makeLightModels(std::span(&light, 1), std::span(&views, 1), camera)[0].casts);
}

gpu::GpuLight toGpu(const LightModel& light, const CameraModel& camera) {
    const auto f = [](Vec3 v) { return gpu::vec3{float(v.x), float(v.y), float(v.z)}; };
    gpu::GpuLight out = {};
    out.positionWs = f(light.position);
    out.rangeMetres = light.type == LightType::Directional ? 3.0e38f : float(light.rangeMetres);
    if (light.type != LightType::Point) out.directionWs = f(light.direction);
    out.cosOuter = light.type == LightType::Spot ? float(std::cos(light.outerAngle)) : -2.0f;
    out.sinOuter = light.type == LightType::Spot ? float(std::sin(light.outerAngle)) : 0.0f;
    out.positionVs.z = float(viewDepth(camera, light.position));
    out.sourceRadius = float(light.sourceRadius);
    out.typeAndFlags = std::uint32_t(light.type) | (light.casts ? gpu::kLightCastsBit : 0u) |
                       (light.shadowFades ? gpu::kLightShadowFadesBit : 0u) |
                       (light.sixFaces ? gpu::kLightSixFacesBit : 0u) | light.cascadeCount << gpu::kLightCascadesShift |
                       std::uint32_t(light.filter) << gpu::kLightFilterShift |
                       light.pcssPreset << gpu::kLightPcssPresetShift;
    out.lightMask = light.mask;
    out.shadowView = light.firstShadowView;
    out.hostIndex = light.hostIndex;
    out.lightFade = float(light.lightFade);
    out.shadowFade = float(light.shadowFade);
    if (light.type == LightType::Directional) {
        out.positionVs = {};
        out.shadowFadePerMetre = float(light.shadowFadeScale);
        out.shadowFade = float(light.shadowFadeOffset);
    }
    out.biasMetres = float(light.biasMetres);
    return out;
}

TEST(Lights, GpuLightsAreCompared) {
    Random random(5);
    const CameraSetup setup = randomCamera(random);
    const CameraModel camera = makeCameraModel(makeCamera(setup, 64, 64), 64, 64);
    std::vector<Light> host = makeLights(random, setup, {.suns = 3, .filters = kAllBuiltInFilters, .pcssPresets = 4});
    host.back().shadowFadeStartMetres = 10;
    host.back().shadowFadeEndMetres = 15;
    const std::vector<LightModel> all = makeLightModels(host, numberViews(host), camera);
    std::vector<gpu::GpuLight> gpuLights;
    for (std::size_t i = all.size(); i-- > 0;) gpuLights.push_back(toGpu(all[i], camera));
    EXPECT_TRUE(checkGpuLights(all, camera, gpuLights).ok()) << checkGpuLights(all, camera, gpuLights).text();
    const std::vector<LightModel> ordered = orderLights(all, gpuLights);
    EXPECT_EQ(ordered.front().hostIndex, all.back().hostIndex);

    const auto errorsAfter = [&](auto change, std::uint32_t type = gpu::kLightSpot) {
        std::vector<gpu::GpuLight> spoilt = gpuLights;
        for (gpu::GpuLight& light : spoilt)
            if ((light.typeAndFlags & gpu::kLightTypeMask) == type && (light.typeAndFlags & gpu::kLightCastsBit) != 0 &&
                light.shadowFade > 0.1f) {
                change(light);
                break;
            }
        return checkGpuLights(all, camera, spoilt).errors;
    };
    EXPECT_EQ(errorsAfter([](gpu::GpuLight&) {}), 0u);
    EXPECT_EQ(errorsAfter([](gpu::GpuLight& l) { l.rangeMetres *= 1.0001f; }), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuLight& l) { l.positionWs.x += 0.01f; }), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuLight& l) { l.directionWs.x += 0.01f; }), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuLight& l) { l.cosOuter += 0.001f; }), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuLight& l) { l.typeAndFlags &= ~gpu::kLightCastsBit; }), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuLight& l) { l.lightMask ^= 1; }), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuLight& l) { l.biasMetres *= 2; }), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuLight& l) { l.hostIndex = 5000; }), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuLight& l) { l.sourceRadius += 0.001f; }), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuLight& l) { l.typeAndFlags ^= gpu::kLightShadowFadesBit; }), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuLight& l) { l.typeAndFlags ^= 1u << gpu::kLightFilterShift; }), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuLight& l) { l.typeAndFlags ^= 2u << gpu::kLightPcssPresetShift; }), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuLight& l) { ++l.shadowView; }), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuLight& l) { l.typeAndFlags ^= gpu::kLightSixFacesBit; }), 1u);
    constexpr std::uint32_t kSun = gpu::kLightDirectional;
    EXPECT_EQ(errorsAfter([](gpu::GpuLight& l) { l.sourceRadius *= 1.001f; }, kSun), 1u);  // the angle, not its tangent
    EXPECT_EQ(errorsAfter([](gpu::GpuLight& l) { l.typeAndFlags ^= 7u << gpu::kLightCascadesShift; }, kSun), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuLight& l) { l.typeAndFlags ^= gpu::kLightShadowFadesBit; }, kSun), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuLight& l) { l.shadowFadePerMetre += 0.1f; }, kSun), 1u);
    gpuLights[0] = gpuLights[1];
    EXPECT_EQ(checkGpuLights(all, camera, gpuLights).errors, 1u);
}

}  // namespace
}  // namespace gnomon::reference
