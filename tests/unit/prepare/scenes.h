#pragma once
// Cameras and lights for the tests of phase 1, a way to run it, and naive double-precision geometry to check it
// against. Nothing here uses the library's own derivations: points go through the host's matrices as a vertex would.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "gnomon/prepare.h"
#include "gpu_interface/numbers.h"
#include "gpu_interface/packing.h"
#include "gpu_interface/structs.h"

namespace gnomon::test {

using Random = std::mt19937;
inline double uniform(Random& random, double low, double high) {
    return low + (high - low) * (random() / 4294967296.0);
}

struct Point {
    double x = 0, y = 0, z = 0;
};
inline Point operator+(Point a, Point b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Point operator-(Point a, Point b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Point operator*(Point a, double s) {
    return {a.x * s, a.y * s, a.z * s};
}
inline double dot(Point a, Point b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Point cross(Point a, Point b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Point a) {
    return std::sqrt(dot(a, a));
}
inline Point unit(Point a) {
    return a * (1 / length(a));
}

inline Point randomUnit(Random& random) {
    for (;;) {
        const Point p{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
        const double l = length(p);
        if (l > 0.05 && l < 1) return p * (1 / l);
    }
}

struct CameraSpec {
    Point eye{0, 0, 0}, forward{0, 0, -1};
    bool orthographic = false, reversed = true, looksAlongPlusZ = false, flipY = true;
    double halfWidth = 1.0, halfHeight = 0.5625;  // at depth 1, or in metres
    double centreX = 0, centreY = 0;              // ndc offset: off-centre or jitter
    double nearMetres = 0.1, farMetres = std::numeric_limits<double>::infinity();
};

inline Camera makeCamera(const CameraSpec& c) {
    const double side = c.looksAlongPlusZ ? 1 : -1;
    const Point viewZ = unit(c.forward) * side;
    const Point helper = std::abs(viewZ.y) < 0.9 ? Point{0, 1, 0} : Point{1, 0, 0};
    const Point viewX = unit(cross(helper, viewZ)), viewY = cross(viewZ, viewX);
    Camera camera;
    const Point rows[3] = {viewX, viewY, viewZ};
    for (int r = 0; r < 3; ++r) {
        camera.viewFromWorld[r] = static_cast<float>(rows[r].x);
        camera.viewFromWorld[4 + r] = static_cast<float>(rows[r].y);
        camera.viewFromWorld[8 + r] = static_cast<float>(rows[r].z);
        camera.viewFromWorld[12 + r] = static_cast<float>(-dot(rows[r], c.eye));
    }
    const double n = c.nearMetres, f = c.farMetres;
    double a, b;  // perspective: device = a + b / depth; orthographic: a + b * depth
    if (c.orthographic) {
        b = (c.reversed ? -1 : 1) / (f - n);
        a = (c.reversed ? f : -n) / (f - n);
    } else if (std::isinf(f)) {
        a = c.reversed ? 0 : 1;
        b = c.reversed ? n : -n;
    } else {
        a = c.reversed ? -n / (f - n) : f / (f - n);
        b = c.reversed ? n * f / (f - n) : -n * f / (f - n);
    }
    float* p = camera.clipFromView;
    p[0] = static_cast<float>(1 / c.halfWidth);
    p[5] = static_cast<float>((c.flipY ? -1 : 1) / c.halfHeight);
    if (c.orthographic) {
        p[12] = static_cast<float>(c.centreX), p[13] = static_cast<float>(c.centreY);
        p[10] = static_cast<float>(b * side), p[14] = static_cast<float>(a), p[15] = 1;
    } else {
        p[8] = static_cast<float>(c.centreX * side), p[9] = static_cast<float>(c.centreY * side);
        p[10] = static_cast<float>(a * side), p[14] = static_cast<float>(b), p[11] = static_cast<float>(side);
    }
    camera.deviceDepth = c.reversed ? DeviceDepth::ReversedZ : DeviceDepth::StandardZ;
    return camera;
}

inline CameraSpec randomCamera(Random& random) {
    CameraSpec c;
    const double spread = random() % 4 == 0 ? 2000 : 20;
    c.eye = {uniform(random, -spread, spread), uniform(random, -spread, spread), uniform(random, -spread, spread)};
    c.forward = randomUnit(random);
    c.orthographic = random() % 3 == 0;
    c.reversed = random() % 3 != 0;
    c.looksAlongPlusZ = random() % 3 == 0;
    c.flipY = random() % 2 == 0;
    c.halfWidth = c.orthographic ? uniform(random, 2, 60) : uniform(random, 0.05, 2.5);
    c.halfHeight = c.halfWidth * uniform(random, 0.4, 1.5);
    if (random() % 2 == 0) {
        c.centreX = uniform(random, -0.002, 0.002), c.centreY = uniform(random, -0.002, 0.002);  // jitter
    } else if (random() % 2 == 0) {
        c.centreX = uniform(random, -1.5, 1.5), c.centreY = uniform(random, -0.7, 0.7);  // off-centre
    }
    c.nearMetres = c.orthographic ? uniform(random, 0, 5) : std::pow(10.0, uniform(random, -2, 0.3));
    if (c.orthographic || random() % 2 == 0) c.farMetres = c.nearMetres + std::pow(10.0, uniform(random, 1, 3.5));
    return c;
}

// A light near the camera or somewhere in front of it: some contain the eye, some cross the near plane.
inline Light randomLight(Random& random, const CameraSpec& c) {
    Light light;
    light.type = random() % 2 == 0 ? LightType::Point : LightType::Spot;
    const double reach = std::pow(10.0, uniform(random, -1, 2));
    const Point p = c.eye + unit(c.forward) * uniform(random, -0.3 * reach, reach) + randomUnit(random) * (0.5 * reach);
    light.position[0] = static_cast<float>(p.x);
    light.position[1] = static_cast<float>(p.y);
    light.position[2] = static_cast<float>(p.z);
    light.rangeMetres = static_cast<float>(std::pow(10.0, uniform(random, -1.5, 1.7)));
    const Point d = randomUnit(random) * uniform(random, 0.1, 5);
    light.direction[0] = static_cast<float>(d.x);
    light.direction[1] = static_cast<float>(d.y);
    light.direction[2] = static_cast<float>(d.z);
    light.outerConeAngle =
        static_cast<float>(random() % 3 == 0 ? uniform(random, 0.002, 0.1) : uniform(random, 0.1, 1.5707963));
    if (random() % 16 == 0) light.outerConeAngle = 1.57079637f;  // pi/2, rounded up
    return light;
}

inline Point positionOf(const Light& light) {
    return {light.position[0], light.position[1], light.position[2]};
}
inline Point directionOf(const Light& light) {
    return unit({light.direction[0], light.direction[1], light.direction[2]});
}

// A point of the light's volume, often on its surface. The cone is taken as the float cosine that the GPU has.
inline Point randomPointOf(const Light& light, Random& random) {
    Point d = randomUnit(random);
    if (light.type == LightType::Spot) {
        const Point axis = directionOf(light);
        const Point side = unit(cross(axis, std::abs(axis.x) < 0.9 ? Point{1, 0, 0} : Point{0, 1, 0}));
        const Point other = cross(axis, side);
        const double share = random() % 2 == 0 ? 1.0 : std::sqrt(uniform(random, 0, 1));
        const double angle = light.outerConeAngle * share, turn = uniform(random, 0, 6.283185307179586);
        d = axis * std::cos(angle) + (side * std::cos(turn) + other * std::sin(turn)) * std::sin(angle);
    }
    const double share = random() % 2 == 0 ? 1.0 : std::cbrt(uniform(random, 0, 1));
    return positionOf(light) + d * (light.rangeMetres * share);
}

struct Projected {
    bool onScreen = false;
    double xPx = 0, yPx = 0, viewDepth = 0, device = 0;
};

// Through the host's matrices, as a vertex goes.
inline Projected project(const Camera& camera, Point p, double widthPx, double heightPx) {
    const auto multiply = [](const float* m, const double* v, double* out) {
        for (int r = 0; r < 4; ++r) out[r] = m[r] * v[0] + m[4 + r] * v[1] + m[8 + r] * v[2] + m[12 + r] * v[3];
    };
    const double world[4] = {p.x, p.y, p.z, 1};
    double view[4], clip[4];
    multiply(camera.viewFromWorld, world, view);
    multiply(camera.clipFromView, view, clip);
    Projected out;
    if (!(clip[3] > 0)) return out;
    const double x = clip[0] / clip[3], y = clip[1] / clip[3], z = clip[2] / clip[3];
    out.xPx = (x + 1) / 2 * widthPx;
    out.yPx = (y + 1) / 2 * heightPx;
    out.viewDepth = std::abs(camera.clipFromView[15] != 0 ? view[2] : clip[3]);
    out.device = z;
    out.onScreen = out.xPx >= 0 && out.xPx < widthPx && out.yPx >= 0 && out.yPx < heightPx && z >= 0 && z <= 1;
    return out;
}

inline bool contains(const Light& light, Point p) {
    const Point d = p - positionOf(light);
    const double distance = length(d);
    if (distance > light.rangeMetres) return false;
    return light.type != LightType::Spot || dot(d, directionOf(light)) >= std::cos(light.outerConeAngle) * distance;
}

// What phase 1 answered and wrote.
struct Prepared {
    Result result;
    std::vector<LightOnScreen> answer;
    PrepareReport report;
    gpu::GpuFrame frame = {};
    std::vector<gpu::GpuLight> lights;
    std::vector<std::uint32_t> zBins, masks;

    [[nodiscard]] const std::uint32_t* entry(std::uint32_t column, std::uint32_t row) const {
        return masks.data() +
               (static_cast<std::size_t>(row) * frame.maskTileColumns + column) * gpu::kLightMaskEntryWords;
    }
    [[nodiscard]] bool maskHas(std::uint32_t column, std::uint32_t row, std::uint32_t light) const {
        const std::uint32_t* words = entry(column, row);
        return ((words[0] >> (light / 32)) & 1u) != 0 && ((words[1 + light / 32] >> (light % 32)) & 1u) != 0;
    }
    // The shader's own arithmetic, in float.
    [[nodiscard]] std::uint32_t binOf(float viewDepth) const {
        const float b = std::floor((viewDepth - frame.zBinNearDepth) * frame.zBinsPerMetre);
        return static_cast<std::uint32_t>(std::clamp(static_cast<int>(std::clamp(b, -1e6f, 1e6f)), 0, 1023));
    }
};

inline std::unique_ptr<Prepare> makePrepare(const PrepareDesc& desc) {
    std::unique_ptr<Prepare> prepare;
    const Result result = Prepare::create(desc, prepare);
    EXPECT_TRUE(result.ok()) << result.message();
    return prepare;
}

// A host's plan: views for every light that wants them, one light's after the other's.
inline std::vector<LightShadowViews> planViews(std::span<const LightOnScreen> lights, std::uint32_t cascades = 3) {
    std::vector<LightShadowViews> views(lights.size());
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (!lights[i].casts) continue;
        const std::uint32_t count = lights[i].type == LightType::Point  ? 6
                                    : lights[i].type == LightType::Spot ? 1
                                                                        : cascades;
        views[i] = {next, count};
        next += count;
    }
    return views;
}

constexpr std::uint32_t kManyViews = 1u << 20;

inline Prepared runPrepare(Prepare& prepare, const ViewInput& input) {
    Prepared out;
    const PrepareSizes sizes = prepareSizes(input.widthPx, input.heightPx);
    EXPECT_EQ(sizes.frameConstants, sizeof(out.frame));
    out.lights.resize(sizes.lights / sizeof(gpu::GpuLight));
    out.zBins.resize(sizes.zBins / 4);
    // Garbage first: everything that may be read must have been written.
    out.masks.assign(sizes.tileLightMasks / 4, 0xCDCDCDCDu);
    PreparedLights answer;
    out.result = prepare.run(input, answer);
    if (!out.result.ok()) return out;
    out.answer.assign(answer.visible.begin(), answer.visible.end());
    out.result = prepare.write(planViews(answer.visible), kManyViews,
                               {&out.frame, out.lights.data(), out.zBins.data(), out.masks.data()}, &out.report);
    if (out.result.ok()) out.lights.resize(out.report.visible);
    return out;
}

inline Prepared runOnce(const Camera& camera, std::uint32_t widthPx, std::uint32_t heightPx,
                        const std::vector<Light>& lights, PrepareDesc desc = {}) {
    desc.maxWidthPx = widthPx, desc.maxHeightPx = heightPx;
    const auto prepare = makePrepare(desc);
    ViewInput input;
    input.camera = camera;
    input.widthPx = widthPx, input.heightPx = heightPx;
    input.lights = lights;
    return runPrepare(*prepare, input);
}

}  // namespace gnomon::test
