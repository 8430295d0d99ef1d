// The library's phase 1 against the oracle, for every kind of camera, over random and awkward views: no light that
// meets a piece of the view may be missing there, and little else should be marked. Its answer, by which hosts plan
// their shadow views, says of each light what the oracle says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "gnomon/prepare.h"
#include "gpu_interface/packing.h"
#include "reference/on_screen.h"
#include "reference/prepare.h"
#include "reference/test_scene.h"
#include "reference/test_shadows.h"

namespace gnomon::reference {
namespace {

struct Extent {
    std::uint32_t widthPx, heightPx;
};

/// The library's phase 1: its answer, and what it writes for views of the lights that want them.
struct Prepared {
    std::unique_ptr<Prepare> prepare;
    PreparedLights answer;
    std::vector<LightShadowViews> hostViews;  // by host light
    PrepareReport written;
    gpu::GpuFrame frame = {};
    std::vector<gpu::GpuLight> lights;
    std::vector<std::uint32_t> bins, masks;
    bool ok = false;

    Prepared(const ViewInput& input) {
        EXPECT_TRUE(Prepare::create({}, prepare).ok());
        const Result result = prepare->run(input, answer);
        EXPECT_TRUE(result.ok()) << result.message();
        if (result.ok()) write(input);
    }

private:
    void write(const ViewInput& input) {
        hostViews = numberViews(input.lights);
        std::vector<LightShadowViews> views;
        for (const LightOnScreen& light : answer.visible) views.push_back(hostViews[light.light]);
        const PrepareSizes sizes = prepareSizes(input.widthPx, input.heightPx);
        const auto words = [](std::size_t bytes) { return std::vector<gpu::vec4>((bytes + 15) / 16); };
        auto frameWords = words(sizes.frameConstants), lightWords = words(sizes.lights), binWords = words(sizes.zBins),
             maskWords = words(sizes.tileLightMasks);
        const Result result = prepare->write(
            views, 10000, {frameWords.data(), lightWords.data(), binWords.data(), maskWords.data()}, &written);
        EXPECT_TRUE(result.ok()) << result.message();
        ok = result.ok();
        std::memcpy(&frame, frameWords.data(), sizeof(frame));
        lights.resize(frame.lightCount);
        std::memcpy(static_cast<void*>(lights.data()), lightWords.data(), lights.size() * sizeof(gpu::GpuLight));
        bins.resize(gpu::kZBinWords);
        masks.resize(sizes.tileLightMasks / 4);
        std::memcpy(bins.data(), binWords.data(), bins.size() * 4);
        std::memcpy(masks.data(), maskWords.data(), masks.size() * 4);
    }
};

ViewInput inputOf(const CameraSetup& setup, Extent extent, const std::vector<Light>& host) {
    ViewInput input;
    input.camera = makeCamera(setup, extent.widthPx, extent.heightPx);
    input.widthPx = extent.widthPx;
    input.heightPx = extent.heightPx;
    input.lights = host;
    return input;
}

void expectNone(const Findings& findings, const char* what) {
    EXPECT_TRUE(findings.ok()) << what << ": " << findings.text();
}

/// Which lights, in which order, and what is said of each.
void checkAnswer(const std::vector<LightModel>& all, const CameraModel& camera, const Prepared& p) {
    const std::vector<LightModel> lights = orderLights(all, p.answer.visible);
    const VisibleReport visible = checkVisibleLights(all, lights, camera);
    expectNone(visible.findings, "answer");
    expectNone(checkReport(all.size(), visible.must, p.answer), "report");
    expectNone(checkOnScreen(lights, camera, p.answer.visible, p.masks, p.frame.maskTileColumns, p.frame.maskTileRows),
               "on screen");
    ASSERT_EQ(p.lights.size(), p.answer.visible.size());
    std::size_t casting = 0;
    for (std::size_t i = 0; i < p.lights.size(); ++i) {
        EXPECT_EQ(p.lights[i].hostIndex, p.answer.visible[i].light) << "the lists have another order than the answer";
        const bool views = p.hostViews[p.answer.visible[i].light].first != kNoShadowViews;
        const bool casts = (p.lights[i].typeAndFlags & gpu::kLightCastsBit) != 0;
        EXPECT_EQ(casts, views && p.answer.visible[i].casts);
        casting += casts;
    }
    EXPECT_EQ(p.written.casting, casting);
}

/// Runs the library's phase 1 and checks all of its outputs. Returns the (marked, surplus) pairs of the tile light
/// masks.
CoverReport checkOneView(const CameraSetup& setup, Extent extent, const std::vector<Light>& host) {
    const ViewInput input = inputOf(setup, extent, host);
    const Prepared p(input);
    if (!p.ok) return {};
    const CameraModel camera = makeCameraModel(input.camera, extent.widthPx, extent.heightPx);
    const std::vector<LightModel> all = makeLightModels(host, p.hostViews, camera);
    checkAnswer(all, camera, p);
    expectNone(checkGpuLights(all, camera, p.lights), "lights");
    const std::vector<LightModel> lights = orderLights(all, p.lights);
    expectNone(checkVisibleLights(all, lights, camera).findings, "lists");
    expectNone(checkZBins(lights, camera, p.bins, p.frame.zBinNearDepth, p.frame.zBinsPerMetre).findings, "zBins");
    CoverReport tiles = checkTileLightMasks(lights, camera, p.masks, p.frame.maskTileColumns, p.frame.maskTileRows);
    expectNone(tiles.findings, "tile light masks");
    return tiles;
}

/// A crowd with everything in it that phase 1 tells of.
LightSetup mixedLights(std::uint32_t count) {
    LightSetup lights;
    lights.count = count;
    lights.suns = 2;
    lights.filters = kAllBuiltInFilters;
    lights.pcssPresets = 3;
    return lights;
}

TEST(Phase1, EveryKindOfCamera) {
    std::size_t marked = 0, surplus = 0;
    for (const CameraSetup& setup : allCameraKinds()) {
        SCOPED_TRACE(setup.name);
        Random random(20);
        const CoverReport tiles = checkOneView(setup, {250, 130}, makeLights(random, setup, mixedLights(50)));
        marked += tiles.marked;
        surplus += tiles.surplus;
    }
    EXPECT_GT(marked, 200u);
    EXPECT_LT(surplus, marked / 3);
    RecordProperty("surplusPercent", static_cast<int>(100 * surplus / marked));
}

TEST(Phase1, RandomViews) {
    std::size_t marked = 0, surplus = 0;
    for (std::uint64_t seed = 100; seed < 140; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const CameraSetup setup = randomCamera(random);
        LightSetup lights = mixedLights(5 + random.below(60));
        lights.spotShare = random.uniform();
        lights.spreadMetres = random.uniform(1, 20);
        lights.maxOuterAngle = random.uniform(0.1, 1.54);
        const Extent extent = {1 + random.below(200), 1 + random.below(150)};
        const CoverReport tiles = checkOneView(setup, extent, makeLights(random, setup, lights));
        marked += tiles.marked;
        surplus += tiles.surplus;
    }
    EXPECT_LT(surplus, marked / 3);
    RecordProperty("surplusPercent", static_cast<int>(100 * surplus / marked));
}

// The ball around a light's reach holds points strewn in it, and no smaller one about the same line does.
TEST(Phase1, ReachIsTheSmallestBall) {
    Random random(30);
    for (const double angle : {0.02, 0.3, 0.8, 1.04, 1.06, 1.4}) {
        LightModel light;
        light.type = LightType::Spot;
        light.direction = random.unitVector();
        light.position = random.inBox({-3, -3, -3}, {3, 3, 3});
        light.rangeMetres = 2;
        light.outerAngle = angle;
        const Ball ball = reachOf(light);
        const Vec3 helper = std::abs(light.direction.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
        const Vec3 across = normalize(cross(light.direction, helper)), other = cross(light.direction, across);
        double farthest = 0;
        for (int i = 0; i < 4000; ++i) {
            const double a = i % 2 == 0 ? angle : random.uniform(0, angle), turn = random.uniform(0, 2 * kPi);
            const Vec3 aside = across * std::cos(turn) + other * std::sin(turn);
            const Vec3 p = light.position + (light.direction * std::cos(a) + aside * std::sin(a)) * light.rangeMetres;
            farthest = std::max(farthest, length(p - ball.centre));
        }
        EXPECT_LE(farthest, ball.radius * (1 + 1e-9)) << angle;
        EXPECT_GE(farthest, ball.radius * (1 - 1e-9)) << angle;
        EXPECT_LE(length(light.position - ball.centre), ball.radius * (1 + 1e-9)) << angle;
    }
}

/// An answer with something changed in the first entry that `which` likes.
template <typename Which, typename Change>
std::size_t errorsAfter(const std::vector<LightModel>& all, const CameraModel& camera, const Prepared& p, Which which,
                        Change change) {
    std::vector<LightOnScreen> entries(p.answer.visible.begin(), p.answer.visible.end());
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (!which(entries[i])) continue;
        change(entries[i]);
        const std::vector<LightModel> lights = orderLights(all, p.answer.visible);
        return checkOnScreen(lights, camera, entries, p.masks, p.frame.maskTileColumns, p.frame.maskTileRows).errors;
    }
    ADD_FAILURE() << "no such light";
    return 0;
}

TEST(Phase1, WrongValuesOnScreenAreFound) {
    Random random(31);
    const CameraSetup setup;
    LightSetup crowd = mixedLights(80);
    crowd.fadingShare = 0;
    const std::vector<Light> host = makeLights(random, setup, crowd);
    const ViewInput input = inputOf(setup, {160, 120}, host);
    const Prepared p(input);
    ASSERT_TRUE(p.ok);
    const CameraModel camera = makeCameraModel(input.camera, 160, 120);
    const std::vector<LightModel> all = makeLightModels(host, p.hostViews, camera);
    const auto sun = [](const LightOnScreen& l) { return l.type == LightType::Directional; };
    const auto spot = [](const LightOnScreen& l) { return l.type == LightType::Spot && l.nearestMetres > 0.5f; };
    const auto point = [](const LightOnScreen& l) { return l.type == LightType::Point && l.nearestMetres > 0.5f; };
    const auto errors = [&](auto which, auto change) { return errorsAfter(all, camera, p, which, change); };
    const auto nothing = [](LightOnScreen&) {};
    EXPECT_EQ(errors(sun, nothing), 0u);
    for (const LightType type : {LightType::Spot, LightType::Point, LightType::Directional}) {
        const auto local = [&](const LightOnScreen& l) {
            return type == LightType::Directional ? sun(l) : type == LightType::Spot ? spot(l) : point(l);
        };
        SCOPED_TRACE(int(type));
        EXPECT_EQ(errors(local, nothing), 0u);
        EXPECT_EQ(errors(local, [](LightOnScreen& l) { l.casts = !l.casts; }), 1u);
        EXPECT_EQ(errors(local, [](LightOnScreen& l) { l.filter = Filter::Host; }), 1u);
        EXPECT_EQ(errors(local, [](LightOnScreen& l) { l.pcssPreset ^= 1; }), 1u);
        EXPECT_EQ(errors(local, [](LightOnScreen& l) { l.sourceDiameterPx *= 1.001f; }), 1u);
        EXPECT_EQ(errors(local, [](LightOnScreen& l) { l.screenShare += 1.0f / 20; }), 1u);
        EXPECT_EQ(errors(local, [](LightOnScreen& l) { l.nearestMetres += 0.01f; }), 1u);
        EXPECT_EQ(errors(local, [](LightOnScreen& l) { l.type = LightType((int(l.type) + 1) % 3); }), 1u);
        EXPECT_EQ(errors(local, [](LightOnScreen& l) { l.reachDiameterPx = l.sourceDiameterPx; }), 1u);
        EXPECT_EQ(errors(local, [](LightOnScreen& l) { l.farthestMetres = 0.1f; }), 1u);
        if (type == LightType::Directional) continue;
        EXPECT_EQ(errors(local, [](LightOnScreen& l) { l.reachDiameterPx *= 1.001f; }), 1u);
        EXPECT_EQ(errors(local, [](LightOnScreen& l) { l.nearestMetres -= 0.01f; }), 1u);
        EXPECT_EQ(errors(local, [](LightOnScreen& l) { l.farthestMetres += 0.01f; }), 1u);
        EXPECT_EQ(errors(local, [](LightOnScreen& l) { l.farthestMetres -= 0.01f; }), 1u);
    }
}

TEST(Phase1, WrongAnswersAreFound) {
    Random random(32);
    const CameraSetup setup;
    const std::vector<Light> host = makeLights(random, setup, mixedLights(60));
    const ViewInput input = inputOf(setup, {160, 120}, host);
    const Prepared p(input);
    ASSERT_TRUE(p.ok);
    const CameraModel camera = makeCameraModel(input.camera, 160, 120);
    const std::vector<LightModel> all = makeLightModels(host, p.hostViews, camera);
    const std::size_t must = checkVisibleLights(all, orderLights(all, p.answer.visible), camera).must;
    const auto reportErrors = [&](auto change) {
        PreparedLights answer = p.answer;
        change(answer.report);
        return checkReport(all.size(), must, answer).errors;
    };
    EXPECT_EQ(reportErrors([](PrepareReport&) {}), 0u);
    EXPECT_EQ(reportErrors([](PrepareReport& r) { ++r.given; }), 1u);
    EXPECT_EQ(reportErrors([](PrepareReport& r) { ++r.visible; }), 1u);
    EXPECT_EQ(reportErrors([](PrepareReport& r) { ++r.directional; }), 1u);
    EXPECT_EQ(reportErrors([](PrepareReport& r) { --r.casting; }), 1u);
    EXPECT_EQ(reportErrors([](PrepareReport& r) { ++r.dropped; }), 1u);  // there was space
    const auto orderErrors = [&](auto change) {
        std::vector<LightOnScreen> entries(p.answer.visible.begin(), p.answer.visible.end());
        change(entries);
        return checkVisibleLights(all, orderLights(all, entries), camera).findings.errors;
    };
    EXPECT_EQ(orderErrors([](auto&) {}), 0u);
    EXPECT_GT(orderErrors([](auto& e) { std::swap(e[0], e.back()); }), 0u);  // a sun last
    EXPECT_GT(orderErrors([](auto& e) { std::reverse(e.begin() + 2, e.end()); }), 0u);
    EXPECT_GT(orderErrors([](auto& e) { e.erase(e.begin()); }), 0u);  // a sun is missing
    EXPECT_GT(orderErrors([](auto& e) { e[3] = e[2]; }), 0u);         // one twice, one missing
}

}  // namespace
}  // namespace gnomon::reference
