// Visibility against closed forms and hand-made atlases, and planted errors in final lists and slots.
#include <gtest/gtest.h>

#include "honest_buffers.h"

namespace gnomon::reference {
namespace {

TEST(ShadowViews, DepthFromLinear) {
    for (const bool orthographic : {false, true}) {
        for (const bool reversed : {false, true}) {
            const DepthFromLinear d = depthFromLinear(0.5, 20, orthographic, reversed);
            const auto at = [&](double linear) { return d.a + (orthographic ? d.b * linear : d.b / linear); };
            EXPECT_NEAR(at(0.5), reversed ? 1 : 0, 1e-12);
            EXPECT_NEAR(at(20), reversed ? 0 : 1, 1e-12);
            if (orthographic) {
                EXPECT_NEAR(at(10.25), 0.5, 1e-12);
            }
        }
    }
    EXPECT_EQ(depthFromLinear(0.5, kInfinity, false, true).a, 0.0);
    EXPECT_EQ(depthFromLinear(0.5, kInfinity, false, true).b, 0.5);
}

TEST(ShadowViews, Projection) {
    ShadowView view = makeShadowView({0, 5, 0}, {0, -1, 0}, {0, 0, 1}, 1.0, 0.1, kInfinity, false, true);
    view.xPx = 10;
    view.yPx = 20;
    view.widthPx = view.heightPx = 64;
    const ShadowViewModel model = makeShadowViewModels(std::span(&view, 1))[0];
    EXPECT_NEAR(model.pxPerMetreX, 32, 1e-5);
    EXPECT_NEAR(model.pxPerMetreY, 32, 1e-5);
    // 4 m below, 1 m along +z, which is a quarter of the half-width further down.
    const ShadowPosition at = project(model, {0, 1, 1}, 1e-6);
    EXPECT_NEAR(at.linearDepth, 4, 1e-6);
    EXPECT_NEAR(at.xPx, 10 + 32, 1e-5);
    EXPECT_NEAR(at.yPx, 20 + 32 + 8, 1e-5);
    EXPECT_GT(at.linearDepthError, 0);
    EXPECT_LT(at.xErrorPx, 1e-3);
}

// An 8 x 8 view at (2, 1) of a 12 x 12 atlas: its left half holds a near surface, the rest is far; nearest outside.
struct HandMade {
    ShadowViewModel view;
    AtlasCopy atlas;
    HandMade() {
        view.xPx = 2;
        view.yPx = 1;
        view.widthPx = view.heightPx = 8;
        view.reversed = true;
        atlas.widthPx = atlas.heightPx = 12;
        atlas.depth.assign(144, 1.0f);
        for (std::uint32_t y = 1; y < 9; ++y)
            for (std::uint32_t x = 2; x < 10; ++x) atlas.at(0, x, y) = x < 6 ? 0.5f : 0.0f;
    }
    Visibility at(Filter filter, int radius, double x, double y, double errorPx = 0) const {
        return against(filter, radius, x, y, errorPx, 0.25);
    }
    /// A receiver that faces the view, at this device depth.
    Visibility against(Filter filter, int radius, double x, double y, double errorPx, double depth) const {
        ReceiverPlane plane;
        plane.depth = within(depth, 1e-6);
        const Comparison comparison = {view, atlas, plane};
        if (filter == Filter::Hard) return hardAt(comparison, within(x, errorPx), within(y, errorPx));
        return pcfAt(comparison, radius, within(x, errorPx), within(y, errorPx));
    }
};

TEST(Filter, HardTakesTheTexel) {
    const HandMade m;
    EXPECT_EQ(m.at(Filter::Hard, 0, 5.99, 4).max, 0);
    EXPECT_EQ(m.at(Filter::Hard, 0, 6.01, 4).min, 1);
    const Visibility either = m.at(Filter::Hard, 0, 6.01, 4, 0.02);
    EXPECT_EQ(either.min, 0);
    EXPECT_EQ(either.max, 1);
    EXPECT_EQ(m.at(Filter::Hard, 0, 50, 4).min, 1);  // clamped to the rectangle's last texel
    EXPECT_EQ(m.at(Filter::Hard, 0, -50, -50).max, 0);
    // Equal within the error: ambiguous.
    EXPECT_EQ(m.against(Filter::Hard, 0, 3, 3, 0, 0.5).max, 1);
    EXPECT_EQ(m.against(Filter::Hard, 0, 3, 3, 0, 0.5).min, 0);
    EXPECT_EQ(m.against(Filter::Hard, 0, 3, 3, 0, 0.501).min, 1);
}

TEST(Filter, StandardDepthComparesTheOtherWay) {
    HandMade m;
    m.view.reversed = false;
    EXPECT_EQ(m.against(Filter::Hard, 0, 3, 3, 0, 0.25).min, 1);  // 0.5 is farther
    EXPECT_EQ(m.against(Filter::Hard, 0, 8, 3, 0, 0.25).max, 0);  // 0.0 is nearer
}

TEST(Filter, PcfIsAMeanOfBilinearComparisons) {
    const HandMade m;
    for (const int radius : {1, 2, 3}) {
        for (double x = 2 + radius + 1; x <= 10 - radius - 1; x += 0.125) {
            // One axis decides: each of the 2r + 1 comparisons is lit by the share of it beyond x = 6.
            double sum = 0;
            for (int i = -radius; i <= radius; ++i) sum += std::clamp(x + i - 5.5, 0.0, 1.0);
            const Visibility v = m.at(Filter::Pcf, radius, x, 5);
            EXPECT_NEAR(v.min, sum / (2 * radius + 1), 1e-12);
            EXPECT_NEAR(v.max, sum / (2 * radius + 1), 1e-12);
        }
    }
}

TEST(Filter, PcfStaysInTheRectangle) {
    const HandMade m;
    for (const double y : {-5.0, 1.0, 2.0, 9.0, 30.0}) {
        // Radius 2 goes no farther right than x = 7: half a dark texel of five. Radius 3 just fits 8 texels, in the
        // middle.
        EXPECT_NEAR(m.at(Filter::Pcf, 2, 100, y).min, 3.5 / 5.0, 1e-12);
        EXPECT_NEAR(m.at(Filter::Pcf, 3, 100, y).min, 0.5, 1e-12);
        EXPECT_NEAR(m.at(Filter::Pcf, 3, -100, y).max, 0.5, 1e-12);
    }
}

TEST(Filter, PcfIntervalHoldsAllPositionsWithinTheError) {
    const HandMade m;
    const Visibility range = m.at(Filter::Pcf, 1, 6.45, 5, 0.2);
    for (double x = 6.25; x <= 6.65; x += 0.01) {
        const Visibility v = m.at(Filter::Pcf, 1, x, 5);
        EXPECT_LE(range.min, v.min + 1e-12);
        EXPECT_GE(range.max, v.max - 1e-12);
    }
    EXPECT_LT(range.max - range.min, 0.4 / 3 + 1e-9);
}

TEST(Quantised, SquareRootAndFade) {
    EXPECT_EQ(quantised({0, 0}, 1).max, 0);
    EXPECT_EQ(quantised({1, 1}, 1).min, 255);
    EXPECT_EQ(quantised({0.25, 0.25}, 1).min, 127);  // 127.5: a tie, so either
    EXPECT_EQ(quantised({0.25, 0.25}, 1).max, 128);
    EXPECT_EQ(quantised({0.5, 0.5}, 1).min, 180);
    EXPECT_EQ(quantised({0.5, 0.5}, 1).max, 180);
    EXPECT_EQ(quantised({0, 0}, 0).min, 255);
    EXPECT_EQ(quantised({0, 0}, 0.5).min, 180);
    EXPECT_EQ(quantised({1, 1}, 1, 15).min, 15);
    EXPECT_EQ(quantised({0.5, 0.5}, 1, 15).min, 11);  // 10.6
    EXPECT_EQ(quantised({0.5, 0.5}, 1, 15).max, 11);
    EXPECT_EQ(quantised({0, 0}, Interval(0.5, 1), 15).min, 0);
    EXPECT_EQ(quantised({0, 0}, Interval(0.5, 1), 15).max, 11);
}

// A directional light's shadow fades with the distance of eye and pixel.
TEST(Quantised, FadeByPixel) {
    Light sun;
    sun.type = LightType::Directional;
    sun.shadowFadeStartMetres = 10;
    sun.shadowFadeEndMetres = 20;
    const CameraSetup setup;
    const LightShadowViews views = {0, 1};
    const LightModel model = makeLightModels(std::span(&sun, 1), std::span(&views, 1),
                                             makeCameraModel(makeCamera(setup, 64, 64), 64, 64))[0];
    EXPECT_TRUE(model.casts);
    EXPECT_TRUE(model.shadowFades);
    const auto at = [&](double distance) {
        Pixel pixel;
        pixel.eyeDistance = distance;
        return shadowFadeAt(model, pixel);
    };
    EXPECT_EQ(at(9).lo, 1.0);
    EXPECT_NEAR(at(12.5).middle(), 0.75, 1e-9);
    EXPECT_LT(at(12.5).width(), 1e-5);
    EXPECT_EQ(at(21).hi, 0.0);
}

/// A floor at y = 0, a lamp above it, a ball between them.
struct BallOverFloor {
    Shapes shapes = {plane({0, 0, 0}, {0, 1, 0}), ball({0, 2, 0}, 0.5)};
    Light light;
    LightModel model;
    ShadowInput input;
    BallOverFloor(LightType type, float outerConeAngle, const ShadowSetup& setup) {
        light.type = type;
        light.outerConeAngle = outerConeAngle;
        light.position[1] = 4;
        light.direction[1] = -1;
        light.direction[2] = 0;
        light.rangeMetres = 20;
        TestShadows shadows = buildShadows(shapes, std::span(&light, 1), setup);
        input.views = makeShadowViewModels(shadows.views);
        input.atlases = std::move(shadows.atlases);
        model.type = type;
        model.sixFaces = shadows.lightViews[0].count == gpu::kPointLightFaces;
        model.position = {0, 4, 0};
        model.direction = {0, -1, 0};
        model.casts = true;
        model.filter = Filter::Pcf;
        model.firstShadowView = 0;
        model.rangeMetres = 20;
        model.biasMetres = 0.002;
    }
    [[nodiscard]] Visibility onFloor(double x, double z) const {
        Pixel pixel;
        pixel.background = false;
        pixel.position = {x, 0, z};
        pixel.positionError = 1e-6;
        pixel.hasFaceNormal = true;
        pixel.faceNormal = {0, 1, 0};
        return visibility(model, pixel, input);
    }
};

// From 4 m up, a ball of 0.5 m at 2 m shadows the disk of radius 4 tan(asin(0.5 / 2)). Floor elsewhere is lit: no acne.
TEST(GenerateShadows, ShadowOfABallIsADisk) {
    const double radius = 4 * std::tan(std::asin(0.25));
    for (const auto& [type, angle] : {std::pair(LightType::Point, 0.0f), std::pair(LightType::Spot, 0.785f),
                                      std::pair(LightType::Spot, 1.57079637f)}) {  // six views, one, six
        for (const bool reversed : {true, false}) {
            ShadowSetup setup;
            setup.viewSizePx = 256;
            setup.reversed = reversed;
            setup.infiniteFar = reversed;
            BallOverFloor scene(type, angle, setup);
            for (const Filter filter : {Filter::Hard, Filter::Pcf}) {
                scene.model.filter = filter;
                Random random(9);
                for (int i = 0; i < 1000; ++i) {
                    const double x = random.uniform(-2.5, 2.5), z = random.uniform(-2.5, 2.5);
                    if (std::abs(std::hypot(x, z) - radius) < 0.15) continue;
                    const Visibility v = scene.onFloor(x, z);
                    const double expected = std::hypot(x, z) < radius ? 0.0 : 1.0;
                    EXPECT_NEAR(v.min, expected, 1e-12) << x << ' ' << z;
                    EXPECT_NEAR(v.max, expected, 1e-12) << x << ' ' << z;
                }
            }
        }
    }
}

// A point light's faces: in a closed box around the lamp everything is lit, in every direction. Along the box's own
// edges a wide kernel sees the neighbouring wall, which is nearer: those are left out.
TEST(GenerateShadows, BoxAroundAPointLightIsLit) {
    ShadowSetup setup;
    setup.viewSizePx = 128;
    Light light;
    light.rangeMetres = 20;
    const Shapes shapes = {box({-2, -2, -2}, {2, 2, 2})};
    TestShadows shadows = buildShadows(shapes, std::span(&light, 1), setup);
    ShadowInput input;
    input.views = makeShadowViewModels(shadows.views);
    input.atlases = std::move(shadows.atlases);
    LightModel model;
    model.casts = model.sixFaces = true;
    model.filter = Filter::Pcf;
    model.firstShadowView = 0;
    model.biasMetres = 0.002;
    model.rangeMetres = 20;
    Random random(10);
    int total = 0;
    for (int i = 0; i < 3000; ++i) {
        const auto hit = trace(shapes, {0, 0, 0}, random.unitVector());
        ASSERT_TRUE(hit);
        Pixel pixel;
        pixel.background = false;
        pixel.position = hit->position;
        pixel.positionError = 1e-6;
        pixel.hasFaceNormal = true;
        pixel.faceNormal = hit->normal;
        int nearWalls = 0;
        for (int axis = 0; axis < 3; ++axis) nearWalls += std::abs(component(hit->position, axis)) > 1.8;
        if (nearWalls == 1) {
            EXPECT_NEAR(visibility(model, pixel, input).min, 1.0, 1e-12);
            ++total;
        }
        pixel.faceNormal = -hit->normal;
        EXPECT_EQ(visibility(model, pixel, input).max, 0.0);  // faces away: dark without sampling
        pixel.subsurface = true;
        pixel.hasFaceNormal = false;
        EXPECT_EQ(visibility(model, pixel, input).max, 1.0);  // unknown normal: anything
    }
    EXPECT_GT(total, 2000);
}

TEST(GenerateShadows, WhatNeedsNoSampling) {
    BallOverFloor scene(LightType::Spot, 0.785f, {});
    scene.model.casts = false;
    EXPECT_EQ(scene.onFloor(0, 0).min, 1);
    scene.model.casts = true;
    EXPECT_EQ(scene.onFloor(0, 0).max, 0);
    scene.input.shadowsOff = true;
    EXPECT_EQ(scene.onFloor(0, 0).min, 1);
}

TEST(GenerateShadows, SubsurfaceBiasReachesThroughThinWalls) {
    BallOverFloor scene(LightType::Spot, 0.785f, {});
    scene.input.subsurfaceBiasMetres = 3.0;  // more than from the floor to the ball's top
    Pixel pixel;
    pixel.background = false;
    pixel.positionError = 1e-6;
    pixel.hasFaceNormal = true;
    pixel.faceNormal = {0, 1, 0};
    EXPECT_EQ(visibility(scene.model, pixel, scene.input).max, 0);
    pixel.subsurface = true;
    EXPECT_NEAR(visibility(scene.model, pixel, scene.input).min, 1, 1e-12);
    scene.input.subsurfaceBiasMetres = 0.02;
    EXPECT_EQ(visibility(scene.model, pixel, scene.input).max, 0);
    pixel.faceNormal = {0, -1, 0};
    EXPECT_EQ(visibility(scene.model, pixel, scene.input).max, 0);
}

struct FinalLists : testing::Test {
    TestFrame frame = makeTestFrame(23, 260, 140, 40);
    std::vector<TileLights> expected = findLights(frame.grid, frame.lights, true);
    HonestBuffers honest = makeHonestBuffers(frame, expected);
    ShadowReport check(const HonestBuffers& buffers, bool mayEvaluate = false) const {
        return checkFinalLists(frame.grid, frame.lights, frame.shadows, buffers.view(), mayEvaluate);
    }
};

TEST_F(FinalLists, HonestOnesPass) {
    const ShadowReport report = check(honest);
    EXPECT_TRUE(report.findings.ok()) << report.findings.text();
    EXPECT_GT(report.slots, 10u);
    EXPECT_GT(report.allLit, 10u);
    EXPECT_GT(report.allUnlit, 3u);
    EXPECT_GT(report.bytes, 500u);
    EXPECT_LT(report.ambiguousShare(), 0.03);
}

TEST_F(FinalLists, PlantedErrorsAreFound) {
    HonestBuffers spoilt = honest;
    std::uint32_t* entry = spoilt.findEntry(true);
    ASSERT_NE(entry, nullptr);
    const std::uint32_t light = gpu::finalLightIndex(*entry), slot = gpu::finalSlotOrFlag(*entry);
    for (std::uint32_t w = 0; w < 16; ++w) spoilt.visibility[slot * 16 + w] ^= 0x80808080u;
    EXPECT_GE(check(spoilt).wrongBytes, 1u);
    spoilt = honest;
    entry = spoilt.findEntry(true);
    *entry = gpu::packFinalEntry(light, gpu::kSlotAllLit);
    EXPECT_EQ(check(spoilt).findings.errors, 1u);
    *entry = gpu::packFinalEntry(light, gpu::kSlotEvaluate);
    EXPECT_EQ(check(spoilt).findings.errors, 1u);
    EXPECT_EQ(check(spoilt, true).findings.errors, 0u);
    *entry = gpu::packFinalEntry(light, gpu::kSlotAllUnlit);
    EXPECT_EQ(check(spoilt).findings.errors, 1u);
    spoilt = honest;
    entry = spoilt.findEntry(false);
    *entry = gpu::packFinalEntry(gpu::finalLightIndex(*entry), 0);  // ALL_LIT turned into some slot
    EXPECT_GE(check(spoilt).findings.errors, 1u);
}

TEST_F(FinalLists, SlotsOfFourBits) {
    for (const Filter filter : {Filter::Pcf, Filter::Pcss, Filter::PcssShared}) {
        useFilter(frame.lights, filter);
        frame.shadows.visibilityBits = 4;
        HonestBuffers half = makeHonestBuffers(frame, expected);
        EXPECT_EQ(half.visibility.size(), std::size_t(half.slots) * 8);
        const ShadowReport report = check(half);
        EXPECT_TRUE(report.findings.ok()) << report.findings.text();
        EXPECT_GT(report.exactBytes, 500u);
        for (std::uint32_t& word : half.visibility) word = word << 4 | word >> 28;  // the neighbour's value
        EXPECT_GT(check(half).wrongBytes, 20u);
        half.visibilityBits = 8;
        EXPECT_FALSE(check(half).findings.ok());
    }
}

// Bytes in another order than Morton lanes are found.
TEST_F(FinalLists, LaneOrderMatters) {
    HonestBuffers spoilt = honest;
    for (std::uint32_t slot = 0; slot < spoilt.slots; ++slot) {
        std::uint32_t rows[16] = {};
        for (std::uint32_t y = 0; y < 8; ++y)
            for (std::uint32_t x = 0; x < 8; ++x)
                rows[(y * 8 + x) / 4] |= std::uint32_t(storedVisibility(honest.view(), slot, x, y)) << (8 * (x % 4));
        std::copy(rows, rows + 16, spoilt.visibility.begin() + slot * 16);
    }
    EXPECT_GT(check(spoilt).wrongBytes, 50u);
}

}  // namespace
}  // namespace gnomon::reference
