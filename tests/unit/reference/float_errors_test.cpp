// The oracle's margins: the same rules in plain 32-bit floats, over random scenes, must stay within what the oracle
// calls acceptable. Otherwise a right shader would fail.
#include <gtest/gtest.h>

#include "honest_buffers.h"
#include "shadows_in_floats.h"

namespace gnomon::reference {
namespace {

F3 mad(F3 a, F3 b, float s) {
    return a + b * s;
}

/// A position as a shader would reconstruct it: pixel * scale + offset, times view depth, along float axes.
F3 positionInFloats(const CameraModel& camera, std::uint32_t x, std::uint32_t y, float depth) {
    const Mat4& c = camera.clipFromView;
    const double s = camera.forwardSign;
    const Vec3 right = transformPoint(camera.worldFromView, {1, 0, 0}) - camera.eye;
    const Vec3 up = transformPoint(camera.worldFromView, {0, 1, 0}) - camera.eye;
    const float a = float(c.m[2][2]), b = float(c.m[2][3]), cc = float(c.m[3][2]), e = float(c.m[3][3]);
    const float viewDepthMetres = float(s) * (depth * e - b) / (a - depth * cc);
    // ndc = (m00 vx + m02 vz (+ m03)) / w, with vz = s at depth 1 for perspective.
    const double shiftX = camera.orthographic ? c.m[0][3] : c.m[0][2] * s,
                 shiftY = camera.orthographic ? c.m[1][3] : c.m[1][2] * s;
    const float scaleX = float(2.0 / camera.widthPx / c.m[0][0]), offsetX = float((-1.0 - shiftX) / c.m[0][0]);
    const float scaleY = float(2.0 / camera.heightPx / c.m[1][1]), offsetY = float((-1.0 - shiftY) / c.m[1][1]);
    float vx = (float(x) + 0.5f) * scaleX + offsetX, vy = (float(y) + 0.5f) * scaleY + offsetY;
    if (!camera.orthographic) {
        vx *= viewDepthMetres;
        vy *= viewDepthMetres;
    }
    return mad(mad(mad(f3(camera.eye), f3(right), vx), f3(up), vy), f3(camera.forward), viewDepthMetres);
}

bool reachesInFloats(const LightModel& light, const Pixel& pixel, F3 position) {
    if (pixel.background || (light.mask & pixel.receiverMask) == 0) return false;
    if (light.type != LightType::Directional) {
        const F3 v = position - f3(light.position);
        const float squared = dot(v, v), range = float(light.rangeMetres);
        if (squared > range * range) return false;
        if (light.type == LightType::Spot &&
            dot(v, f3(light.direction)) < float(std::cos(light.outerAngle)) * std::sqrt(squared))
            return false;
    }
    if (!light.casts || light.shadowFades || pixel.subsurface) return true;
    const F3 to = light.type == LightType::Directional ? f3(-light.direction) : f3(light.position) - position;
    return dot(f3(pixel.faceNormal), to) > 0;
}

struct Totals {
    std::size_t pairs = 0, may = 0, shadowPairs = 0, ambiguous = 0, loose = 0, partial = 0;
};

void compareFrame(TestFrame& frame, Totals& totals) {
    for (std::uint32_t y = 0; y < frame.grid.heightPx; ++y) {
        for (std::uint32_t x = 0; x < frame.grid.widthPx; ++x) {
            const Pixel& pixel = frame.grid.at(x, y);
            if (pixel.background) continue;
            const F3 p = positionInFloats(frame.model, x, y, frame.receivers.depth[y * frame.grid.widthPx + x]);
            ASSERT_LE(length(Vec3{p.x, p.y, p.z} - pixel.position), pixel.positionError) << frame.setup.name;
            for (const LightModel& light : frame.lights) {
                const Verdict verdict = reaches(light, pixel, true);
                const bool reached = reachesInFloats(light, pixel, p);
                ++totals.pairs;
                totals.may += verdict == Verdict::May;
                ASSERT_TRUE(verdict == Verdict::May || reached == (verdict == Verdict::Must)) << frame.setup.name;
                if (!light.casts || inInfluence(light, pixel) == Verdict::Never) continue;
                const StoredVisibility stored = storedVisibility(light, pixel, frame.shadows);
                const int q = storedInFloats(light, pixel, p, f3(frame.model.eye), frame.shadows);
                ++totals.shadowPairs;
                totals.ambiguous += stored.ambiguous();
                totals.loose += stored.max - stored.min > 1;
                totals.partial += q > 0 && q < frame.shadows.levels();
                ASSERT_TRUE(stored.holds(q)) << frame.setup.name << " light " << light.hostIndex << " pixel " << x
                                             << ' ' << y << ": " << q << " not in " << stored.min << ' ' << stored.max;
            }
        }
    }
}

constexpr PcssTapCounts kOtherTaps = {5, 7};

/// Each light another of the filters, and soft ones one of two presets where there are several filters.
void takeTurns(std::vector<LightModel>& lights, FilterSet set) {
    std::vector<Filter> filters;
    for (const Filter filter : {Filter::Hard, Filter::Pcf, Filter::Pcss})
        if ((set & only(filter)) != 0) filters.push_back(filter);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        lights[i].filter = filters[i % filters.size()];
        lights[i].pcssPreset = filters.size() > 1 ? i / filters.size() % 2 : 0;
    }
}

struct FilterCase {
    FilterSet filters;  // the lights take turns
    int pcfRadius;
    PcssTapCounts taps;
    std::uint32_t visibilityBits;
    double mostAmbiguous, mostLoose;  // shares of (pixel, light) pairs
    BiasMode bias = BiasMode::Oriented;
    bool facedAwayIsDark = true;
};

TEST(FloatErrors, PlainFloatsStayWithinTheMargins) {
    // Most of what is left are cameras with standard Z, whose far pixels are known to no better than the bias.
    const FilterCase cases[] = {{only(Filter::Hard), 1, {}, 8, 0.03, 0.03},
                                {only(Filter::Pcf), 1, {}, 8, 0.04, 0.03},
                                {only(Filter::Pcf), 2, {}, 8, 0.04, 0.03},
                                {only(Filter::Pcf), 3, {}, 8, 0.04, 0.03},
                                {only(Filter::Pcss), 1, {16, 24}, 8, 0.04, 0.03},
                                {only(Filter::Pcss), 1, {8, 12}, 8, 0.04, 0.03},
                                {only(Filter::Pcss), 1, {1, 1}, 4, 0.03, 0.03},
                                {only(Filter::Pcss), 1, {32, 64}, 4, 0.03, 0.03},
                                {only(Filter::Hard), 1, {}, 8, 0.03, 0.03, BiasMode::Oriented, false},
                                {only(Filter::Pcf), 1, {}, 8, 0.1, 0.1, BiasMode::OrientedConstant, false},
                                {only(Filter::Hard), 1, {}, 8, 0.5, 0.5, BiasMode::Unbiased, true},
                                {kAllBuiltInFilters, 2, {16, 24}, 8, 0.04, 0.03},
                                {kAllBuiltInFilters, 1, {32, 64}, 4, 0.04, 0.03}};
    for (const FilterCase& filter : cases) {
        Totals totals;
        for (std::uint64_t seed = 200; seed < 220; ++seed) {
            TestFrame frame = makeTestFrame(seed, 40, 32, 25, nullptr, seed % 4);
            takeTurns(frame.lights, filter.filters);
            frame.shadows.pcfRadius = filter.pcfRadius;
            frame.shadows.pcssPresets = {filter.taps, kOtherTaps, filter.taps, kOtherTaps};
            frame.shadows.visibilityBits = filter.visibilityBits;
            frame.shadows.bias = filter.bias;
            frame.shadows.facedAwayIsDark = filter.facedAwayIsDark;
            frame.shadows.patternTurn = static_cast<std::uint32_t>(seed) * 2654435769u;
            compareFrame(frame, totals);
            if (HasFatalFailure()) return;
        }
        EXPECT_GT(totals.shadowPairs, 20000u);
        EXPECT_GT(totals.partial, totals.shadowPairs / 50);  // between dark and lit
        // The margins are not so wide that they hide errors.
        EXPECT_LT(totals.may, totals.pairs / 500);
        EXPECT_LT(totals.ambiguous, totals.shadowPairs * filter.mostAmbiguous);
        EXPECT_LT(totals.loose, totals.shadowPairs * filter.mostLoose);
        std::printf("may %.4f %%, partial %.3f %%, ambiguous %.3f %%, by more than one step %.3f %%\n",
                    100.0 * totals.may / totals.pairs, 100.0 * totals.partial / totals.shadowPairs,
                    100.0 * totals.ambiguous / totals.shadowPairs, 100.0 * totals.loose / totals.shadowPairs);
    }
}

}  // namespace
}  // namespace gnomon::reference
