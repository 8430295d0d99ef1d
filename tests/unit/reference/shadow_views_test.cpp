// The library's own numbers of a shadow view against the host's description of it.
#include <gtest/gtest.h>

#include "gpu_interface/numbers.h"
#include "reference/shadow_views.h"
#include "reference/test_scene.h"
#include "reference/test_shadows.h"
#include "shadow_views.h"

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
