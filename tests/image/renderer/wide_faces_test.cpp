// Cube faces that are drawn wider (FrameSettings::faceGuardTexels) change which texels taps read, not what is seen. By
// every filter the shadows are about as near to ray-traced truth as without, and near to those.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <glm/gtc/matrix_transform.hpp>

#include "image/renderer/verified.h"

namespace gnomon::renderer::image_test {
namespace {

GNOMON_IMAGE_TEST_SUITE(WideFaces);

constexpr double kMostAcneAndLeak = 0.001;
// More than without. Of the whole picture, and in the penumbra. Measured (lavapipe, SwiftShader): at most 0.0009 more
// error (hard, in small squares, whose texels grow most); RMSE from 0.026 less to 0.004 more.
constexpr double kMostErrorMore = 0.002, kMostRmseMore = 0.01;
// Between the two, and the share of pixels that differ by over 0.1. Measured: up to 0.0055, and up to 1.3 %.
constexpr double kMostMeanDifference = 0.01, kMostFar = 0.025;

struct WideCase {
    const char* name;
    Filter filter;
    std::uint32_t guardTexels;
    bool always;
};
constexpr WideCase kCases[] = {{"hard", Filter::Hard, 16, true},
                               {"pcf", Filter::Pcf, 16, false},
                               {"pcss", Filter::Pcss, 16, false},
                               {"pcss", Filter::Pcss, 64, true}};

RendererDesc descOf(const WideCase& c, std::uint32_t guardTexels) {
    RendererDesc desc = smallDesc();
    desc.frame.filters = {c.filter};
    desc.frame.shadows.pcssPresets[0] = kPcssMedium;
    desc.frame.faceGuardTexels = guardTexels;
    return desc;
}

// A lamp, a floor, and a plate between them. The edge of the plate's shadow lies on the border of two faces, 45 degrees
// off the lamp's axes, and so does its penumbra, all along.
View3d plateOverFloor() {
    View3d view = builtin("empty-plane");
    // A floor of 6 m: SwiftShader's depths of larger triangles are rough (docs/driver-ledger.md).
    for (Instance& floor : view.scene.instances)
        floor.worldFromObject = glm::scale(glm::dmat4(1.0), glm::dvec3(0.3)) * floor.worldFromObject;
    SceneLight lamp;
    lamp.position = {-1.5f, 2.5f, 0.0f};
    lamp.intensity = 120.0f;
    lamp.rangeMetres = 14.0f;
    lamp.sourceRadius = 0.2f;
    view.scene.lights = {lamp};
    Primitive plate;
    constexpr float kEdge = 0.02f;  // at 0 texels would end with the face, and rounding would choose between them
    plate.positions = {{-1.2f, 1.0f, 2.0f}, {kEdge, 1.0f, 2.0f}, {kEdge, 1.0f, -2.0f}, {-1.2f, 1.0f, -2.0f}};
    plate.normals.assign(4, {0, 1, 0});
    plate.indices = {0, 1, 2, 0, 2, 3};
    for (const glm::vec3& corner : plate.positions) plate.bounds.add(corner);
    view.scene.instances.push_back({"plate", static_cast<std::uint32_t>(view.scene.meshes.size()), glm::dmat4(1.0)});
    view.scene.meshes.push_back({"plate", {plate}});
    return view;
}

struct Differences {
    double mean = 0.0, farShare = 0.0;  // of the pixels that both judge; far: by over 0.1
};
Differences differencesOf(const std::vector<float>& a, const std::vector<float>& b) {
    Differences d;
    std::size_t counted = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (a[i] < 0.0f || b[i] < 0.0f) continue;
        const double difference = std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
        d.mean += difference;
        d.farShare += difference > 0.1 ? 1.0 : 0.0;
        ++counted;
    }
    d.mean /= static_cast<double>(std::max<std::size_t>(counted, 1));
    d.farShare /= static_cast<double>(std::max<std::size_t>(counted, 1));
    return d;
}

// Where they differ: texels are larger (at most 1.4 times as large here), and taps read other ones.
TEST_P(WideFaces, AreAsNearToTheTruth) {
    const View3d view = plateOverFloor();
    for (const WideCase& c : kCases) {
        if (!thorough() && !c.always) continue;
        SCOPED_TRACE(std::string(c.name) + ", " + std::to_string(c.guardTexels) + " texels wider");
        const bool soft = c.filter == Filter::Pcss;
        const Verified narrow = verified(device(), view, descOf(c, 0));
        const Verified wide = verified(device(), view, descOf(c, c.guardTexels));
        const Differences d = differencesOf(narrow.visibility, wide.visibility);
        const Figures &before = narrow.figures, &now = wide.figures;
        const double rmseBefore = soft ? before.penumbraRmse() : 0.0, rmse = soft ? now.penumbraRmse() : 0.0;
        std::printf(
            "[ figure   ] %s: %s, %u texels wider: error %.5f, was %.5f; acne and leak %.4f %%, was %.4f %%; penumbra "
            "RMSE %.4f, was %.4f; visibility differs by %.5f, by over 0.1 in %.3f %%\n",
            device().info().name.c_str(), c.name, c.guardTexels, now.visibilityError(), before.visibilityError(),
            100.0 * now.share(now.acne + now.leak), 100.0 * before.share(before.acne + before.leak), rmse, rmseBefore,
            d.mean, 100.0 * d.farShare);
        EXPECT_GT(now.dark, 500u);
        EXPECT_LE(now.share(now.acne + now.leak), kMostAcneAndLeak);
        EXPECT_LE(now.visibilityError(), before.visibilityError() + kMostErrorMore);
        if (soft) {
            EXPECT_GT(now.penumbraPairs, 100u);
            EXPECT_LE(rmse, rmseBefore + kMostRmseMore);
        }
        EXPECT_GT(d.mean, 0.0) << "the setting does nothing";
        EXPECT_LE(d.mean, kMostMeanDifference);
        EXPECT_LE(d.farShare, kMostFar);
    }
}

}  // namespace
}  // namespace gnomon::renderer::image_test
