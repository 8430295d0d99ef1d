// Which cells of the shadow bounds are made in which frame, and where views are told to find them.
#include "src/shadow_bounds/cells.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <tuple>

#include "src/gpu_interface/packing.h"

namespace gnomon::test {
namespace {

using gpu::GpuShadowBoundsCell;
using gpu::GpuShadowView;
using gpu::kShadowBoundsCellPx;

// Atlas, layer, column and row of a cell.
using Place = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;

ShadowAtlas atlasOf(std::uint32_t width, std::uint32_t height, std::uint32_t layers = 1, std::uintptr_t handle = 1) {
    ShadowAtlas atlas;
    atlas.view = reinterpret_cast<VkImageView>(handle);
    atlas.widthPx = width, atlas.heightPx = height, atlas.layers = layers;
    return atlas;
}

ShadowView viewAt(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height, std::uint32_t atlas = 0,
                  std::uint32_t layer = 0) {
    ShadowView view;
    view.xPx = x, view.yPx = y, view.widthPx = width, view.heightPx = height;
    view.atlas = atlas, view.layer = layer;
    return view;
}

struct Frames {
    explicit Frames(std::uint32_t capacity) : capacity(capacity) { cells.create(capacity); }

    // One frame; its pass is recorded if `recorded`.
    std::set<Place> list(const std::vector<ShadowView>& views, const std::vector<ShadowAtlas>& atlases,
                         bool recorded = true) {
        std::vector<GpuShadowBoundsCell> out(capacity + 1, GpuShadowBoundsCell{.row = 12345});
        gpuViews.assign(views.size(), {});
        count = cells.list(views, atlases, gpuViews.data(), out.data());
        EXPECT_LE(count, capacity);
        EXPECT_EQ(out.back().row, 12345u) << "written beyond the capacity";
        out.resize(count);
        listed = out;
        std::set<Place> places;
        for (const GpuShadowBoundsCell& c : out) {
            EXPECT_TRUE(places.insert({c.atlasAndLayer & 0xFFu, c.atlasAndLayer >> 8, c.cellX, c.cellY}).second)
                << "a cell is made twice";
        }
        if (recorded) cells.made();
        return places;
    }

