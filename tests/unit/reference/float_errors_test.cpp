// The oracle's margins: the same rules in plain 32-bit floats, over random scenes, must stay within what the oracle
// calls acceptable. Otherwise a right shader would fail.
#include <gtest/gtest.h>

#include "honest_buffers.h"

namespace gnomon::reference {
namespace {

struct F3 {
    float x, y, z;
};
F3 f3(Vec3 v) {
    return {float(v.x), float(v.y), float(v.z)};
}
F3 sub(F3 a, F3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
F3 mad(F3 a, F3 b, float s) {
    return {a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
}
float dotF(F3 a, F3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
float lengthF(F3 a) {
    return std::sqrt(dotF(a, a));
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
        const F3 v = sub(position, f3(light.position));
        const float squared = dotF(v, v), range = float(light.rangeMetres);
        if (squared > range * range) return false;
        if (light.type == LightType::Spot &&
            dotF(v, f3(light.direction)) < float(std::cos(light.outerAngle)) * std::sqrt(squared))
            return false;
    }
    if (!light.casts || light.shadowFade < 1.0 || pixel.subsurface) return true;
    const F3 to = light.type == LightType::Directional ? f3(-light.direction) : sub(f3(light.position), position);
    return dotF(f3(pixel.faceNormal), to) > 0;
}

struct F4 {
    float x, y, z, w;
};
F4 projectInFloats(const ShadowViewModel& view, F3 p) {
    float out[4];
    for (int row = 0; row < 4; ++row) {
        const auto& m = view.clipFromWorld.m[row];
        out[row] = float(m[0]) * p.x + float(m[1]) * p.y + float(m[2]) * p.z + float(m[3]);
    }
    return {out[0], out[1], out[2], out[3]};
}

float filterInFloats(const ShadowInput& input, const ShadowViewModel& view, float px, float py, float device) {
    const AtlasCopy& atlas = input.atlases[view.atlas];
    const auto lit = [&](int x, int y) {
        x = std::clamp(x, view.xPx, view.xPx + view.widthPx - 1);
        y = std::clamp(y, view.yPx, view.yPx + view.heightPx - 1);
        const float stored = atlas.at(view.layer, x, y);
        return (view.reversed ? stored <= device : stored >= device) ? 1.0f : 0.0f;
    };
    if (input.filter == ShadowFilter::Hard) return lit(int(std::floor(px)), int(std::floor(py)));
    const int r = input.pcfRadius;
    const auto clampPx = [&](float p, int first, int size) {
        return std::clamp(p, first + r + 1.0f, first + size - r - 1.0f) - 0.5f;
    };
    px = clampPx(px, view.xPx, view.widthPx);
    py = clampPx(py, view.yPx, view.heightPx);
    const float bx = std::floor(px), by = std::floor(py), fx = px - bx, fy = py - by;
    float sum = 0;
    for (int j = -r; j <= r; ++j)
        for (int i = -r; i <= r; ++i) {  // bilinear comparisons, one by one
            const int x = int(bx) + i, y = int(by) + j;
            const float top = lit(x, y) * (1 - fx) + lit(x + 1, y) * fx;
            const float bottom = lit(x, y + 1) * (1 - fx) + lit(x + 1, y + 1) * fx;
            sum += top * (1 - fy) + bottom * fy;
        }
    return sum / float((2 * r + 1) * (2 * r + 1));
}

float visibilityInFloats(const LightModel& light, const Pixel& pixel, F3 p, const ShadowInput& input) {
    const F3 to = sub(f3(light.position), p), n = f3(pixel.faceNormal);
    const float c = dotF(n, to) / lengthF(to);
    if (!pixel.subsurface && c <= 0) return 0;
    std::uint32_t face = 0;
    if (light.type == LightType::Point) {
        const F3 v = {-to.x, -to.y, -to.z};
        const float ax = std::abs(v.x), ay = std::abs(v.y), az = std::abs(v.z);
        face = ax >= ay && ax >= az ? (v.x >= 0 ? 0 : 1) : ay >= az ? (v.y >= 0 ? 2 : 3) : (v.z >= 0 ? 4 : 5);
    }
    const ShadowViewModel& view = input.views[light.firstShadowView + face];
    const float radius = input.filter == ShadowFilter::Pcf ? float(input.pcfRadius) : 0.0f;
    const float texel = float(view.texelMetres) * projectInFloats(view, p).w;
    const F3 axisX = f3(rowOf(view.clipFromWorld, 0)), axisY = f3(rowOf(view.clipFromWorld, 1));
    const float slant = std::abs(dotF(n, axisX)) / lengthF(axisX) + std::abs(dotF(n, axisY)) / lengthF(axisY);
    const float offset = texel * (radius + 1.0f) * std::max(slant, 0.1f) * (c >= 0 ? 1.0f : -1.0f);
    const F4 clip = projectInFloats(view, mad(p, n, offset));
    if (clip.w <= 0) return 1;
    float bias = float(light.biasMetres);
    if (pixel.subsurface) bias = std::max(bias, float(input.subsurfaceBiasMetres));
    float device = float(view.depth.a) + float(view.depth.b) / std::max(clip.w - bias, 1e-4f);
    const float slack = 1e-6f * (std::abs(float(view.depth.a)) + std::abs(device - float(view.depth.a)));
    device += view.reversed ? slack : -slack;
    const float px = clip.x / clip.w * (0.5f * view.widthPx) + (view.xPx + 0.5f * view.widthPx);
    const float py = clip.y / clip.w * (0.5f * view.heightPx) + (view.yPx + 0.5f * view.heightPx);
    return filterInFloats(input, view, px, py, device);
}

struct Totals {
    std::size_t pairs = 0, may = 0, shadowPairs = 0, ambiguous = 0, loose = 0;
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
                const float v = visibilityInFloats(light, pixel, p, frame.shadows);
                const float faded = 1.0f - float(light.shadowFade) * (1.0f - v);
                const int q = int(std::floor(255.0f * std::sqrt(std::clamp(faded, 0.0f, 1.0f)) + 0.5f));
                ++totals.shadowPairs;
                totals.ambiguous += stored.ambiguous();
                totals.loose += stored.max - stored.min > 1;
                ASSERT_TRUE(stored.holds(q)) << frame.setup.name << " light " << light.hostIndex << " pixel " << x
                                             << ' ' << y << ": " << q << " not in " << stored.min << ' ' << stored.max;
            }
        }
    }
}

TEST(FloatErrors, PlainFloatsStayWithinTheMargins) {
    for (const ShadowFilter filter : {ShadowFilter::Hard, ShadowFilter::Pcf}) {
        for (int radius = 1; radius <= (filter == ShadowFilter::Pcf ? 3 : 1); ++radius) {
            Totals totals;
            for (std::uint64_t seed = 200; seed < 230; ++seed) {
                TestFrame frame = makeTestFrame(seed, 48, 40, 25);
                frame.shadows.filter = filter;
                frame.shadows.pcfRadius = radius;
                compareFrame(frame, totals);
                if (HasFatalFailure()) return;
            }
            EXPECT_GT(totals.shadowPairs, 20000u);
            // The margins are not so wide that they hide errors.
            EXPECT_LT(totals.may, totals.pairs / 500);
            // Most of what is left are cameras with standard Z, whose far pixels are known to no better than the bias.
            EXPECT_LT(totals.ambiguous, totals.shadowPairs / 10);
            EXPECT_LT(totals.loose, totals.shadowPairs / 12);
            std::printf("radius %d: may %.4f %%, ambiguous %.3f %%, by more than one step %.3f %%\n", radius,
                        100.0 * totals.may / totals.pairs, 100.0 * totals.ambiguous / totals.shadowPairs,
                        100.0 * totals.loose / totals.shadowPairs);
        }
    }
}

}  // namespace
}  // namespace gnomon::reference
