// The pass of the shadow bounds: every block of every level against the atlas; phase 4 has the same bits with and
// without.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "checks.h"
#include "scenes.h"

namespace gnomon::test {
namespace {

class ShadowBoundsTest : public GpuTest {};
GNOMON_ON_EVERY_DEVICE(ShadowBoundsTest);

/// Noise at some places and a slope at others, so that neighbouring blocks differ.
reference::AtlasCopy randomAtlas(std::mt19937& random, std::uint32_t width, std::uint32_t height,
                                 std::uint32_t layers) {
    reference::AtlasCopy atlas;
    atlas.widthPx = width, atlas.heightPx = height, atlas.layers = layers;
    std::uniform_real_distribution<float> unit;
    atlas.depth.resize(std::size_t(width) * height * layers);
    for (std::size_t i = 0; i < atlas.depth.size(); ++i)
        atlas.depth[i] = i / 97 % 3 == 0 ? unit(random) : 0.25f + 0.5f * float(i) / float(atlas.depth.size());
    return atlas;
}

ShadowView viewAt(std::uint32_t atlas, std::uint32_t layer, std::uint32_t x, std::uint32_t y, std::uint32_t width,
                  std::uint32_t height) {
    ShadowView view = reference::makeShadowView({0, 5, 0}, {0, -1, 0}, {1, 0, 0}, 1.0, 0.1, 10.0, false, true);
    view.atlas = atlas, view.layer = layer;
    view.xPx = x, view.yPx = y, view.widthPx = width, view.heightPx = height;
    return view;
}

/// Of a block, by the CPU. Beyond the atlas its last texels are repeated.
gpu::vec2 boundsOf(const reference::AtlasCopy& atlas, std::uint32_t layer, std::uint32_t x0, std::uint32_t y0,
                   std::uint32_t size) {
    gpu::vec2 out{1.0f, 0.0f};
    for (std::uint32_t y = y0; y < y0 + size; ++y)
        for (std::uint32_t x = x0; x < x0 + size; ++x) {
            const std::size_t row = std::size_t(layer) * atlas.heightPx + std::min(y, atlas.heightPx - 1);
            const float d = atlas.depth[row * atlas.widthPx + std::min(x, atlas.widthPx - 1)];
            out = {std::min(out.x, d), std::max(out.y, d)};
        }
    return out;
}

bool touches(const std::vector<ShadowView>& views, std::uint32_t atlas, std::uint32_t layer, std::uint32_t cellX,
             std::uint32_t cellY) {
    const std::uint32_t size = gpu::kShadowBoundsCellPx;
    return std::ranges::any_of(views, [&](const ShadowView& v) {
        return v.atlas == atlas && v.layer == layer && v.xPx < (cellX + 1) * size && v.xPx + v.widthPx > cellX * size &&
               v.yPx < (cellY + 1) * size && v.yPx + v.heightPx > cellY * size;
    });
}

struct Compared {
    std::size_t equal = 0, different = 0, untouched = 0, written = 0;
};

/// All cells of all atlases: those that a view touches must hold their bounds, all others what the buffer was filled
/// with.
Compared compareAll(const reference::TestShadows& shadows, const FrameResult& result) {
    Compared found;
    std::uint32_t firstCell = 0;
    for (std::uint32_t a = 0; a < shadows.atlases.size(); ++a) {
        const reference::AtlasCopy& atlas = shadows.atlases[a];
        const std::uint32_t columns = gpu::divideRoundingUp(atlas.widthPx, gpu::kShadowBoundsCellPx);
        const std::uint32_t rows = gpu::divideRoundingUp(atlas.heightPx, gpu::kShadowBoundsCellPx);
        const std::uint32_t blocks = columns * rows * gpu::kShadowBoundsCellBlocks * gpu::kShadowBoundsCellBlocks;
        for (std::uint32_t layer = 0; layer < atlas.layers; ++layer, firstCell += columns * rows)
            for (std::uint32_t level = 0; level < gpu::kShadowBoundsLevels; ++level) {
                const std::uint32_t across = gpu::kShadowBoundsCellBlocks >> level;
                const std::uint32_t size = gpu::kShadowBoundsBlockPx << level;
                for (std::uint32_t y = 0; y < rows * across; ++y)
                    for (std::uint32_t x = 0; x < columns * across; ++x) {
                        const std::size_t at = std::size_t(firstCell) * gpu::kShadowBoundsCellEntries +
                                               gpu::shadowBoundsLevelOffset(blocks, level) + y * columns * across + x;
                        const gpu::vec2 there = result.shadowBounds.at(at);
                        std::uint32_t bits[2];
                        std::memcpy(bits, &there, sizeof(bits));
                        if (!touches(shadows.views, a, layer, x / across, y / across)) {
                            ++(bits[0] == kCanary && bits[1] == kCanary ? found.untouched : found.written);
                            continue;
                        }
                        const gpu::vec2 expected = boundsOf(atlas, layer, x * size, y * size, size);
                        ++(there.x == expected.x && there.y == expected.y ? found.equal : found.different);
                    }
            }
    }
    return found;
}

TEST_P(ShadowBoundsTest, EveryBlockOfEveryLevel) {
    std::mt19937 random(5);
    auto shadows = std::make_shared<reference::TestShadows>();
    // Sides that are no multiple of a cell, a block or two; several layers.
    shadows->atlases = {randomAtlas(random, 600, 300, 2), randomAtlas(random, 256, 512, 1),
                        randomAtlas(random, 77, 1025, 1), randomAtlas(random, 8, 8, 3)};
    shadows->views = {viewAt(0, 0, 0, 0, 64, 64),    viewAt(0, 1, 250, 40, 20, 8),   viewAt(0, 1, 590, 290, 10, 10),
                      viewAt(1, 0, 100, 300, 90, 9), viewAt(2, 0, 60, 1000, 17, 25), viewAt(2, 0, 0, 10, 77, 500),
                      viewAt(3, 2, 0, 0, 8, 8)};
    FrameInput input = makeRoomFrame({.seed = 3, .widthPx = 16, .heightPx = 16});
    input.lights.clear();
    input.shadows = shadows;
    input.settings.shadowBounds = true;
    useFilter(input, Filter::Pcss);
    Rig rig(device(), {}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    const FrameResult result = rig.run(input);
    EXPECT_EQ(result.brokenGuards, 0u);
    const Compared found = compareAll(*shadows, result);
    EXPECT_EQ(found.different, 0u);
    EXPECT_EQ(found.written, 0u) << "cells without a view were made";
    EXPECT_EQ(found.equal, 341u * 10);
    EXPECT_EQ(found.untouched, 341u * 12);
    // What is kept is not made again, but for views that have changed.
    input.shadowViewsChanged = false;
    EXPECT_EQ(compareAll(*shadows, rig.run(input)).different, 0u);
    const auto madeBounds = [](const FrameResult& frame) {
        return std::ranges::any_of(frame.rows, [](const TimelineRow& row) { return row.phase == Phase::ShadowBounds; });
    };
    EXPECT_EQ(madeBounds(result), rig.timeline().records());
    EXPECT_FALSE(madeBounds(rig.run(input)));
}

// A frame with larger atlases than the view has bounds for does without them.
TEST_P(ShadowBoundsTest, AtlasesThatDoNotFit) {
    RoomSetup setup{.seed = 14, .widthPx = 40, .heightPx = 32};
    setup.lights.castingShare = 1;
    setup.lights.filters = only(Filter::Pcss);
    FrameInput input = makeRoomFrame(setup);
    ViewDesc desc = viewDescFor(input);
    Rig whole(device(), {}, desc);
    desc.shadowBoundsTexels -= 1;  // one cell fewer
    desc.shadowBoundsTexels -= desc.shadowBoundsTexels % 65536;
    Rig less(device(), {}, desc);
    desc.shadowBoundsTexels = 0;
    Rig none(device(), {}, desc);
    ASSERT_TRUE(whole.ok() && less.ok() && none.ok());
    const auto expected = decodeFinalLists(whole.run(input));
    input.settings.shadowBounds = true;
    for (Rig* rig : {&whole, &less, &none}) {
        EXPECT_EQ(decodeFinalLists(rig->run(input)), expected);
        input.shadowViewsChanged = false;
        EXPECT_EQ(decodeFinalLists(rig->run(input)), expected);
        input.shadowViewsChanged = true;
    }
}

// Wide sources, coarse and fine maps, standard and reversed depth, few and many taps: not a bit changes.
TEST_P(ShadowBoundsTest, SameBitsWithAndWithout) {
    std::size_t slots = 0;
    for (const std::uint64_t seed : {51u, 52u, 53u, 54u}) {
        SCOPED_TRACE(seed);
        RoomSetup setup{.seed = seed, .widthPx = 64, .heightPx = 48};
        setup.lights = {.count = 16, .castingShare = 1, .maxRangeMetres = 9, .spreadMetres = 5, .suns = 2};
        setup.lights.maxSourceRadius = seed % 2 == 0 ? 0.6 : 0.05;
        setup.shadows = {.viewSizePx = seed == 51 ? 200u : 72u,
                         .atlasCount = static_cast<std::uint32_t>(seed % 4 + 1),
                         .mixDepthKinds = true,
                         .infiniteFar = seed % 2 == 0};
        setup.objects = 20;
        FrameInput input = makeRoomFrame(setup);
        useFilter(input, Filter::Pcss);
        input.settings.pcssPresets[0] = seed % 2 == 0 ? PcssTaps{3, 4} : kPcssMedium;
        Rig rig(device(), {}, viewDescFor(input));
        ASSERT_TRUE(rig.ok());
        const FrameResult plain = rig.run(input);
        input.settings.shadowBounds = true;
        const FrameResult bounded = rig.run(input);
        EXPECT_EQ(decodeFinalLists(plain), decodeFinalLists(bounded));
        slots += plain.statistics.finalSlotEntries;
    }
    EXPECT_GT(slots, 300u) << "hardly a shadow's edge was seen";
}

}  // namespace
}  // namespace gnomon::test
