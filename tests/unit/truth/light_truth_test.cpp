// Soft truth against closed forms, and figures that tell planted errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "truth/flicker.h"
#include "unit/truth/truth_scenes.h"

namespace gnomon::renderer::truth_test {
namespace {

// Share of a disk of radius 1 beyond the line x = s.
double beyond(double s) {
    if (s <= -1.0) return 1.0;
    if (s >= 1.0) return 0.0;
    return (std::acos(s) - s * std::sqrt(1.0 - s * s)) / std::numbers::pi;
}

// A light at (0, 4, 0); an edge at the height of 1 m over x = `edge`, seen from x on the floor, falls on the light's
// plane.
double onLightsPlane(double x, double edge) {
    return x + 4.0 * (edge - x);
}

LightSource disk(double radius) {
    LightSource source;
    source.kind = LightKind::Spot;
    source.position = {0.0, 4.0, 0.0};
    source.direction = {0.0, -1.0, 0.0};
    source.radius = radius;
    return source;
}

TEST(SoftShadow, HalfPlaneHidesASegment) {
    SceneBuilder b;
    b.quad({-50, 1, -50}, {0, 1, -50}, {0, 1, 50}, {-50, 1, 50});
    const TracedScene traced(b.scene, restPose(b.scene), glm::dvec3(0.0));
    double worst = 0.0;
    for (int i = -30; i <= 30; ++i) {
        const double x = 0.01 * i;
        const double expected = beyond(onLightsPlane(x, 0.0) / 0.6);
        const double seen = softVisibility(traced, onFloor(x, 0.0), disk(0.6), 16, static_cast<std::uint64_t>(i + 99));
        worst = std::max(worst, std::abs(seen - expected));
    }
    EXPECT_LT(worst, 0.02);
    EXPECT_GT(worst, 0.0);
}

TEST(SoftShadow, SlitShowsAStrip) {
    SceneBuilder b;
    b.quad({-50, 1, -50}, {-0.05f, 1, -50}, {-0.05f, 1, 50}, {-50, 1, 50});
    b.quad({0.05f, 1, -50}, {50, 1, -50}, {50, 1, 50}, {0.05f, 1, 50});
    const TracedScene traced(b.scene, restPose(b.scene), glm::dvec3(0.0));
    for (int i = -30; i <= 30; ++i) {
        const double x = 0.01 * i;
        const double expected = beyond(onLightsPlane(x, -0.05) / 0.6) - beyond(onLightsPlane(x, 0.05) / 0.6);
        EXPECT_NEAR(softVisibility(traced, onFloor(x, 0.0), disk(0.6), 16, 7), expected, 0.025) << x;
    }
}

TEST(SoftShadow, SphereHidesADisk) {
    SceneBuilder b;
    b.sphere({0, 2, 0}, 0.2f, 256);
    const TracedScene traced(b.scene, restPose(b.scene), glm::dvec3(0.0));
    // From below its centre the sphere hides a disk of the light's plane: the cone of tangents at a height of 4 m.
    const double hidden = 4.0 * std::tan(std::asin(0.1));
    EXPECT_NEAR(softVisibility(traced, onFloor(0, 0), disk(1.0), 32, 1), 1.0 - hidden * hidden, 0.01);
    EXPECT_EQ(softVisibility(traced, onFloor(0, 0), disk(0.99 * hidden), 16, 1), 0.0);
    EXPECT_EQ(softVisibility(traced, onFloor(3, 0), disk(1.0), 16, 1), 1.0);
}

TEST(SoftShadow, SunIsACone) {
    SceneBuilder b;
    b.quad({-50, 1, -50}, {0, 1, -50}, {0, 1, 50}, {-50, 1, 50});
    const TracedScene traced(b.scene, restPose(b.scene), glm::dvec3(0.0));
    LightSource sun;
    sun.kind = LightKind::Directional;
    sun.radius = 0.1;
    for (int i = -12; i <= 12; ++i) {
        const double x = 0.01 * i, expected = beyond(-x / std::tan(0.1));
        EXPECT_NEAR(softVisibility(traced, onFloor(x, 0.0), sun, 16, 5), expected, 0.02) << x;
    }
}

TEST(SoftShadow, HorizonHidesWhatIsBelow) {
    SceneBuilder b;
    b.quad({-1, -5, -1}, {1, -5, -1}, {1, -5, 1}, {-1, -5, 1});
    const TracedScene traced(b.scene, restPose(b.scene), glm::dvec3(0.0));
    LightSource low = disk(0.5);
    low.kind = LightKind::Point;
    low.position = {4.0, 0.0, 0.0};
    TruthReceiver r = onFloor(0, 0);
    EXPECT_NEAR(softVisibility(traced, r, low, 16, 3), 0.5, 0.02);
    r.subsurface = true;
    EXPECT_EQ(softVisibility(traced, r, low, 16, 3), 1.0);
}

bool same(const LightTruth& a, const LightTruth& b) {
    return std::ranges::equal(a.pixels, b.pixels, [](const PixelTruth& p, const PixelTruth& q) {
        return p.hard == q.hard && p.edge == q.edge && p.subset == q.subset &&
               (p.soft == q.soft || (std::isnan(p.soft) && std::isnan(q.soft)));
    });
}

// A plate that lies 5 mm over the floor, a ball over both, one light.
class PlantedErrors : public testing::Test {
protected:
    PlantedErrors() {
        b.quad({-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, 4);
        b.quad({-1, 0.005f, -1}, {-1, 0.005f, 0}, {0, 0.005f, 0}, {0, 0.005f, -1}, 2);
        b.sphere({0.8f, 0.8f, 0.2f}, 0.5f, 24);
        traced = std::make_unique<TracedScene>(b.scene, restPose(b.scene), glm::dvec3(0.0));
        seen = lookAt(*traced, {2.5, 1.8, 3.0}, {0.0, 0.2, 0.0}, {160, 90});
        desc.light.position = {-2.5f, 2.0f, 0.6f};
        desc.light.rangeMetres = 20.0f;
        desc.light.sourceRadius = 0.2f;
        desc.soft = false;
    }
    // As a renderer would find it whose points stand `towardLight` metres nearer to the light.
    std::vector<float> biased(double towardLight) const {
        std::vector<float> result;
        for (const TruthReceiver& r : seen.receivers) {
            const glm::dvec3 light(desc.light.position), toLight = glm::normalize(light - r.position);
            const bool away = glm::dot(r.normal, toLight) <= 0.0;
            // Away from the light, even the own face is before the point.
            const std::uint32_t own = towardLight >= 0.0 ? r.triangle : kNone;
            const bool dark = away || traced->blocked({r.position + towardLight * toLight, light, own});
            result.push_back(r.triangle == kNone ? -1.0f : dark ? 0.0f : 1.0f);
        }
        return result;
    }
    LightTruth truthFor(const std::vector<float>& result) const {
        LightTruth truth = traceLight(*traced, seen.receivers, seen.extent, desc);
        completeSoftTruth(truth, *traced, seen.receivers, desc, result);
        return truth;
    }
    Figures judged(const std::vector<float>& result) const {
        return figuresOf(truthFor(result), result, desc.soft).opaque;
    }

    SceneBuilder b;
    std::unique_ptr<TracedScene> traced;
    Seen seen;
    LightTruthDesc desc;
};

TEST_F(PlantedErrors, TruthItselfHasNone) {
    const Figures f = judged(biased(0.0));
    EXPECT_GT(f.pairs, 5000u);
    EXPECT_GT(f.dark, 500u);
    EXPECT_GT(f.away, 50u);
    EXPECT_GT(f.edges, 100u);
    EXPECT_EQ(f.acne + f.leak + f.contactLeak + f.edgeError, 0u);
}

TEST_F(PlantedErrors, OneCentimetreTowardTheLightLeaks) {
    // The plate's edge from near by: its shadow is 6 mm wide.
    seen = lookAt(*traced, {0.06, 0.05, -0.45}, {0.0, 0.0, -0.5}, {160, 90});
    EXPECT_EQ(judged(biased(0.0)).contactLeak, 0u);
    const Figures f = judged(biased(0.01));
    EXPECT_EQ(f.acne, 0u);
    EXPECT_GT(f.contactLeak, 500u);
    EXPECT_GT(f.contactLeakOfContacts(), 0.5);
}

TEST_F(PlantedErrors, OneCentimetreAwayFromTheLightIsAcne) {
    const Figures f = judged(biased(-0.01));
    EXPECT_GT(f.share(f.acne), 0.3);
    EXPECT_EQ(f.leak, 0u);
}

TEST_F(PlantedErrors, LostShadowsLeak) {
    std::vector<float> result(seen.receivers.size(), 1.0f);
    const Figures f = judged(result);
    EXPECT_GT(f.leak, 400u);
    EXPECT_GT(f.edgeError, 20u);
    EXPECT_EQ(f.acne, 0u);
}

// Shadowmaps so coarse that every pixel counts as an edge: acne and leak say nothing, and what says so is told.
TEST_F(PlantedErrors, WhatIsSetAsideIsTold) {
    const std::vector<float> lost(seen.receivers.size(), 1.0f);
    for (const bool soft : {false, true}) {
        SCOPED_TRACE(soft);
        desc.soft = soft;
        desc.subsetOf = 1;
        const auto all = [&](const std::vector<float>& result) { return figuresOf(truthFor(result), result, soft); };
        const LightFigures right = all(biased(0.0));
        EXPECT_LT(right.setAside(), 0.4);
        LightTruth coarse = truthFor(lost);
        for (PixelTruth& pixel : coarse.pixels) pixel.edge = true;
        const LightFigures f = figuresOf(coarse, lost, soft);
        EXPECT_EQ(f.opaque.acne + f.opaque.leak, 0u);
        EXPECT_EQ(f.setAside(), 1.0);
        EXPECT_GT(f.wrongOfSetAside(), 0.1);
        EXPECT_EQ(f.opaque.comparedPairs, f.opaque.pairs);
        EXPECT_GT(f.opaque.visibilityError(), 0.1);
        EXPECT_GT(f.opaque.visibilityError(), 5.0 * right.opaque.visibilityError());
    }
}

// The mean over all pairs of what the result is off by.
TEST_F(PlantedErrors, VisibilityErrorIsTheMeanDifference) {
    std::vector<float> result = biased(0.0);
    EXPECT_EQ(judged(result).visibilityError(), 0.0);
    const auto dark =
        std::ranges::count_if(truthFor(result).pixels, [](const PixelTruth& p) { return p.hard != HardTruth::Lit; });
    for (float& v : result) v = v < 0.0f ? v : 1.0f;
    const Figures lost = judged(result);
    EXPECT_NEAR(lost.visibilityError(), static_cast<double>(dark) / static_cast<double>(lost.pairs), 1e-9);
    desc.soft = true;
    desc.subsetOf = 1;
    const LightTruth soft = truthFor(result);
    for (std::size_t i = 0; i < soft.indices.size(); ++i)
        result[soft.indices[i]] = std::abs(soft.pixels[i].soft - 0.25f);  // never negative, and off by 0.25 or less
    const Figures off = figuresOf(soft, result, true).opaque;
    EXPECT_LE(off.visibilityError(), 0.25 + 1e-6);
    EXPECT_GT(off.visibilityError(), 0.2);
}

TEST_F(PlantedErrors, FaintErrorsStandApart) {
    for (const bool soft : {false, true}) {
        desc.soft = soft;
        desc.light.sourceRadius = 0.01f;
        std::vector<float> result = biased(0.0);
        for (float& v : result) v = v < 0.0f ? v : 0.2f + 0.6f * v;
        const Figures f = judged(result);
        EXPECT_EQ(f.acne + f.leak + f.contactLeak + f.edgeError, 0u);
        EXPECT_GT(f.faintAcne, 4000u);
        EXPECT_GT(f.faintLeak, 400u);
        EXPECT_LE(f.faintAcne + f.faintLeak + f.edges, f.pairs);
        EXPECT_EQ(judged(biased(0.0)).faintAcne + judged(biased(0.0)).faintLeak, 0u);
    }
}

TEST_F(PlantedErrors, PixelsNotReachedDoNotCount) {
    desc.light.rangeMetres = 0.1f;
    EXPECT_EQ(judged(biased(0.0)).pairs, 0u);
    desc.light.rangeMetres = 20.0f;
    EXPECT_EQ(judged(std::vector<float>(seen.receivers.size(), -1.0f)).pairs, 0u);
}

TEST_F(PlantedErrors, SubsurfaceStandsApart) {
    b.scene.materials[0].subsurface = true;
    for (TruthReceiver& r : seen.receivers) r.subsurface = true;
    const std::vector<float> result(seen.receivers.size(), 1.0f);
    const LightFigures f = figuresOf(truthFor(result), result, false);
    EXPECT_EQ(f.opaque.pairs, 0u);
    EXPECT_GT(f.subsurface.pairs, 5000u);
    EXPECT_EQ(f.subsurface.away, 0u);
}

TEST_F(PlantedErrors, PenumbraeAreMeasured) {
    desc.soft = true;
    desc.subsetOf = 1;
    std::vector<float> result = biased(0.0);
    const LightTruth truth = truthFor(result);
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) result[truth.indices[i]] = truth.pixels[i].soft;
    const Figures same = figuresOf(truth, result, true).opaque;
    EXPECT_GT(same.penumbraPairs, 300u);
    EXPECT_EQ(same.penumbraRmse(), 0.0);
    EXPECT_NEAR(same.penumbraSsim(), 1.0, 1e-6);
    for (const std::uint32_t i : truth.indices) result[i] += 0.1f;
    const Figures off = figuresOf(truth, result, true).opaque;
    double low = 0.0, high = 0.0;
    off.penumbraRmseInterval(low, high);
    EXPECT_NEAR(off.penumbraRmse(), 0.1, 1e-6);
    EXPECT_LE(low, off.penumbraRmse());
    EXPECT_GE(high, off.penumbraRmse());
    EXPECT_LT(off.penumbraSsim(), 0.98);
}

TEST_F(PlantedErrors, SubsetIsOneInSixteenAndRepeats) {
    desc.soft = true;
    const std::vector<float> result = biased(0.0);
    const LightTruth once = truthFor(result), again = truthFor(result);
    ASSERT_EQ(once.indices, again.indices);
    EXPECT_TRUE(same(once, again));
    const auto chosen = std::ranges::count_if(once.pixels, [](const PixelTruth& p) { return p.subset; });
    EXPECT_NEAR(static_cast<double>(chosen) / static_cast<double>(once.pixels.size()), 1.0 / 16.0, 0.03);
}

// One truth judges several results, and says of each what a truth of its own would say.
TEST_F(PlantedErrors, OneTruthJudgesManyResults) {
    desc.soft = true;
    const std::vector<float> results[] = {biased(0.0), biased(-0.01), std::vector<float>(seen.receivers.size(), 1.0f),
                                          std::vector<float>(seen.receivers.size(), 0.0f)};
    LightTruth shared = traceLight(*traced, seen.receivers, seen.extent, desc);
    for (const std::vector<float>& result : results) completeSoftTruth(shared, *traced, seen.receivers, desc, result);
    std::size_t more = 0;
    for (const std::vector<float>& result : results) {
        const LightTruth own = truthFor(result);
        for (std::size_t i = 0; i < own.pixels.size(); ++i)
            more += std::isnan(own.pixels[i].soft) && !std::isnan(shared.pixels[i].soft);
        const Figures a = figuresOf(own, result, true).opaque, b = figuresOf(shared, result, true).opaque;
        EXPECT_EQ(a.pairs, b.pairs);
        EXPECT_EQ(a.acne, b.acne);
        EXPECT_EQ(a.leak, b.leak);
        EXPECT_EQ(a.contactLeak, b.contactLeak);
        EXPECT_EQ(a.edgeError, b.edgeError);
        EXPECT_EQ(a.faintAcne, b.faintAcne);
        EXPECT_EQ(a.faintLeak, b.faintLeak);
        EXPECT_EQ(a.squaredError, b.squaredError);
        EXPECT_EQ(a.ssimSum, b.ssimSum);
    }
    EXPECT_GT(more, 1000u) << "the others asked for soft truth that this one does not need";
}

// 100 m away a standard depth buffer with a near plane of 5 cm steps by 12 mm: points that it gives lie below their own
// surface as often as above it. Truth, whose points lie on their triangles, is not darkened by any neighbour.
TEST(LightTruth, CoplanarNeighboursAHundredMetresAwayAreLit) {
    SceneBuilder b;
    b.quad({-90, 0, -60}, {-90, 0, 60}, {90, 0, 60}, {90, 0, -60}, 24);
    b.scene.instances[0].worldFromObject =
        glm::rotate(glm::translate(glm::mat4(1.0f), {70.3f, -31.7f, 43.1f}), 0.4f, glm::vec3(0.3f, 0.8f, -0.5f));
    const glm::dmat4 world(b.scene.instances[0].worldFromObject);
    const auto at = [&](double x, double y, double z) { return glm::dvec3(world * glm::dvec4(x, y, z, 1.0)); };
    const glm::dvec3 eye = at(3.0, 35.0, 94.0);
    const TracedScene traced(b.scene, restPose(b.scene), eye);
    const Seen seen = lookAt(traced, eye, at(0.0, 0.0, 0.0), {128, 72});
    LightTruthDesc desc;
    desc.light.position = glm::vec3(at(-5.0, 2.0, 8.0));
    desc.light.rangeMetres = 200.0f;
    desc.light.sourceRadius = 0.2f;
    const LightTruth truth = traceLight(traced, seen.receivers, seen.extent, desc);
    const auto lit = std::ranges::count_if(truth.pixels, [](const PixelTruth& p) { return p.hard == HardTruth::Lit; });
    EXPECT_GT(lit, 5000);
    EXPECT_EQ(lit, std::ssize(truth.pixels));
    const auto edges = std::ranges::count_if(truth.pixels, [](const PixelTruth& p) { return p.edge; });
    EXPECT_EQ(edges, 0);
    const auto partly = std::ranges::count_if(truth.pixels, [](const PixelTruth& p) { return p.soft < 1.0f; });
    EXPECT_EQ(partly, 0);

    constexpr double kNear = 0.05;
    const glm::dvec3 light = glm::dvec3(desc.light.position) - traced.origin();
    const glm::dvec3 forward = glm::normalize(at(0.0, 0.0, 0.0) - eye);
    std::size_t dark = 0;
    for (const std::uint32_t i : truth.indices) {
        const glm::dvec3 p = seen.receivers[i].position;
        const double depth = glm::dot(p, forward);
        const double stored = kNear / (1.0 - static_cast<double>(static_cast<float>(1.0 - kNear / depth)));
        dark += traced.blocked({stored / depth * p, light});
    }
    EXPECT_GT(dark, truth.pixels.size() / 4) << "from the depth buffer: acne";
}

// Beside a panel of 2 mm on a grazed floor, 4 km from the origin: within its footprint the floor is not unanimous.
TEST(LightTruth, ThinPanelsMakeEdgesFarFromTheOrigin) {
    for (const double away : {0.0, 4096.0}) {
        SceneBuilder b;
        b.quad({-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2});
        b.quad({0, 0.002f, -1}, {0, 0.002f, 1}, {1, 0.002f, 1}, {1, 0.002f, -1});
        b.quad({0, 0, -1}, {0, 0, 1}, {0, 0.002f, 1}, {0, 0.002f, -1});
        Pose pose = restPose(b.scene);
        for (glm::dmat4& world : pose.worldFromObject) world[3].x = away;
        const TracedScene traced(b.scene, pose, {away, 0.0, 0.0});
        TruthReceiver r = onFloor(-0.01, 0.1, 0);
        r.pixelMetres = 0.01;
        LightTruthDesc desc;
        desc.light.position = glm::vec3(static_cast<float>(away) - 2.0f, 0.3f, 0.0f);
        desc.light.rangeMetres = 20.0f;
        desc.soft = false;
        LightTruth truth = traceLight(traced, {&r, 1}, {1, 1}, desc);
        ASSERT_EQ(truth.pixels.size(), 1u);
        EXPECT_EQ(truth.pixels[0].hard, HardTruth::Lit);
        EXPECT_TRUE(truth.pixels[0].edge) << away;
        r.position.x = -0.5;
        truth = traceLight(traced, {&r, 1}, {1, 1}, desc);
        EXPECT_FALSE(truth.pixels[0].edge) << away;
    }
}

TEST(ErrorOf, SoftTruthThatNobodyAskedForDoesNotCount) {
    PixelTruth hidden;  // the source's centre alone is hidden
    hidden.hard = HardTruth::Dark;
    hidden.soft = 1.0f;
    EXPECT_EQ(errorOf(hidden, 0.0f, true), PairError::None) << "as if no other result had asked";
    EXPECT_EQ(errorOf(hidden, 1.0f, true), PairError::None);
    hidden.subset = true;
    EXPECT_EQ(errorOf(hidden, 0.0f, true), PairError::Acne);
    EXPECT_EQ(errorOf(hidden, -1.0f, true), PairError::NotCounted);
}

// Where the source is seen in part, a result is wrong that is off by more than a half.
TEST(ErrorOf, PenumbraeAreJudgedToo) {
    PixelTruth half;
    half.hard = HardTruth::Dark;
    half.subset = true;
    half.soft = 0.4f;
    EXPECT_EQ(errorOf(half, 0.0f, true), PairError::None);
    EXPECT_EQ(errorOf(half, 0.85f, true), PairError::None);
    EXPECT_EQ(errorOf(half, 1.0f, true), PairError::PenumbraError);
    half.edge = true;
    EXPECT_EQ(errorOf(half, 1.0f, true), PairError::PenumbraError);
    half.subset = false;  // asked for, since result and hard truth disagree
    EXPECT_EQ(errorOf(half, 1.0f, true), PairError::PenumbraError);
    half.soft = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(errorOf(half, 1.0f, true), PairError::None) << "nobody has traced it";
}

TEST(Flicker, CountsChangeWhereNothingChanges) {
    LightTruth truth{{4, 1}, {0, 1, 2}, std::vector<PixelTruth>(3)};
    for (PixelTruth& pixel : truth.pixels) pixel.hard = HardTruth::Lit;
    truth.pixels[1].edge = true;
    FlickerMeter meter;
    meter.add(truth, std::vector<float>{1.0f, 1.0f, 1.0f, -1.0f});
    EXPECT_EQ(meter.figures().pairs, 0u);
    meter.add(truth, std::vector<float>{0.5f, 0.0f, 1.0f, -1.0f});
    EXPECT_EQ(meter.figures().pairs, 2u) << "no edge, no background";
    EXPECT_NEAR(meter.figures().mean(), 0.25, 1e-4);
    truth.pixels[0].hard = HardTruth::Dark;
    meter.add(truth, std::vector<float>{0.0f, 0.0f, 1.0f, -1.0f});
    EXPECT_EQ(meter.figures().pairs, 3u) << "the truth itself changed";
    truth.pixels[0].hard = HardTruth::Away;
    meter.add(truth, std::vector<float>{0.0f, 0.0f, 1.0f, -1.0f});
    EXPECT_EQ(meter.figures().pairs, 5u);
    EXPECT_NEAR(meter.figures().mean(), 0.1, 1e-4);
    meter.add(truth, std::vector<float>{-1.0f, 0.0f, 1.0f, -1.0f});
    EXPECT_EQ(meter.figures().pairs, 6u) << "the result does not reach the pixel";
}

}  // namespace
}  // namespace gnomon::renderer::truth_test
