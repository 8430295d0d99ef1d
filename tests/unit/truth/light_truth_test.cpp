// Soft truth against closed forms, and figures that tell planted errors.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "renderer/truth/flicker.h"
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
    Figures judged(const std::vector<float>& result) const {
        return figuresOf(traceLight(*traced, seen.receivers, seen.extent, desc, result), result, seen.extent, desc.soft)
            .opaque;
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
    const LightFigures f =
        figuresOf(traceLight(*traced, seen.receivers, seen.extent, desc, result), result, seen.extent, false);
    EXPECT_EQ(f.opaque.pairs, 0u);
    EXPECT_GT(f.subsurface.pairs, 5000u);
    EXPECT_EQ(f.subsurface.away, 0u);
}

TEST_F(PlantedErrors, PenumbraeAreMeasured) {
    desc.soft = true;
    desc.subsetOf = 1;
    std::vector<float> result = biased(0.0);
    const std::vector<PixelTruth> truth = traceLight(*traced, seen.receivers, seen.extent, desc, result);
    for (std::size_t i = 0; i < result.size(); ++i)
        if (truth[i].hard != HardTruth::NotCounted) result[i] = truth[i].soft;
    const Figures same = figuresOf(truth, result, seen.extent, true).opaque;
    EXPECT_GT(same.penumbraPairs, 300u);
    EXPECT_EQ(same.penumbraRmse(), 0.0);
    EXPECT_NEAR(same.penumbraSsim(), 1.0, 1e-6);
    for (std::size_t i = 0; i < result.size(); ++i)
        if (truth[i].hard != HardTruth::NotCounted) result[i] += 0.1f;
    const Figures off = figuresOf(truth, result, seen.extent, true).opaque;
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
    const std::vector<PixelTruth> once = traceLight(*traced, seen.receivers, seen.extent, desc, result);
    const std::vector<PixelTruth> again = traceLight(*traced, seen.receivers, seen.extent, desc, result);
    std::size_t counted = 0, chosen = 0;
    for (std::size_t i = 0; i < once.size(); ++i) {
        counted += once[i].hard != HardTruth::NotCounted;
        chosen += once[i].subset;
        ASSERT_EQ(once[i].subset, again[i].subset);
        ASSERT_TRUE(once[i].soft == again[i].soft || (std::isnan(once[i].soft) && std::isnan(again[i].soft)));
    }
    EXPECT_NEAR(static_cast<double>(chosen) / static_cast<double>(counted), 1.0 / 16.0, 0.03);
}

TEST(Flicker, CountsChangeWhereNothingChanges) {
    std::vector<PixelTruth> truth(4);
    truth[0].hard = truth[1].hard = truth[2].hard = HardTruth::Lit;
    truth[1].edge = true;
    FlickerMeter meter;
    meter.add(truth, std::vector<float>{1.0f, 1.0f, 1.0f, -1.0f});
    EXPECT_EQ(meter.figures().pairs, 0u);
    meter.add(truth, std::vector<float>{0.5f, 0.0f, 1.0f, -1.0f});
    EXPECT_EQ(meter.figures().pairs, 2u) << "no edge, no background";
    EXPECT_NEAR(meter.figures().mean(), 0.25, 1e-4);
    truth[0].hard = HardTruth::Dark;
    meter.add(truth, std::vector<float>{0.0f, 0.0f, 1.0f, -1.0f});
    EXPECT_EQ(meter.figures().pairs, 3u) << "the truth itself changed";
    truth[0].hard = HardTruth::Away;
    meter.add(truth, std::vector<float>{0.0f, 0.0f, 1.0f, -1.0f});
    EXPECT_EQ(meter.figures().pairs, 5u);
    EXPECT_NEAR(meter.figures().mean(), 0.1, 1e-4);
}

}  // namespace
}  // namespace gnomon::renderer::truth_test
