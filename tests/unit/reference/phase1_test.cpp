// The library's phase 1 against the oracle, for every kind of camera, over random and awkward views: no light that
// meets a piece of the view may be missing there, and little else should be marked.
#include <gtest/gtest.h>

#include <cstring>

#include "gnomon/prepare.h"
#include "gpu_interface/packing.h"
#include "reference/prepare.h"
#include "reference/test_scene.h"

namespace gnomon::reference {
namespace {

struct Extent {
    std::uint32_t widthPx, heightPx;
};

/// Runs the library's phase 1 and checks all of its outputs. Returns the (marked, surplus) pairs of the tile light
/// masks.
CoverReport checkOneView(const CameraSetup& setup, Extent extent, const std::vector<Light>& host) {
    const auto [widthPx, heightPx] = extent;
    ViewInput input;
    input.camera = makeCamera(setup, widthPx, heightPx);
    input.widthPx = widthPx;
    input.heightPx = heightPx;
    input.lights = host;
    input.shadowViewCount = 6;
    const PrepareSizes sizes = prepareSizes(widthPx, heightPx);
    const auto words = [](std::size_t bytes) { return std::vector<gpu::vec4>((bytes + 15) / 16); };
    auto frameWords = words(sizes.frameConstants), lightWords = words(sizes.lights), binWords = words(sizes.zBins),
         maskWords = words(sizes.tileLightMasks);
    std::unique_ptr<Prepare> prepare;
    EXPECT_TRUE(Prepare::create({}, prepare).ok());
    PrepareReport report;
    const Result result =
        prepare->run(input, {frameWords.data(), lightWords.data(), binWords.data(), maskWords.data()}, report);
    EXPECT_TRUE(result.ok()) << result.message();
    if (!result.ok()) return {};

    gpu::GpuFrame frame;
    std::memcpy(&frame, frameWords.data(), sizeof(frame));
    std::vector<gpu::GpuLight> gpuLights(frame.lightCount);
    std::memcpy(static_cast<void*>(gpuLights.data()), lightWords.data(), gpuLights.size() * sizeof(gpu::GpuLight));
    std::vector<std::uint32_t> bins(gpu::kZBinWords), masks(sizes.tileLightMasks / 4);
    std::memcpy(bins.data(), binWords.data(), bins.size() * 4);
    std::memcpy(masks.data(), maskWords.data(), masks.size() * 4);

    const CameraModel camera = makeCameraModel(input.camera, widthPx, heightPx);
    const std::vector<LightModel> all = makeLightModels(host, camera);
    const Findings values = checkGpuLights(all, camera, gpuLights);
    EXPECT_TRUE(values.ok()) << values.text();
    const std::vector<LightModel> lights = orderLights(all, gpuLights);
    const VisibleReport visible = checkVisibleLights(all, lights, camera);
    EXPECT_TRUE(visible.findings.ok()) << visible.findings.text();
    EXPECT_EQ(report.visible, gpuLights.size());
    const CoverReport zBins = checkZBins(lights, camera, bins, frame.zBinNearDepth, frame.zBinsPerMetre);
    EXPECT_TRUE(zBins.findings.ok()) << zBins.findings.text();
    const CoverReport tiles = checkTileLightMasks(lights, camera, masks, frame.maskTileColumns, frame.maskTileRows);
    EXPECT_TRUE(tiles.findings.ok()) << tiles.findings.text();
    return tiles;
}

TEST(Phase1, EveryKindOfCamera) {
    std::size_t marked = 0, surplus = 0;
    for (const CameraSetup& setup : allCameraKinds()) {
        SCOPED_TRACE(setup.name);
        Random random(20);
        const CoverReport tiles = checkOneView(setup, {250, 130}, makeLights(random, setup, {}));
        marked += tiles.marked;
        surplus += tiles.surplus;
    }
    EXPECT_GT(marked, 200u);
    EXPECT_LT(surplus, marked / 3);
    RecordProperty("surplusPercent", static_cast<int>(100 * surplus / marked));
}

TEST(Phase1, RandomViews) {
    std::size_t marked = 0, surplus = 0;
    for (std::uint64_t seed = 100; seed < 140; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const CameraSetup setup = randomCamera(random);
        LightSetup lights;
        lights.count = 5 + random.below(60);
        lights.spotShare = random.uniform();
        lights.spreadMetres = random.uniform(1, 20);
        lights.maxOuterAngle = random.uniform(0.1, 1.54);
        const Extent extent = {1 + random.below(200), 1 + random.below(150)};
        const CoverReport tiles = checkOneView(setup, extent, makeLights(random, setup, lights));
        marked += tiles.marked;
        surplus += tiles.surplus;
    }
    EXPECT_LT(surplus, marked / 3);
    RecordProperty("surplusPercent", static_cast<int>(100 * surplus / marked));
}

}  // namespace
}  // namespace gnomon::reference
