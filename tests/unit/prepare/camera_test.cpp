// The frame's constants against the host's matrices: whatever a vertex's way through them gives, the shaders' way back
// from pixel and device depth must find again.

#include "unit/prepare/scenes.h"

namespace gnomon::test {
namespace {

Prepared runCamera(const Camera& camera, std::uint32_t width = 640, std::uint32_t height = 360) {
    return runOnce(camera, width, height, {});
}

Point toPoint(const gpu::vec3& v) {
    return {v.x, v.y, v.z};
}

TEST(CameraConstants, PixelAndDepthLeadBackToTheWorld) {
    for (int trial = 0; trial < 300; ++trial) {
        Random random(trial);
        const CameraSpec spec = randomCamera(random);
        const Camera camera = makeCamera(spec);
        const Prepared prepared = runCamera(camera);
        ASSERT_TRUE(prepared.result.ok()) << prepared.result.message();
        const gpu::GpuFrame& f = prepared.frame;
        EXPECT_EQ(f.flags, spec.orthographic ? gpu::kFrameOrthographicBit : 0u);
        EXPECT_EQ(f.backgroundDepth, spec.reversed ? 0.0f : 1.0f);
        const double nearTolerance = 1e-5 * spec.nearMetres + (spec.orthographic ? 1e-6 * spec.farMetres : 0);
        EXPECT_NEAR(f.zBinNearDepth, spec.nearMetres, nearTolerance);
        EXPECT_GT(dot(toPoint(f.axisZWs), unit(spec.forward)), 0.999999) << "the z axis points into the scene";
        for (int i = 0; i < 20; ++i) {
            const double depth =
                spec.nearMetres + uniform(random, 0.01, 1) * std::min(spec.farMetres - spec.nearMetres, 30.0);
            const double xPx = uniform(random, 0, 640), yPx = uniform(random, 0, 360);
            const double scale = spec.orthographic ? 1 : depth;
            const double u = xPx * f.viewXyPerPixel.x + f.viewXyAtPixel0.x;
            const double v = yPx * f.viewXyPerPixel.y + f.viewXyAtPixel0.y;
            const Point world = toPoint(f.eyeWs) + toPoint(f.axisXWs) * (u * scale) + toPoint(f.axisYWs) * (v * scale) +
                                toPoint(f.axisZWs) * depth;
            const Projected at = project(camera, world, 640, 360);
            // Positions carry float roundings of the eye's coordinates.
            const double spread = length(spec.eye) * 1e-6 / (spec.orthographic ? 1 : depth) / spec.halfHeight * 640;
            EXPECT_NEAR(at.xPx, xPx, 0.02 + spread);
            EXPECT_NEAR(at.yPx, yPx, 0.02 + spread);
            EXPECT_NEAR(at.viewDepth, depth, 1e-4 * depth + 1e-6 * length(spec.eye));
        }
    }
}

TEST(CameraConstants, DeviceDepthLeadsToViewDepth) {
    for (const bool orthographic : {false, true}) {
        for (const bool reversed : {false, true}) {
            for (const bool plusZ : {false, true}) {
                CameraSpec spec;
                spec.orthographic = orthographic, spec.reversed = reversed, spec.looksAlongPlusZ = plusZ;
                spec.nearMetres = 0.5, spec.farMetres = 80;
                const Prepared prepared = runCamera(makeCamera(spec));
                ASSERT_TRUE(prepared.result.ok()) << prepared.result.message();
                const gpu::vec2 n = prepared.frame.viewDepthNumerator, m = prepared.frame.viewDepthDenominator;
                const auto viewDepth = [&](double d) { return (n.x * d + n.y) / (m.x * d + m.y); };
                EXPECT_NEAR(viewDepth(reversed ? 1 : 0), 0.5, 1e-4);
                EXPECT_NEAR(viewDepth(reversed ? 0 : 1), 80, 0.05);
                EXPECT_GT(viewDepth(0.5), 0.5);
                EXPECT_LT(viewDepth(0.5), 80);
            }
        }
    }
}

// Some hosts write infinity as "a hair beyond": device depth then ends a little before its far value.
TEST(CameraConstants, NearlyInfiniteFarIsInfinite) {
    for (const bool reversed : {false, true}) {
        CameraSpec spec;
        spec.reversed = reversed;
        Camera camera = makeCamera(spec);
        camera.clipFromView[10] += reversed ? -1e-7f : 2e-7f;  // times -1: the view looks down -z
        Light light;
        light.position[2] = -5000, light.rangeMetres = 100;
        const Prepared prepared = runOnce(camera, 640, 360, {light});
        ASSERT_TRUE(prepared.result.ok()) << prepared.result.message();
        EXPECT_EQ(prepared.report.visible, 1u);
    }
}

TEST(CameraConstants, CountsAndExtent) {
    PrepareDesc desc;
    const auto prepare = makePrepare(desc);
    ViewInput input;
    input.camera = makeCamera({});
    input.widthPx = 1921, input.heightPx = 1081;
    input.viewportXPx = 7, input.viewportYPx = 9;
    const Prepared prepared = runPrepare(*prepare, input);
    ASSERT_TRUE(prepared.result.ok()) << prepared.result.message();
    const gpu::GpuFrame& f = prepared.frame;
    EXPECT_EQ(f.extentPx.x, 1921u);
    EXPECT_EQ(f.extentPx.y, 1081u);
    EXPECT_EQ(f.viewportPx.x, 7u);
    EXPECT_EQ(f.viewportPx.y, 9u);
    EXPECT_EQ(f.tileCounts.x, 241u);
    EXPECT_EQ(f.tileCounts.y, 136u);
    EXPECT_EQ(f.tileGroupCounts.x, 31u);
    EXPECT_EQ(f.tileGroupCounts.y, 17u);
    EXPECT_EQ(f.maskTileColumns, 61u);
    EXPECT_EQ(f.maskTileRows, 34u);
    EXPECT_EQ(prepared.masks.size(), 61u * 34u * 33u);
}

void expectRefused(const Camera& camera, const std::string& words) {
    const Prepared prepared = runCamera(camera);
    EXPECT_EQ(prepared.result.status(), Status::BadArgument);
    EXPECT_NE(std::string(prepared.result.message()).find(words), std::string::npos)
        << "got: " << prepared.result.message();
}

TEST(BadCamera, EachHasItsSentence) {
    const Camera good = makeCamera({});
    Camera c = good;
    c.viewFromWorld[0] = 1.01f;
    expectRefused(c, "not rigid");
    c = good;
    c.viewFromWorld[3] = 0.1f;
    expectRefused(c, "not rigid");
    c = good;
    c.viewFromWorld[12] = std::numeric_limits<float>::quiet_NaN();
    expectRefused(c, "viewFromWorld has a value that is not finite");
    c = good;
    for (const int i : {0, 4, 8, 12}) c.viewFromWorld[i] = -c.viewFromWorld[i];
    expectRefused(c, "mirrors");
    c = good;
    c.clipFromView[0] = std::numeric_limits<float>::infinity();
    expectRefused(c, "clipFromView has a value that is not finite");
    c = good;
    c.clipFromView[0] = 0;
    expectRefused(c, "singular");
    c = good;
    c.clipFromView[4] = 0.1f;
    expectRefused(c, "shears");
    c = good;
    c.clipFromView[12] = 0.1f;  // a perspective eye beside the eye
    expectRefused(c, "shears");
    c = good;
    c.clipFromView[2] = 0.1f;
    expectRefused(c, "oblique");
    c = good;
    c.clipFromView[3] = 0.1f;
    expectRefused(c, "last row");
    c = good;
    std::fill(c.clipFromView, c.clipFromView + 16, 0.0f);
    expectRefused(c, "last row");
    c = good;
    c.deviceDepth = DeviceDepth::StandardZ;
    expectRefused(c, "runs against");
    c = good;
    c.clipFromView[14] = 0;
    expectRefused(c, "does not change");
    c = good;
    c.clipFromView[10] = -2;  // reversed: device depth 1 is behind the eye
    c.clipFromView[14] = 0.1f;
    expectRefused(c, "near plane in front");

    CameraSpec parallel;
    parallel.orthographic = true, parallel.nearMetres = 1, parallel.farMetres = 10;
    const Camera goodParallel = makeCamera(parallel);
    EXPECT_TRUE(runCamera(goodParallel).result.ok());
    c = goodParallel;
    c.clipFromView[10] = 0;
    expectRefused(c, "singular");
    c = goodParallel;
    c.clipFromView[8] = 0.2f;
    expectRefused(c, "shears");
    parallel.nearMetres = -5;
    expectRefused(makeCamera(parallel), "behind the eye");
}

TEST(BadExtent, EachHasItsSentence) {
    PrepareDesc desc;
    desc.maxWidthPx = 100, desc.maxHeightPx = 50;
    const auto prepare = makePrepare(desc);
    ViewInput input;
    input.camera = makeCamera({});
    const auto message = [&](std::uint32_t width, std::uint32_t height) {
        input.widthPx = width, input.heightPx = height;
        return std::string(runPrepare(*prepare, input).result.message());
    };
    EXPECT_NE(message(0, 10).find("at least 1x1"), std::string::npos);
    EXPECT_NE(message(10, 0).find("at least 1x1"), std::string::npos);
    EXPECT_NE(message(101, 50).find("above the maximum"), std::string::npos);
    EXPECT_NE(message(100, 51).find("above the maximum"), std::string::npos);
    EXPECT_EQ(message(100, 50), "");
    input.widthPx = input.heightPx = 10;
    PreparedLights answer;
    ASSERT_TRUE(prepare->run(input, answer).ok());
    EXPECT_NE(std::string(prepare->write({}, 0, {}).message()).find("null pointer"), std::string::npos);
}

TEST(BadDesc, EachHasItsSentence) {
    const auto message = [](const PrepareDesc& desc) {
        std::unique_ptr<Prepare> prepare;
        const Result result = Prepare::create(desc, prepare);
        EXPECT_EQ(prepare == nullptr, !result.ok());
        return std::string(result.message());
    };
    PrepareDesc desc;
    EXPECT_EQ(message(desc), "");
    desc.maxWidthPx = 0;
    EXPECT_NE(message(desc).find("maximum extent"), std::string::npos);
    desc = {};
    desc.maxHeightPx = gpu::kMaxExtentPx + 1;
    EXPECT_NE(message(desc).find("maximum extent"), std::string::npos);
    desc = {};
    desc.rangeCutoffLux = 0;
    EXPECT_NE(message(desc).find("rangeCutoffLux"), std::string::npos);
    desc = {};
    desc.keepFactor = 0.5f;
    EXPECT_NE(message(desc).find("keepFactor"), std::string::npos);
}

}  // namespace
}  // namespace gnomon::test
