// The camera model against hand-made cases, round trips over every kind of camera, and its error bound against floats.
#include <gtest/gtest.h>

#include "reference/test_scene.h"

namespace gnomon::reference {
namespace {

TEST(Camera, HandMadePerspective) {
    CameraSetup setup;
    setup.eye = {0, 0, 0};
    setup.target = {0, 0, -1};
    setup.verticalFieldOfView = kPi / 2;
    setup.nearMetres = 0.5;
    const CameraModel camera = makeCameraModel(makeCamera(setup, 100, 100), 100, 100);
    EXPECT_EQ(camera.orthographic, false);
    EXPECT_NEAR(camera.nearMetres, 0.5, 1e-7);
    EXPECT_EQ(camera.farMetres, kInfinity);
    EXPECT_NEAR(camera.maxSlope, 1.0, 1e-6);
    // Reversed, infinite: device depth = near / depth. At 10 m, 90 degrees show 20 m; the top right corner is (10, 10).
    const Vec3 p = worldFromPixel(camera, 100, 0, 0.05);
    EXPECT_NEAR(p.x, 10, 1e-5);
    EXPECT_NEAR(p.y, 10, 1e-5);
    EXPECT_NEAR(p.z, -10, 1e-5);
    EXPECT_TRUE(isBackground(camera, 0.0f));
    EXPECT_FALSE(isBackground(camera, 1e-30f));
    EXPECT_NEAR(camera.forward.z, -1, 1e-12);
}

TEST(Camera, RoundTripsForEveryKind) {
    for (const CameraSetup& setup : allCameraKinds()) {
        SCOPED_TRACE(setup.name);
        const CameraModel camera = makeCameraModel(makeCamera(setup, 321, 123), 321, 123);
        EXPECT_EQ(camera.orthographic, setup.orthographic);
        EXPECT_NEAR(camera.nearMetres, setup.nearMetres, 1e-4);
        if (setup.infiniteFar && !setup.orthographic) {
            EXPECT_EQ(camera.farMetres, kInfinity);
        } else {
            EXPECT_NEAR(camera.farMetres, setup.farMetres, 0.5);
        }
        EXPECT_NEAR(length(camera.forward - normalize(setup.target - setup.eye)), 0, 1e-6);
        for (const double depth : {0.1, 1.0, 30.0, 150.0}) {
            const Vec3 p = worldAtViewDepth(camera, 77.25, 100.5, depth);
            EXPECT_NEAR(viewDepth(camera, p), depth, 1e-9 * depth + 1e-9);
            const PixelPosition pixel = pixelFromWorld(camera, p);
            EXPECT_GT(pixel.clipW, 0);
            EXPECT_NEAR(pixel.xPx, 77.25, 1e-6);
            EXPECT_NEAR(pixel.yPx, 100.5, 1e-6);
            EXPECT_NEAR(length(worldFromPixel(camera, pixel.xPx, pixel.yPx, pixel.deviceDepth) - p), 0, 1e-6 * depth);
        }
        // Upright: the top of the picture is higher in the world.
        EXPECT_GT(worldAtViewDepth(camera, 160, 1, 5).y, worldAtViewDepth(camera, 160, 120, 5).y);
        EXPECT_GT(dot(worldAtViewDepth(camera, 320, 60, 5) - worldAtViewDepth(camera, 1, 60, 5),
                      cross(camera.forward, {0, 1, 0})),
                  0);
    }
}

// The stated error of view depth holds against the plain float formula, and is not far larger.
TEST(Camera, ViewDepthErrorBoundsFloats) {
    for (const CameraSetup& setup : allCameraKinds()) {
        SCOPED_TRACE(setup.name);
        const Camera host = makeCamera(setup, 64, 64);
        const CameraModel camera = makeCameraModel(host, 64, 64);
        const float a = host.clipFromView[10], b = host.clipFromView[14], c = host.clipFromView[11],
                    e = host.clipFromView[15];
        Random random(1);
        double worst = 0;
        for (int i = 0; i < 10000; ++i) {
            const Vec3 p = worldAtViewDepth(camera, 32, 32, std::exp(random.uniform(std::log(0.06), std::log(190.0))));
            const float d = static_cast<float>(pixelFromWorld(camera, p).deviceDepth);
            if (isBackground(camera, d)) continue;
            const float z = (d * e - b) / (a - d * c);
            const double exact = viewDepth(camera, worldFromPixel(camera, 32, 32, d));
            worst = std::max(worst, std::abs(camera.forwardSign * z - exact) / viewDepthError(camera, d));
        }
        EXPECT_LT(worst, 0.5);
        EXPECT_GT(worst, 0.001);
    }
}

TEST(Camera, ErrorGrowsWithStandardDepthFarAway) {
    CameraSetup reversed, standard;
    standard.reversed = false;
    const CameraModel a = makeCameraModel(makeCamera(reversed, 64, 64), 64, 64);
    const CameraModel b = makeCameraModel(makeCamera(standard, 64, 64), 64, 64);
    // Standard depth with a near plane of 5 cm steps by millimetres at 50 m (specification, Conventions).
    EXPECT_LT(viewDepthError(a, 0.05 / 50), 1e-3);
    EXPECT_GT(viewDepthError(b, 1 - 0.05 / 50), 1e-3);
}

TEST(Octahedral, RoundTripsWithinQuantisation) {
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 n = random.unitVector();
        std::uint16_t stored[2];
        encodeOctahedral(n, stored);
        EXPECT_LT(length(decodeOctahedral(stored[0], stored[1]) - n), 1e-4);
    }
    std::uint16_t up[2];
    encodeOctahedral({0, 0, 1}, up);
    EXPECT_EQ(up[0], 32768);  // round(0.5 * 65535)
    EXPECT_EQ(up[1], 32768);
    std::uint16_t down[2];
    encodeOctahedral({0, 0, -1}, down);
    EXPECT_LT(decodeOctahedral(down[0], down[1]).z, -0.9999);
}

}  // namespace
}  // namespace gnomon::reference
