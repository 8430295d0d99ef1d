// Which lights are in the lists, in which order, and what is written of them.

#include <algorithm>
#include <set>

#include "unit/prepare/scenes.h"

namespace gnomon::test {
namespace {

const float kInfinity = std::numeric_limits<float>::infinity();

Light pointAt(float x, float y, float z, float range) {
    Light light;
    light.position[0] = x, light.position[1] = y, light.position[2] = z;
    light.rangeMetres = range;
    return light;
}

Light directional() {
    Light light;
    light.type = LightType::Directional;
    light.direction[0] = 0, light.direction[1] = -2, light.direction[2] = 0;
    return light;
}

Prepared runLights(const std::vector<Light>& lights) {
    return runOnce(makeCamera({}), 640, 360, lights);
}

std::vector<std::uint32_t> hostIndices(const Prepared& prepared) {
    std::vector<std::uint32_t> out;
    for (const gpu::GpuLight& light : prepared.lights) out.push_back(light.hostIndex);
    return out;
}

TEST(Lists, NoLights) {
    const Prepared p = runLights({});
    ASSERT_TRUE(p.result.ok());
    EXPECT_EQ(p.report.visible, 0u);
    EXPECT_EQ(p.frame.lightCount, 0u);
    EXPECT_TRUE(std::all_of(p.masks.begin(), p.masks.end(), [](std::uint32_t w) { return w == 0; }));
    EXPECT_TRUE(std::all_of(p.zBins.begin(), p.zBins.end(), [](std::uint32_t w) { return w == gpu::kZBinEmpty; }));
    EXPECT_TRUE(std::isfinite(p.frame.zBinsPerMetre));
}

TEST(Lists, OneLight) {
    Light light = pointAt(1, 2, -10, 3);
    light.sourceRadius = 0.25f, light.mask = 0x0F, light.biasMetres = 0.004f, light.filter = Filter::Pcf,
    light.pcssPreset = 3;
    const Prepared p = runLights({light});
    ASSERT_TRUE(p.result.ok()) << p.result.message();
    ASSERT_EQ(p.lights.size(), 1u);
    const gpu::GpuLight& g = p.lights[0];
    EXPECT_EQ(g.positionWs.x, 1.0f);
    EXPECT_NEAR(g.positionVs.x, 1, 1e-6);
    EXPECT_NEAR(g.positionVs.y, 2, 1e-6);
    EXPECT_NEAR(g.positionVs.z, 10, 1e-6);
    EXPECT_EQ(g.rangeMetres, 3.0f);
    EXPECT_EQ(g.cosOuter, -2.0f);
    EXPECT_EQ(g.sinOuter, 0.0f);
    EXPECT_EQ(g.sourceRadius, 0.25f);
    EXPECT_EQ(g.lightMask, 0x0Fu);
    EXPECT_EQ(g.biasMetres, 0.004f);
    EXPECT_EQ(g.typeAndFlags, gpu::kLightPoint | gpu::kLightCastsBit | gpu::kLightSixFacesBit |
                                  gpu::kFilterPcf << gpu::kLightFilterShift | 3u << gpu::kLightPcssPresetShift);
    EXPECT_EQ(g.shadowView, 0u);
    EXPECT_EQ(g.lightFade, 1.0f);
    EXPECT_EQ(g.shadowFade, 1.0f);
    EXPECT_EQ(p.report.casting, 1u);
    EXPECT_NEAR(p.frame.farthestReach, 13, 0.01);
    EXPECT_GE(p.frame.farthestReach, 13.0f);
    EXPECT_NEAR(p.frame.largestCoordinate, 13, 0.01);
}

TEST(Lists, OneSpot) {
    Light light = pointAt(0, 0, -10, 3);
    light.type = LightType::Spot;
    light.direction[0] = 0, light.direction[1] = 0, light.direction[2] = -4;
    light.outerConeAngle = 0.5f, light.filter = Filter::Hard;
    const Prepared p = runLights({light});
    ASSERT_TRUE(p.result.ok()) << p.result.message();
    ASSERT_EQ(p.lights.size(), 1u);
    EXPECT_EQ(p.lights[0].typeAndFlags, gpu::kLightSpot | gpu::kLightCastsBit);
    EXPECT_NEAR(p.lights[0].directionWs.z, -1, 1e-6);
    EXPECT_NEAR(p.lights[0].directionVs.z, 1, 1e-6);
    EXPECT_NEAR(p.lights[0].cosOuter, std::cos(0.5), 1e-6);
    EXPECT_NEAR(p.lights[0].sinOuter, std::sin(0.5), 1e-6);
}

TEST(Lists, OnlyDirectional) {
    std::vector<Light> lights(3, directional());
    lights[0].casts = lights[2].casts = false;
    lights[1].sourceRadius = 0.5f;
    const Prepared p = runLights(lights);
    ASSERT_TRUE(p.result.ok()) << p.result.message();
    EXPECT_EQ(hostIndices(p), (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(p.frame.lightCount, 3u);
    EXPECT_EQ(p.frame.directionalLightCount, 3u);
    EXPECT_EQ(p.report.directional, 3u);
    EXPECT_EQ(p.report.casting, 1u);
    EXPECT_EQ(p.lights[0].rangeMetres, 3.0e38f);
    EXPECT_NEAR(p.lights[0].directionWs.y, -1, 1e-6);
    EXPECT_EQ(p.lights[0].shadowView, gpu::kNoShadowView);
    EXPECT_EQ(p.lights[0].typeAndFlags, gpu::kLightDirectional);
    EXPECT_EQ(p.lights[1].shadowView, 0u);
    EXPECT_EQ(p.lights[1].typeAndFlags, gpu::kLightDirectional | gpu::kLightCastsBit |
                                            gpu::kFilterPcss << gpu::kLightFilterShift |
                                            3u << gpu::kLightCascadesShift);
    EXPECT_NEAR(p.lights[1].sourceRadius, std::tan(0.5), 1e-6);
    EXPECT_TRUE(std::all_of(p.masks.begin(), p.masks.end(), [](std::uint32_t w) { return w == 0; }));
    EXPECT_TRUE(std::all_of(p.zBins.begin(), p.zBins.end(), [](std::uint32_t w) { return w == gpu::kZBinEmpty; }));
}

TEST(Lists, DirectionalFirstThenByNearestDepthThenByHostIndex) {
    // Nearest depths 8, -, 5, 5, 2, -.
    const std::vector<Light> lights = {pointAt(0, 0, -10, 2), directional(),          pointAt(0, 0, -9, 4),
                                       pointAt(1, 0, -9, 4),  pointAt(0, 0, -20, 18), directional()};
    const Prepared p = runLights(lights);
    ASSERT_TRUE(p.result.ok()) << p.result.message();
    EXPECT_EQ(hostIndices(p), (std::vector<std::uint32_t>{1, 5, 4, 2, 3, 0}));
}

TEST(Lists, RandomLightsAreSorted) {
    for (int trial = 0; trial < 20; ++trial) {
        Random random(trial);
        const CameraSpec spec = randomCamera(random);
        std::vector<Light> lights;
        for (int i = 0; i < 300; ++i) {
            lights.push_back(i % 20 == 0 ? directional() : randomLight(random, spec));
            if (lights.back().type == LightType::Spot) lights.back().type = LightType::Point;
        }
        const Prepared p = runOnce(makeCamera(spec), 640, 360, lights);
        ASSERT_TRUE(p.result.ok()) << p.result.message();
        EXPECT_EQ(p.report.directional, 15u);
        for (std::size_t i = 1; i < p.lights.size(); ++i) {
            const gpu::GpuLight &a = p.lights[i - 1], &b = p.lights[i];
            if (i < 15) {
                EXPECT_LT(a.hostIndex, b.hostIndex);
            }
            if (i <= 15) continue;
            const double tolerance = 1e-4 * (1 + std::abs(a.positionVs.z) + a.rangeMetres + length(spec.eye) * 0.01);
            EXPECT_LE(a.positionVs.z - a.rangeMetres, b.positionVs.z - b.rangeMetres + tolerance);
        }
    }
}

TEST(Lists, WhatIsCulled) {
    std::vector<Light> lights(9, pointAt(0, 0, -10, 3));
    lights[1].mask = 0;
    lights[2].intensity = 0;
    lights[3].fadeStartMetres = 2, lights[3].fadeEndMetres = 9;
    lights[4].position[2] = 4;   // behind the camera
    lights[5].position[0] = 30;  // beside the frustum
    lights[6].rangeMetres = 0, lights[6].intensity = 0;
    lights[7].type = LightType::Spot, lights[7].position[2] = 1,
    lights[7].direction[2] = 1;  // looks away from the view
    const Prepared p = runLights(lights);
    ASSERT_TRUE(p.result.ok()) << p.result.message();
    EXPECT_EQ(hostIndices(p), (std::vector<std::uint32_t>{0, 8}));
    EXPECT_EQ(p.report.given, 9u);
    EXPECT_EQ(p.report.dropped, 0u);
}

TEST(Lists, RangeFromIntensity) {
    Light light = pointAt(0, 0, -10, 0);
    light.intensity = 8;
    PrepareDesc desc;
    desc.rangeCutoffLux = 0.5f;
    const Prepared p = runOnce(makeCamera({}), 640, 360, {light}, desc);
    ASSERT_TRUE(p.result.ok()) << p.result.message();
    EXPECT_NEAR(p.lights.at(0).rangeMetres, 4, 1e-5);
}

TEST(Lists, Fades) {
    std::vector<Light> lights(4, pointAt(0, 0, -10, 3));
    lights[0].fadeStartMetres = 8, lights[0].fadeEndMetres = 16;
    lights[1].shadowFadeStartMetres = 5, lights[1].shadowFadeEndMetres = 15;
    lights[2].shadowFadeStartMetres = 5, lights[2].shadowFadeEndMetres = 10;
    lights[3].fadeStartMetres = 8, lights[3].fadeEndMetres = kInfinity;
    const Prepared p = runLights(lights);
    ASSERT_TRUE(p.result.ok()) << p.result.message();
    ASSERT_EQ(p.lights.size(), 4u);
    EXPECT_NEAR(p.lights[0].lightFade, 0.75, 1e-6);
    EXPECT_NEAR(p.lights[1].shadowFade, 0.5, 1e-6);
    EXPECT_EQ(p.lights[2].shadowFade, 0.0f);
    EXPECT_EQ(p.lights[2].shadowView, gpu::kNoShadowView);
    EXPECT_EQ(p.lights[2].typeAndFlags & gpu::kLightCastsBit, 0u);
    EXPECT_EQ(p.lights[3].lightFade, 1.0f);
    EXPECT_EQ(p.report.casting, 3u);
}

TEST(Lists, AtCapacityAndOnePast) {
    for (const int count : {1024, 1025}) {
        std::vector<Light> lights;
        for (int i = 0; i < count; ++i) lights.push_back(pointAt(0, 0, -10 - 0.01f * static_cast<float>(i), 3));
        lights[700].intensity = 0.5f;  // matters least
        const Prepared p = runLights(lights);
        ASSERT_TRUE(p.result.ok()) << p.result.message();
        EXPECT_EQ(p.report.visible, 1024u);
        EXPECT_EQ(p.report.dropped, count == 1025 ? 1u : 0u);
        const auto hosts = hostIndices(p);
        EXPECT_EQ(std::count(hosts.begin(), hosts.end(), 700u), count == 1025 ? 0 : 1);
    }
}

TEST(Lists, DirectionalLightsAreNeverDroppedForOthers) {
    std::vector<Light> lights(1500, pointAt(0, 0, -10, 3));
    for (int i = 0; i < 40; ++i) {
        lights[static_cast<std::size_t>(i) * 30] = directional();
        lights[static_cast<std::size_t>(i) * 30].intensity = 1e-6f;
    }
    const Prepared p = runLights(lights);
    ASSERT_TRUE(p.result.ok()) << p.result.message();
    EXPECT_EQ(p.report.directional, 40u);
    EXPECT_EQ(p.report.visible, 1024u);
    EXPECT_EQ(p.report.dropped, 476u);
    const Prepared onlyDirectional = runLights(std::vector<Light>(1100, directional()));
    EXPECT_EQ(onlyDirectional.report.directional, 1024u);
    EXPECT_EQ(onlyDirectional.report.dropped, 76u);
}

// Two halves that are equally important but for a slow wobble: without hysteresis lights would swap every frame.
TEST(Lists, ChoiceDoesNotFlicker) {
    const auto changes = [](float keepFactor) {
        PrepareDesc desc;
        desc.keepFactor = keepFactor;
        const auto prepare = makePrepare(desc);
        std::vector<Light> lights(1400, pointAt(0, 0, -10, 3));
        std::set<std::uint32_t> before;
        int changed = 0;
        for (int frame = 0; frame < 6; ++frame) {
            Random random(frame);
            for (Light& light : lights) light.intensity = static_cast<float>(uniform(random, 1.0, 1.1));
            ViewInput input;
            input.camera = makeCamera({});
            input.widthPx = 640, input.heightPx = 360;
            input.lights = lights;
            const auto hosts = hostIndices(runPrepare(*prepare, input));
            const std::set<std::uint32_t> now(hosts.begin(), hosts.end());
            if (frame > 0) {
                for (const std::uint32_t host : now) changed += before.count(host) == 0 ? 1 : 0;
            }
            before = now;
        }
        return changed;
    };
    EXPECT_EQ(changes(1.2f), 0);
    EXPECT_GT(changes(1.0f), 100);
}

TEST(Lists, PriorityDecides) {
    std::vector<Light> lights(1100, pointAt(0, 0, -10, 3));
    lights[1099].priority = 2;
    const Prepared p = runLights(lights);
    const auto hosts = hostIndices(p);
    EXPECT_EQ(std::count(hosts.begin(), hosts.end(), 1099u), 1);
}

TEST(Lists, RunsAreDeterministicAndWriteEveryWord) {
    Random random(77);
    const CameraSpec spec;
    std::vector<Light> lights;
    for (int i = 0; i < 1300; ++i) lights.push_back(randomLight(random, spec));
    PrepareDesc desc;
    const auto one = makePrepare(desc), other = makePrepare(desc);
    ViewInput input;
    input.camera = makeCamera(spec);
    input.widthPx = 1000, input.heightPx = 700;
    input.lights = lights;
    const Prepared a = runPrepare(*one, input);
    const PrepareSizes sizes = prepareSizes(1000, 700);
    // Other garbage, and guards behind each destination.
    std::vector<unsigned char> frame(sizes.frameConstants + 16, 0x11), gpuLights(sizes.lights + 16, 0x11),
        zBins(sizes.zBins + 16, 0x11), masks(sizes.tileLightMasks + 16, 0x11);
    PrepareReport report;
    PreparedLights answer;
    ASSERT_TRUE(other->run(input, answer).ok());
    ASSERT_TRUE(other
                    ->write(planViews(answer.visible), kManyViews,
                            {frame.data(), gpuLights.data(), zBins.data(), masks.data()}, &report)
                    .ok());
    EXPECT_EQ(report.visible, a.report.visible);
    EXPECT_EQ(std::memcmp(frame.data(), &a.frame, sizes.frameConstants), 0);
    EXPECT_EQ(std::memcmp(gpuLights.data(), a.lights.data(), a.lights.size() * sizeof(gpu::GpuLight)), 0);
    EXPECT_EQ(std::memcmp(zBins.data(), a.zBins.data(), sizes.zBins), 0);
    EXPECT_EQ(std::memcmp(masks.data(), a.masks.data(), sizes.tileLightMasks), 0);
    for (const auto* bytes : {&frame, &gpuLights, &zBins, &masks}) {
        EXPECT_TRUE(std::all_of(bytes->end() - 16, bytes->end(), [](unsigned char c) { return c == 0x11; }));
    }
    // A second frame of the same object starts from clean scratch memory.
    const Prepared again = runPrepare(*other, input);
    EXPECT_EQ(again.masks, a.masks);
    // Group bits say exactly which words are not zero.
    for (std::size_t i = 0; i < a.masks.size(); i += 33) {
        for (std::size_t w = 0; w < 32; ++w) ASSERT_EQ((a.masks[i] >> w) & 1u, a.masks[i + 1 + w] != 0 ? 1u : 0u);
    }
}

void expectRefused(const Light& light, const std::string& words) {
    std::vector<Light> lights(5, pointAt(0, 0, -10, 3));
    lights[3] = light;
    const Prepared p = runLights(lights);
    EXPECT_EQ(p.result.status(), Status::BadArgument) << words;
    EXPECT_EQ(std::string(p.result.message()).rfind("Light 3: ", 0), 0u) << p.result.message();
    EXPECT_NE(std::string(p.result.message()).find(words), std::string::npos) << p.result.message();
}

TEST(BadLight, EachHasItsSentence) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Light point = pointAt(0, 0, -10, 3);
    Light spot = point;
    spot.type = LightType::Spot;
    const auto with = [](Light light, auto&& change) {
        change(light);
        return light;
    };
    expectRefused(with(point, [&](Light& l) { l.position[1] = nan; }), "position is not finite");
    expectRefused(with(point, [&](Light& l) { l.position[1] = 2e9f; }), "frame's origin");
    expectRefused(with(spot, [&](Light& l) { l.direction[0] = kInfinity; }), "direction is not finite");
    expectRefused(with(spot, [&](Light& l) { l.direction[2] = 0; }), "no length");
    expectRefused(with(directional(), [&](Light& l) { l.direction[1] = 0; }), "no length");
    expectRefused(with(point, [&](Light& l) { l.rangeMetres = -1; }), "rangeMetres");
    expectRefused(with(point, [&](Light& l) { l.rangeMetres = kInfinity; }), "rangeMetres");
    expectRefused(with(point, [&](Light& l) { l.intensity = nan; }), "intensity");
    expectRefused(with(spot, [&](Light& l) { l.outerConeAngle = 0; }), "outerConeAngle");
    expectRefused(with(spot, [&](Light& l) { l.outerConeAngle = 1.571f; }), "outerConeAngle");
    expectRefused(with(spot, [&](Light& l) { l.outerConeAngle = nan; }), "outerConeAngle");
    expectRefused(with(point, [&](Light& l) { l.sourceRadius = -1; }), "sourceRadius");
    expectRefused(with(point, [&](Light& l) { l.biasMetres = nan; }), "biasMetres");
    expectRefused(with(point, [&](Light& l) { l.priority = -1; }), "priority");
    expectRefused(with(point, [&](Light& l) { l.fadeEndMetres = 3; }), " fadeEndMetres");
    expectRefused(with(point, [&](Light& l) { l.fadeStartMetres = nan; }), " fadeEndMetres");
    expectRefused(with(point, [&](Light& l) { l.shadowFadeEndMetres = 3; }), "shadowFadeEndMetres");
    Light sun = directional();
    sun.sourceRadius = 0.5f;
    expectRefused(with(sun, [&](Light& l) { l.sourceRadius = 0.51f; }), "at most 0.5 radians");
    EXPECT_TRUE(runLights({sun}).result.ok());
    sun.sourceRadius = 2, sun.casts = false;  // of a sun without a shadow nobody asks
    EXPECT_TRUE(runLights({sun}).result.ok());
    expectRefused(with(point, [&](Light& l) { l.type = static_cast<LightType>(9); }), "LightType");
    expectRefused(with(point, [&](Light& l) { l.filter = static_cast<Filter>(gpu::kFilterCount); }), "Filter");
    expectRefused(with(point, [&](Light& l) { l.pcssPreset = 4; }), "pcssPreset");
}

// Point, spot and sun in view, in the order of the answer; a light that does not cast, and one that has faded.
struct Views : ::testing::Test {
    std::unique_ptr<Prepare> prepare = makePrepare({});
    std::vector<Light> lights = {pointAt(0, 0, -10, 3), pointAt(0, 0, -20, 3), directional(), pointAt(0, 0, -30, 3),
                                 pointAt(0, 0, -40, 3)};
    PreparedLights answer;
    std::vector<LightShadowViews> views;
    gpu::GpuFrame frame = {};
    std::vector<gpu::GpuLight> gpuLights;
    std::vector<std::uint32_t> zBins, masks;

    Views() {
        lights[1].type = LightType::Spot;
        lights[3].casts = false;
        lights[4].shadowFadeStartMetres = 10, lights[4].shadowFadeEndMetres = 20;
        const PrepareSizes sizes = prepareSizes(640, 360);
        gpuLights.resize(sizes.lights / sizeof(gpu::GpuLight));
        zBins.resize(sizes.zBins / 4);
        masks.resize(sizes.tileLightMasks / 4);
        EXPECT_TRUE(run().ok());
        views = planViews(answer.visible, 8);
    }
    Result run() {
        ViewInput input;
        input.camera = makeCamera({});
        input.widthPx = 640, input.heightPx = 360;
        input.lights = lights;
        return prepare->run(input, answer);
    }
    Result write(std::uint32_t count = 15, PrepareReport* report = nullptr) {
        return prepare->write(views, count, {&frame, gpuLights.data(), zBins.data(), masks.data()}, report);
    }
    void expectRefused(const std::string& words, std::uint32_t count = 15) {
        const Result result = write(count);
        EXPECT_EQ(result.status(), Status::BadArgument) << words;
        EXPECT_NE(std::string(result.message()).find(words), std::string::npos) << result.message();
    }
};

TEST_F(Views, AreGivenInTheOrderOfTheAnswer) {
    ASSERT_EQ(answer.visible.size(), 5u);
    const std::uint32_t order[] = {2, 0, 1, 3, 4};
    const bool casts[] = {true, true, true, false, false};
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(answer.visible[i].light, order[i]);
        EXPECT_EQ(answer.visible[i].casts, casts[i]) << i;
    }
    EXPECT_EQ(answer.report.casting, 3u);
    PrepareReport report;
    ASSERT_TRUE(write(15, &report).ok());
    EXPECT_EQ(report.casting, 3u);
    EXPECT_EQ(gpuLights[0].shadowView, 0u);
    EXPECT_EQ(gpuLights[1].shadowView, 8u);
    EXPECT_EQ(gpuLights[2].shadowView, 14u);
    EXPECT_EQ(gpuLights[0].typeAndFlags >> gpu::kLightCascadesShift & gpu::kLightCascadesMask, 8u);
    // None for one of them, and views for those that do not cast, which are ignored however wrong they are.
    views[1] = {};
    views[3] = views[4] = {99, 17};
    ASSERT_TRUE(write(15, &report).ok());
    EXPECT_EQ(report.casting, 2u);
    for (const std::size_t i : {1, 3, 4}) {
        EXPECT_EQ(gpuLights[i].typeAndFlags & gpu::kLightCastsBit, 0u) << i;
        EXPECT_EQ(gpuLights[i].shadowView, gpu::kNoShadowView) << i;
    }
    // No views at all: no light casts.
    views.clear();
    ASSERT_TRUE(write(0, &report).ok());
    EXPECT_EQ(report.casting, 0u);
    EXPECT_EQ(report.visible, 5u);
}

TEST_F(Views, WrongOnesHaveTheirSentences) {
    const std::vector<LightShadowViews> good = views;
    const auto refuse = [&](auto spoil, const std::string& words) {
        views = good;
        spoil(views);
        expectRefused(words);
    };
    refuse([](auto& v) { v.pop_back(); }, "4 lights were given shadow views, but 5 are visible");
    refuse([](auto& v) { v.emplace_back(); }, "6 lights");
    refuse([](auto& v) { v[0].count = 0; }, "Light 2: a directional light has 1 to 8 shadow views");
    refuse([](auto& v) { v[0].count = 9; }, "Light 2: a directional light has 1 to 8 shadow views");
    refuse([](auto& v) { v[1].count = 5; }, "Light 0: a point light has six shadow views");
    refuse([](auto& v) { v[2].count = 0; }, "Light 1: a spot has one shadow view");
    refuse([](auto& v) { v[2].count = 2; }, "Light 1: a spot has one shadow view");
    refuse([](auto& v) { v[0].first = 8; }, "Light 2: its shadow views are out of bounds");
    refuse([](auto& v) { v[1].first = 10; }, "Light 0: its shadow views are out of bounds");
    refuse([](auto& v) { v[2].first = 15; }, "Light 1: its shadow views are out of bounds");
    refuse([](auto& v) { v[2].first = 0xFFFFFFFEu; }, "Light 1: its shadow views are out of bounds");
    views = good;
    expectRefused("Light 1: its shadow views are out of bounds", 14);
    EXPECT_EQ(prepare->write(views, 15, {nullptr, gpuLights.data(), zBins.data(), masks.data()}).status(),
              Status::BadArgument);
    EXPECT_TRUE(write().ok());
    EXPECT_TRUE(write().ok());  // one answer may be written more than once
}

TEST_F(Views, NeedASuccessfulRun) {
    const Light good = lights[0];
    lights[0].intensity = -1;
    EXPECT_FALSE(run().ok());
    expectRefused("needs a successful run()");
    lights[0] = good;
    EXPECT_TRUE(run().ok());
    EXPECT_TRUE(write().ok());
    PrepareDesc smaller;
    smaller.maxWidthPx = 639;
    ASSERT_TRUE(prepare->resize(smaller).ok());
    expectRefused("needs a successful run()");
    EXPECT_FALSE(run().ok());  // above the new maximum
    smaller.maxWidthPx = 0;
    EXPECT_EQ(prepare->resize(smaller).status(), Status::BadArgument);
    ASSERT_TRUE(prepare->resize({}).ok());
    EXPECT_TRUE(run().ok());
    EXPECT_TRUE(write().ok());
    std::unique_ptr<Prepare> fresh = makePrepare({});
    EXPECT_EQ(fresh->write({}, 0, {&frame, gpuLights.data(), zBins.data(), masks.data()}).status(),
              Status::BadArgument);
}

}  // namespace
}  // namespace gnomon::test
