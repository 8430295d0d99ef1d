// The library's own numbers of a shadow view against the host's description of it.
#include <gtest/gtest.h>

#include "gpu_interface/numbers.h"
#include "reference/shadow_views.h"
#include "reference/test_scene.h"
#include "reference/test_shadows.h"
#include "visibility/shadow_views.h"

namespace gnomon::reference {
namespace {

struct Converted {
    TestShadows shadows;
    std::vector<gpu::GpuShadowView> gpuViews;
    explicit Converted(const ShadowSetup& setup) {
        Random random(6);
        std::vector<Light> lights = makeLights(random, {}, {.count = 20, .castingShare = 1, .suns = 4});
        shadows = buildShadows({plane({0, 0, 0}, {0, 1, 0})}, lights, setup);
        std::vector<ShadowAtlas> atlases;
        for (const AtlasCopy& atlas : shadows.atlases)
            atlases.push_back({VK_NULL_HANDLE, atlas.widthPx, atlas.heightPx, atlas.layers});
        gpuViews.resize(shadows.views.size());
        const Result result = convertShadowViews(shadows.views, atlases, gpuViews.data());
        EXPECT_TRUE(result.ok()) << result.message();
    }
    [[nodiscard]] Findings check() const { return checkShadowViews(shadows.views, gpuViews); }
};

TEST(ShadowViews, LibraryAgrees) {
    for (const bool infinite : {true, false}) {
        const Converted converted({.viewSizePx = 9, .mixDepthKinds = true, .infiniteFar = infinite});
        EXPECT_GT(converted.gpuViews.size(), 40u);
        EXPECT_TRUE(converted.check().ok()) << converted.check().text();
    }
}

// The coefficients of planes, by points of a plane that are projected.
TEST(ShadowViews, PlanesSlopeAsTheirPointsDo) {
    const Converted converted({.viewSizePx = 64, .mixDepthKinds = true, .infiniteFar = false});
    const std::vector<ShadowViewModel> models = makeShadowViewModels(converted.shadows.views);
    Random random(3);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < models.size(); ++i) {
        const ShadowViewModel& model = models[i];
        const gpu::GpuShadowView& view = converted.gpuViews[i];
        const Mat4 worldFromClip = inverse(model.clipFromWorld);
        const double z = random.uniform(1.0, 3.0), w = model.orthographic ? 1.0 : z;
        const double device =
            model.orthographic ? model.depth.a + model.depth.b * z : model.depth.a + model.depth.b / z;
        const double x = random.uniform(-0.8, 0.8), y = random.uniform(-0.8, 0.8);
        const Vec4 h = worldFromClip * Vec4{x * w, y * w, device * w, w};
        const Vec3 p = {h.x / h.w, h.y / h.w, h.z / h.w};
        const Vec3 n = normalize(Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
        const auto coefficient = [&](const gpu::vec3& c) { return n.x * c.x + n.y * c.y + n.z * c.z; };
        const double mx = coefficient(view.planeX), my = coefficient(view.planeY), mz = coefficient(view.planeZ);
        const double k = model.orthographic ? mz : mx * x + my * y + mz;
        if (std::abs(k) < 0.2) continue;
        ++compared;
        const double inverseK = 1.0 / (model.orthographic ? k : k * z);
        const double slopeX = mx * view.planeSlopePerPxX * inverseK, slopeY = my * view.planeSlopePerPxY * inverseK;
        const auto deviceAt = [&](Vec3 q, double& px, double& py) {
            const ShadowPosition at = project(model, q, 0.0);
            px = at.xPx, py = at.yPx;
            return model.orthographic ? model.depth.a + model.depth.b * at.linearDepth
                                      : model.depth.a + model.depth.b / at.linearDepth;
        };
        const Vec3 along = normalize(cross(n, std::abs(n.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{1, 0, 0}));
        for (const Vec3 aside : {along, cross(n, along)}) {
            double px0 = 0, py0 = 0, px1 = 0, py1 = 0;
            const double before = deviceAt(p, px0, py0), after = deviceAt(p + aside * 0.01, px1, py1);
            const double expected = slopeX * (px1 - px0) + slopeY * (py1 - py0);
            EXPECT_NEAR(after - before, expected, 1e-4 * std::abs(after - before) + 1e-9) << "view " << i;
        }
    }
    EXPECT_GT(compared, models.size() / 2);
}

TEST(ShadowViews, DifferencesAreFound) {
    const Converted honest({.viewSizePx = 9});
    const auto errorsAfter = [&](auto change) {
        Converted spoilt = honest;
        change(spoilt.gpuViews[3]);
        return spoilt.check().errors;
    };
    EXPECT_EQ(errorsAfter([](gpu::GpuShadowView&) {}), 0u);
    EXPECT_EQ(errorsAfter([](gpu::GpuShadowView& v) { v.clipFromWorld.column[1].z += 1e-3f; }), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuShadowView& v) { v.pxPerMetre.y *= 1.001f; }), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuShadowView& v) { v.rectMaxPx.x += 1; }), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuShadowView& v) { v.depthFromLinearB *= 1.001f; }), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuShadowView& v) { v.flags ^= gpu::kShadowViewReversedZBit; }), 1u);
    EXPECT_EQ(errorsAfter([](gpu::GpuShadowView& v) { v.atlasAndLayer ^= 1; }), 1u);
}

}  // namespace
}  // namespace gnomon::reference
