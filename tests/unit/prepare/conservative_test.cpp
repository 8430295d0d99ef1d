// Property: whatever the camera and the lights, no point that a light reaches is lost by the masks or the zBins. And
// the opposite: masks and bins are not simply full.

#include <algorithm>

#include "unit/prepare/scenes.h"

namespace gnomon::test {
namespace {

struct Extent {
    std::uint32_t width, height;
};

// By host index.
std::vector<std::int64_t> indexOfHost(const Prepared& prepared, std::size_t lightCount) {
    std::vector<std::int64_t> index(lightCount, -1);
    for (std::size_t i = 0; i < prepared.lights.size(); ++i) index[prepared.lights[i].hostIndex] = static_cast<int>(i);
    return index;
}

void checkPoint(const Prepared& prepared, const Projected& at, std::int64_t light, Random& random) {
    ASSERT_GE(light, 0) << "a light that reaches a visible point was culled";
    const auto index = static_cast<std::uint32_t>(light);
    const auto column = static_cast<std::uint32_t>(at.xPx) / 32, row = static_cast<std::uint32_t>(at.yPx) / 32;
    ASSERT_TRUE(prepared.maskHas(column, row, index)) << "pixel " << at.xPx << ", " << at.yPx;
    const std::uint32_t bin = prepared.binOf(static_cast<float>(at.viewDepth));
    const std::uint32_t standard = prepared.zBins[bin];
    ASSERT_TRUE(gpu::zBinMin(standard) <= index && index <= gpu::zBinMax(standard)) << "depth " << at.viewDepth;
    const std::uint32_t first = random() % (bin + 1), last = bin + random() % (1024 - bin);
    ASSERT_LE(gpu::zBinMin(prepared.zBins[1024 + first]), index);
    ASSERT_GE(gpu::zBinMax(prepared.zBins[1024 + last]), index);
}

TEST(Conservative, NoReachedPointIsLost) {
    const Extent extents[] = {{1, 1}, {8, 8}, {33, 31}, {640, 360}, {1921, 1081}, {3840, 2160}, {7680, 4320}};
    int checked = 0;
    for (int trial = 0; trial < 280; ++trial) {
        Random random(1000 + trial);
        const CameraSpec spec = randomCamera(random);
        const Camera camera = makeCamera(spec);
        const Extent extent = extents[trial % std::size(extents)];
        std::vector<Light> lights;
        for (int i = 0; i < 40; ++i) lights.push_back(randomLight(random, spec));
        const Prepared prepared = runOnce(camera, extent.width, extent.height, lights);
        ASSERT_TRUE(prepared.result.ok()) << prepared.result.message();
        const auto index = indexOfHost(prepared, lights.size());
        for (std::size_t i = 0; i < lights.size(); ++i) {
            for (int sample = 0; sample < 200; ++sample) {
                const Projected at = project(camera, randomPointOf(lights[i], random), extent.width, extent.height);
                if (!at.onScreen) continue;
                ++checked;
                checkPoint(prepared, at, index[i], random);
                if (testing::Test::HasFatalFailure()) {
                    FAIL() << "trial " << trial << ", light " << i << (spec.orthographic ? ", orthographic" : "")
                           << (lights[i].type == LightType::Spot ? ", spot " : ", point ") << extent.width << "x"
                           << extent.height << " angle " << lights[i].outerConeAngle;
                }
            }
        }
    }
    EXPECT_GT(checked, 100000);
}

// Points on the image's outline are where a bound that is too tight fails: walk rays next to it.
TEST(Conservative, GrazingRaysOfABallAreKept) {
    int checked = 0;
    for (int trial = 0; trial < 60; ++trial) {
        Random random(5000 + trial);
        CameraSpec spec = randomCamera(random);
        spec.orthographic = false;
        spec.nearMetres = 0.05;
        spec.farMetres = std::numeric_limits<double>::infinity();
        const Camera camera = makeCamera(spec);
        std::vector<Light> lights;
        for (int i = 0; i < 40; ++i) {
            lights.push_back(randomLight(random, spec));
            lights.back().type = LightType::Point;
        }
        const Prepared prepared = runOnce(camera, 1920, 1080, lights);
        ASSERT_TRUE(prepared.result.ok()) << prepared.result.message();
        const auto index = indexOfHost(prepared, lights.size());
        for (std::size_t i = 0; i < lights.size(); ++i) {
            const Point c = positionOf(lights[i]) - spec.eye;
            const double distance = length(c), r = lights[i].rangeMetres * (1 - 1e-5);
            if (distance <= r) continue;
            const double sine = r / distance, cosine = std::sqrt(1 - sine * sine);
            for (int sample = 0; sample < 300; ++sample) {
                const Point across = unit(cross(c, randomUnit(random)));
                // The eye's tangent touches here.
                const Point p = positionOf(lights[i]) + unit(c) * (-r * sine) + across * (r * cosine);
                const Projected at = project(camera, p, 1920, 1080);
                if (!at.onScreen) continue;
                ++checked;
                checkPoint(prepared, at, index[i], random);
                if (testing::Test::HasFatalFailure()) FAIL() << "trial " << trial << ", light " << i;
            }
        }
    }
    EXPECT_GT(checked, 20000);
}

// The shader's own steps from a pixel's device depth to "the light reaches it", in float.
struct ShaderPixel {
    float viewDepth;
    gpu::vec3 positionWs;
};

ShaderPixel shaderPixel(const gpu::GpuFrame& f, float xPx, float yPx, float device) {
    const gpu::vec2 &n = f.viewDepthNumerator, &d = f.viewDepthDenominator;
    const float depth = (n.x * device + n.y) / (d.x * device + d.y);
    const float scale = (f.flags & gpu::kFrameOrthographicBit) != 0 ? 1.0f : depth;
    const float x = (xPx * f.viewXyPerPixel.x + f.viewXyAtPixel0.x) * scale;
    const float y = (yPx * f.viewXyPerPixel.y + f.viewXyAtPixel0.y) * scale;
    return {depth,
            {f.eyeWs.x + (f.axisXWs.x * x + f.axisYWs.x * y + f.axisZWs.x * depth),
             f.eyeWs.y + (f.axisXWs.y * x + f.axisYWs.y * y + f.axisZWs.y * depth),
             f.eyeWs.z + (f.axisXWs.z * x + f.axisYWs.z * y + f.axisZWs.z * depth)}};
}

// `light` is what phase 1 writes for a light that passes culling.
bool shaderReaches(const gpu::GpuLight& light, const gpu::vec3& p) {
    const float x = light.positionWs.x - p.x, y = light.positionWs.y - p.y, z = light.positionWs.z - p.z;
    const float squared = x * x + y * y + z * z;
    if (squared > light.rangeMetres * light.rangeMetres) return false;
    const float along = -(x * light.directionWs.x + y * light.directionWs.y + z * light.directionWs.z);
    return along >= light.cosOuter * std::sqrt(squared);
}

// The light as the GPU would have it, whether or not it is culled.
gpu::GpuLight asGpuLight(const Light& light) {
    gpu::GpuLight out = {};
    out.positionWs = {light.position[0], light.position[1], light.position[2]};
    out.rangeMetres = light.rangeMetres;
    out.cosOuter = -2;
    if (light.type == LightType::Spot) {
        const Point d = directionOf(light);
        out.directionWs = {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
        out.cosOuter = static_cast<float>(std::cos(static_cast<double>(light.outerConeAngle)));
    }
    return out;
}

// The last device depth from start towards end that the shader still calls lit.
template <class Reached>
float lastReached(float start, float end, Reached&& reached) {
    float in = start, out = end;
    for (int step = 0; step < 60 && !reached(end); ++step) {
        const float middle = in + (out - in) * 0.5f;
        (reached(middle) ? in : out) = middle;
    }
    return in;
}

// Phase 2 and 3 reserve and write by masks and zBins, so a pixel that rounding puts inside a light must be kept as
// well. Far from the origin a float step is larger than a pixel.
TEST(Conservative, NoPixelThatTheShaderLightsIsLost) {
    int checked = 0;
    for (int trial = 0; trial < 120; ++trial) {
        Random random(7000 + trial);
        CameraSpec spec = randomCamera(random);
        if (trial % 3 == 0) spec.eye = spec.eye + randomUnit(random) * 16000;
        const Camera camera = makeCamera(spec);
        std::vector<Light> lights;
        for (int i = 0; i < 30; ++i) lights.push_back(randomLight(random, spec));
        const Prepared prepared = runOnce(camera, 1921, 1081, lights);
        ASSERT_TRUE(prepared.result.ok()) << prepared.result.message();
        const auto index = indexOfHost(prepared, lights.size());
        for (std::size_t i = 0; i < lights.size(); ++i) {
            const gpu::GpuLight light = asGpuLight(lights[i]);
            for (int sample = 0; sample < 100; ++sample) {
                const Projected at = project(camera, randomPointOf(lights[i], random), 1921, 1081);
                if (!at.onScreen) continue;
                const float xPx = std::floor(static_cast<float>(at.xPx)) + 0.5f;
                const float yPx = std::floor(static_cast<float>(at.yPx)) + 0.5f;
                const auto reached = [&](float device) {
                    return shaderReaches(light, shaderPixel(prepared.frame, xPx, yPx, device).positionWs);
                };
                const auto start = static_cast<float>(at.device);
                if (!(start > 0 && start < 1) || !reached(start)) continue;
                for (const float end : {std::numeric_limits<float>::min(), 1.0f}) {
                    const float in = lastReached(start, end, reached);
                    const ShaderPixel pixel = shaderPixel(prepared.frame, xPx, yPx, in);
                    ++checked;
                    checkPoint(prepared, {true, xPx, yPx, pixel.viewDepth, in}, index[i], random);
                    if (testing::Test::HasFatalFailure()) FAIL() << "trial " << trial << ", light " << i;
                }
            }
        }
    }
    EXPECT_GT(checked, 20000);
}

// Alone, a light has bins of a few millimetres, and none of its neighbours' to hide in. Its frontmost point must be in
// them, also where float rounding of positions (16 km from the origin) or of a narrow cone's cosine moves that point.
void checkFrontmostPoint(const CameraSpec& spec, const Light& light, Random& random, int& checked) {
    const Camera camera = makeCamera(spec);
    const Prepared prepared = runOnce(camera, 2000, 1000, {light});
    ASSERT_TRUE(prepared.result.ok()) << prepared.result.message();
    const gpu::GpuLight asGpu = asGpuLight(light);
    // The pixel of the volume's frontmost point; of a cone, of the nearest of many.
    Projected best;
    if (light.type == LightType::Point) {
        const Point front = positionOf(light) - unit(spec.forward) * (light.rangeMetres * (1 - 1e-6));
        best = project(camera, front, 2000, 1000);
    }
    for (int sample = 0; sample < 3000 && light.type == LightType::Spot; ++sample) {
        const Projected at = project(camera, randomPointOf(light, random), 2000, 1000);
        if (at.onScreen && (!best.onScreen || at.viewDepth < best.viewDepth)) best = at;
    }
    if (!best.onScreen) return;
    const float xPx = std::floor(static_cast<float>(best.xPx)) + 0.5f,
                yPx = std::floor(static_cast<float>(best.yPx)) + 0.5f;
    const auto reached = [&](float device) {
        return shaderReaches(asGpu, shaderPixel(prepared.frame, xPx, yPx, device).positionWs);
    };
    // Start a little behind the frontmost point.
    for (const double step : {1e-4, 1e-3, 1e-2}) {
        const auto start = static_cast<float>(best.device + (spec.reversed ? -1 : 1) * step * best.device);
        if (!(start > 0 && start < 1) || !reached(start)) continue;
        const float in = lastReached(start, spec.reversed ? 1.0f : 0.0f, reached);
        ++checked;
        const ShaderPixel pixel = shaderPixel(prepared.frame, xPx, yPx, in);
        checkPoint(prepared, {true, xPx, yPx, pixel.viewDepth, in}, prepared.lights.empty() ? -1 : 0, random);
        return;
    }
}

TEST(Conservative, FrontmostPointFarFromTheOrigin) {
    int checked = 0;
    for (int trial = 0; trial < 400 && !testing::Test::HasFatalFailure(); ++trial) {
        Random random(trial);
        CameraSpec spec;
        spec.eye = randomUnit(random) * 16000;
        spec.forward = randomUnit(random);
        Light light;
        const Point p = spec.eye + spec.forward * uniform(random, 3, 6);
        light.position[0] = static_cast<float>(p.x);
        light.position[1] = static_cast<float>(p.y);
        light.position[2] = static_cast<float>(p.z);
        light.rangeMetres = static_cast<float>(uniform(random, 0.5, 2));
        checkFrontmostPoint(spec, light, random, checked);
    }
    EXPECT_GT(checked, 200);
}

TEST(Conservative, FrontmostPointOfNarrowCones) {
    int checked = 0;
    for (int trial = 0; trial < 400 && !testing::Test::HasFatalFailure(); ++trial) {
        Random random(trial);
        CameraSpec spec;
        spec.orthographic = true;
        spec.halfWidth = 60, spec.halfHeight = 3, spec.nearMetres = 0.1, spec.farMetres = 8;
        Light light;
        light.type = LightType::Spot;
        light.position[0] = -50, light.position[1] = static_cast<float>(uniform(random, -1, 1));
        light.position[2] = static_cast<float>(uniform(random, -5, -3));
        light.direction[0] = 1, light.direction[1] = static_cast<float>(uniform(random, -0.01, 0.01));
        light.direction[2] = static_cast<float>(uniform(random, -0.01, 0.01));
        light.rangeMetres = static_cast<float>(uniform(random, 60, 90));
        light.outerConeAngle = static_cast<float>(uniform(random, 0.0005, 0.002));
        checkFrontmostPoint(spec, light, random, checked);
    }
    EXPECT_GT(checked, 50);
}

// Does any of the tile's rays meet the light? Rays over a grid of pixels, points along each.
bool tileIsReached(const CameraSpec& spec, const Camera& camera, const Light& light, std::uint32_t column,
                   std::uint32_t row, std::uint32_t width, std::uint32_t height) {
    const Point x{camera.viewFromWorld[0], camera.viewFromWorld[4], camera.viewFromWorld[8]};
    const Point y{camera.viewFromWorld[1], camera.viewFromWorld[5], camera.viewFromWorld[9]};
    const Point forward = unit(spec.forward), c = positionOf(light);
    for (int sy = 0; sy <= 6; ++sy) {
        for (int sx = 0; sx <= 6; ++sx) {
            const double xPx = std::min<double>(column * 32 + sx * 32 / 6.0, width);
            const double yPx = std::min<double>(row * 32 + sy * 32 / 6.0, height);
            const double u = (xPx / width * 2 - 1 - spec.centreX) * spec.halfWidth;
            const double v = (yPx / height * 2 - 1 - spec.centreY) * spec.halfHeight * (spec.flipY ? -1 : 1);
            const Point origin = spec.orthographic ? spec.eye + x * u + y * v : spec.eye;
            const Point ray = spec.orthographic ? forward : x * u + y * v + forward;
            const double a = dot(ray, ray), b = dot(ray, c - origin);
            const double root = b * b - a * (dot(c - origin, c - origin) - light.rangeMetres * light.rangeMetres);
            if (root < 0) continue;
            const double t0 = std::max(spec.nearMetres, (b - std::sqrt(root)) / a);
            const double t1 = std::min(spec.farMetres, (b + std::sqrt(root)) / a);
            if (t0 > t1) continue;
            if (light.type == LightType::Point) return true;
            for (int s = 0; s <= 40; ++s) {
                if (contains(light, origin + ray * (t0 + (t1 - t0) * s / 40.0))) return true;
            }
        }
    }
    return false;
}

struct Tightness {
    double set = 0, reached = 0;
};

Tightness measureTightness(LightType type, bool orthographic, bool inFront) {
    Tightness sum;
    for (int trial = 0; trial < 8; ++trial) {
        Random random(300 + trial);
        CameraSpec spec = randomCamera(random);
        spec.orthographic = orthographic;
        spec.halfWidth = orthographic ? 30 : 1, spec.halfHeight = spec.halfWidth * 0.5625;
        spec.nearMetres = 0.1, spec.farMetres = 1000;
        spec.centreX = spec.centreY = 0.1;
        const Camera camera = makeCamera(spec);
        std::vector<Light> lights;
        for (int i = 0; i < 24; ++i) {
            Light light = randomLight(random, spec);
            light.type = type;
            const Point p = spec.eye + unit(spec.forward) * uniform(random, inFront ? 12 : -1, inFront ? 60 : 3) +
                            randomUnit(random) * uniform(random, 0, inFront ? 10 : 5);
            light.position[0] = static_cast<float>(p.x);
            light.position[1] = static_cast<float>(p.y);
            light.position[2] = static_cast<float>(p.z);
            light.rangeMetres = static_cast<float>(uniform(random, 2, 9));
            light.outerConeAngle = static_cast<float>(uniform(random, 0.1, 1.2));
            lights.push_back(light);
        }
        const Prepared prepared = runOnce(camera, 1920, 1080, lights);
        EXPECT_TRUE(prepared.result.ok()) << prepared.result.message();
        for (std::uint32_t i = 0; i < prepared.lights.size(); ++i) {
            const Light& light = lights[prepared.lights[i].hostIndex];
            for (std::uint32_t row = 0; row < prepared.frame.maskTileRows; ++row) {
                for (std::uint32_t column = 0; column < prepared.frame.maskTileColumns; ++column) {
                    const bool reached = tileIsReached(spec, camera, light, column, row, 1920, 1080);
                    const bool set = prepared.maskHas(column, row, i);
                    sum.reached += reached ? 1 : 0;
                    sum.set += set ? 1 : 0;
                    EXPECT_TRUE(set || !reached)
                        << "trial " << trial << " light " << i << " tile " << column << ", " << row;
                }
            }
        }
    }
    std::printf("  tiles set / reached: %.0f / %.0f = %.3f\n", sum.set, sum.reached, sum.set / sum.reached);
    return sum;
}

// The brute force counts too few tiles (it samples), so the least possible ratio is a little above 1.
TEST(Tight, BallsInPerspective) {
    const Tightness t = measureTightness(LightType::Point, false, true);
    EXPECT_LT(t.set, 1.02 * t.reached);
}
TEST(Tight, BallsAcrossTheNearPlane) {
    const Tightness t = measureTightness(LightType::Point, false, false);
    EXPECT_LT(t.set, 1.02 * t.reached);
}
TEST(Tight, BallsInParallelView) {
    const Tightness t = measureTightness(LightType::Point, true, true);
    EXPECT_LT(t.set, 1.02 * t.reached);
}
TEST(Tight, ConesInPerspective) {
    const Tightness t = measureTightness(LightType::Spot, false, true);
    EXPECT_LT(t.set, 1.06 * t.reached);
}
TEST(Tight, ConesAcrossTheNearPlane) {
    const Tightness t = measureTightness(LightType::Spot, false, false);
    EXPECT_LT(t.set, 1.1 * t.reached);
}
TEST(Tight, ConesInParallelView) {
    const Tightness t = measureTightness(LightType::Spot, true, true);
    EXPECT_LT(t.set, 1.06 * t.reached);
}

}  // namespace
}  // namespace gnomon::test