    ShadowBoundsCells cells;
    std::uint32_t capacity;
    std::vector<GpuShadowView> gpuViews;
    std::vector<GpuShadowBoundsCell> listed;
    std::uint32_t count = 0;
};

std::set<Place> touchedBy(const ShadowView& view) {
    std::set<Place> places;
    for (std::uint32_t y = view.yPx; y < view.yPx + view.heightPx; ++y)
        for (std::uint32_t x = view.xPx; x < view.xPx + view.widthPx; ++x)
            places.insert({view.atlas, view.layer, x / kShadowBoundsCellPx, y / kShadowBoundsCellPx});
    return places;
}

TEST(ShadowBoundsCells, SizesAreWholeCells) {
    EXPECT_EQ(shadowBoundsCellsFor(0), 0u);
    EXPECT_EQ(shadowBoundsCellsFor(1), 1u);
    EXPECT_EQ(shadowBoundsCellsFor(65536), 1u);
    EXPECT_EQ(shadowBoundsCellsFor(65537), 2u);
    EXPECT_EQ(shadowBoundsCellsFor(std::uint64_t{8192} * 8192), 1024u);
    EXPECT_EQ(shadowBoundsCellsFor(~0ull), 1u << 20);
    EXPECT_EQ(shadowBoundsBytes(1024), 1024u * 344 * 8);
    // All levels of a cell find room.
    std::uint32_t entries = 0;
    for (std::uint32_t level = 0; level < gpu::kShadowBoundsLevels; ++level)
        entries += (gpu::kShadowBoundsCellBlocks >> level) * (gpu::kShadowBoundsCellBlocks >> level);
    EXPECT_LE(entries, gpu::kShadowBoundsCellEntries);
}

// No two blocks of any level, cell, layer or atlas share an entry, and none lies beyond the buffer.
TEST(ShadowBoundsCells, EveryBlockHasAPlaceOfItsOwn) {
    const std::vector<ShadowAtlas> atlases = {atlasOf(1000, 300, 2), atlasOf(16, 16), atlasOf(256, 770, 3)};
    Frames frames(64);
    std::vector<ShadowView> views;
    for (std::uint32_t a = 0; a < atlases.size(); ++a)
        for (std::uint32_t layer = 0; layer < atlases[a].layers; ++layer)
            views.push_back(viewAt(0, 0, atlases[a].widthPx, atlases[a].heightPx, a, layer));
    frames.list(views, atlases);
    std::set<std::uint32_t> taken;
    for (const GpuShadowBoundsCell& cell : frames.listed) {
        for (std::uint32_t level = 0; level < gpu::kShadowBoundsLevels; ++level) {
            const std::uint32_t across = gpu::kShadowBoundsCellBlocks >> level;
            for (std::uint32_t i = 0; i < across * across; ++i) {
                const std::uint32_t x = cell.cellX * across + i % across, y = cell.cellY * across + i / across;
                std::uint32_t at = cell.first;
                at += gpu::shadowBoundsLevelOffset(cell.blocks, level);
                at += y * (cell.row >> level) + x;
                EXPECT_TRUE(taken.insert(at).second) << "level " << level << ": entry " << at << " is shared";
                EXPECT_LT(std::uint64_t{at} * 8, shadowBoundsBytes(frames.capacity));
            }
        }
    }
    EXPECT_EQ(taken.size(), frames.count * 341u);
}

TEST(ShadowBoundsCells, ListsWhatViewsTouch) {
    std::mt19937 random(1);
    const auto below = [&random](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
    for (int trial = 0; trial < 15; ++trial) {
        const std::vector<ShadowAtlas> atlases = {atlasOf(1024, 512, 2), atlasOf(700, 900, 3, 2)};
        Frames frames(200);
        std::set<Place> expected;
        std::vector<ShadowView> views;
        for (int v = 0; v < 8; ++v) {
            const std::uint32_t a = below(2);
            const std::uint32_t x = below(atlases[a].widthPx - 8), y = below(atlases[a].heightPx - 8);
            views.push_back(viewAt(x, y, 8 + below(atlases[a].widthPx - x - 7), 8 + below(atlases[a].heightPx - y - 7),
                                   a, below(atlases[a].layers)));
            views.back().changed = below(2) == 0;  // the first frame knows nothing, so it does not matter
            expected.merge(touchedBy(views.back()));
        }
        EXPECT_EQ(frames.list(views, atlases), expected);
        for (std::size_t v = 0; v < views.size(); ++v) {
            EXPECT_GT(frames.gpuViews[v].boundsBlocks, 0u);
            for (std::size_t w = 0; w < v; ++w) {
                const bool sameLayer = views[v].atlas == views[w].atlas && views[v].layer == views[w].layer;
                EXPECT_EQ(frames.gpuViews[v].boundsFirst == frames.gpuViews[w].boundsFirst, sameLayer);
            }
        }
        // Then those of changed views alone.
        std::set<Place> again;
        for (ShadowView& view : views) {
            view.changed = below(3) == 0;
            if (view.changed) again.merge(touchedBy(view));
        }
        EXPECT_EQ(frames.list(views, atlases), again);
        for (ShadowView& view : views) view.changed = false;
        EXPECT_TRUE(frames.list(views, atlases).empty());
        EXPECT_GT(frames.gpuViews[0].boundsBlocks, 0u) << "bounds that were kept must be found";
    }
}

TEST(ShadowBoundsCells, OtherAtlasesAreMadeAnew) {
    const ShadowView still = [] {
        ShadowView view = viewAt(10, 10, 300, 20);
        view.changed = false;
        return view;
    }();
    Frames frames(100);
    const std::vector<ShadowAtlas> first = {atlasOf(1024, 512)};
    EXPECT_EQ(frames.list({still}, first).size(), 2u);
    EXPECT_EQ(frames.list({still}, first).size(), 0u);
    for (const std::vector<ShadowAtlas>& other :
         {std::vector{atlasOf(1024, 512, 1, 7)}, std::vector{atlasOf(1024, 256)}, std::vector{atlasOf(512, 512)},
          std::vector{atlasOf(1024, 512, 2)}, std::vector{atlasOf(1024, 512), atlasOf(64, 64)}}) {
        EXPECT_EQ(frames.list({still}, other).size(), 2u);
        EXPECT_EQ(frames.list({still}, other).size(), 0u);
        EXPECT_EQ(frames.list({still}, first).size(), 2u);
    }
}

TEST(ShadowBoundsCells, WhatDoesNotFitHasNoBounds) {
    ShadowView view = viewAt(0, 0, 1024, 512);
    Frames frames(8);
    const std::vector<ShadowAtlas> fits = {atlasOf(1024, 512)}, large = {atlasOf(1024, 513)},
                                   layered = {atlasOf(1024, 512, 2)}, huge = {atlasOf(1u << 30, 1u << 30, 1u << 10)};
    EXPECT_EQ(frames.list({view}, fits).size(), 8u);
    for (const std::vector<ShadowAtlas>& atlases : {large, layered, huge}) {
        EXPECT_EQ(frames.list({view}, atlases).size(), 0u);
        EXPECT_EQ(frames.gpuViews[0].boundsBlocks, 0u);
        view.changed = false;
        EXPECT_EQ(frames.list({view}, fits).size(), 8u) << "what was kept before was taken for known";
        view.changed = true;
    }
    Frames none(0);
    EXPECT_EQ(none.list({view}, fits).size(), 0u);
    EXPECT_EQ(none.gpuViews[0].boundsBlocks, 0u);
    EXPECT_EQ(none.list({}, {}).size(), 0u);
    EXPECT_EQ(frames.list({}, {}).size(), 0u);
}

// Listed is not made: a host that leaves the pass out, or the bounds of a whole frame, gets them later.
TEST(ShadowBoundsCells, FramesWithoutThePass) {
    const std::vector<ShadowAtlas> atlases = {atlasOf(1024, 512)};
    ShadowView left = viewAt(0, 0, 256, 256), right = viewAt(512, 256, 256, 256);
    Frames frames(100);
    EXPECT_EQ(frames.list({left, right}, atlases, false).size(), 2u);
    left.changed = right.changed = false;
    EXPECT_EQ(frames.list({left, right}, atlases, false).size(), 2u);
    EXPECT_EQ(frames.list({left, right}, atlases).size(), 2u);
    EXPECT_EQ(frames.list({left, right}, atlases).size(), 0u);
    right.changed = true;
    frames.cells.skip(std::vector{left, right}, atlases);
    right.changed = false;
    EXPECT_THAT(frames.list({left, right}, atlases), ::testing::ElementsAre(Place{0, 0, 2, 1}));
    frames.cells.skip(std::vector{left, right}, atlases);
    EXPECT_EQ(frames.list({left, right}, atlases).size(), 0u) << "nothing had changed";
    frames.cells.skip(std::vector{left, right}, std::vector{atlasOf(1024, 512, 1, 2)});
    EXPECT_EQ(frames.list({left, right}, atlases).size(), 2u);
}

}  // namespace
}  // namespace gnomon::test
