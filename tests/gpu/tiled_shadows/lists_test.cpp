// Hierarchical depth and phases 2 and 3 against the oracle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "checks.h"
#include "reference/hierarchical_depth.h"
#include "scenes.h"

namespace gnomon::test {
namespace {

class ListsTest : public GpuTest {};
GNOMON_ON_EVERY_DEVICE(ListsTest);

struct Way {
    LightLists lists;
    ListReservation reservation;
};
constexpr Way kWays[] = {
    {LightLists::Pixel, ListReservation::Approximate}, {LightLists::Pixel, ListReservation::Accurate},
    {LightLists::Pixel, ListReservation::Fixed},       {LightLists::Froxel, ListReservation::Approximate},
    {LightLists::Froxel, ListReservation::Accurate},   {LightLists::Froxel, ListReservation::Fixed}};

TEST_P(ListsTest, DepthAndLightsOfARoom) {
    FrameInput input = makeRoomFrame({.widthPx = 136, .heightPx = 88});
    input.settings.fixedListEntriesPerTile = 50;
    for (const auto& [lists, reservation] : kWays) {
        SCOPED_TRACE(std::to_string(int(lists)) + " " + std::to_string(int(reservation)));
        input.settings.lightLists = lists;
        input.settings.listReservation = reservation;
        Rig rig(device(), {}, viewDescFor(input));
        ASSERT_TRUE(rig.ok());
        const FrameResult result = rig.run(input);
        const Checked checked = checkFrame(input, result);
        EXPECT_GT(checked.early.must, 800u);
        EXPECT_LT(checked.early.mayShare(), 0.005);
        EXPECT_LT(checked.approximate.surplusShare(), 0.4);
        EXPECT_LT(checked.shadows.ambiguousShare(), 0.05);
        if (reservation != ListReservation::Fixed) continue;
        for (std::uint32_t tile = 0; tile < result.slotIds.size(); ++tile)
            EXPECT_EQ(result.slotIds[tile], tile * 51);  // predictable addresses, rounded up to whole words
    }
}

// Every size of subgroup that the device can run gives the same lists.
TEST_P(ListsTest, EverySubgroupSize) {
    RoomSetup setup{.seed = 2};
    setup.lights.filters = kAllBuiltInFilters;
    setup.lights.castingShare = 0.8;
    setup.lights.maxSourceRadius = 0.3;
    const FrameInput input = makeRoomFrame(setup);
    const renderer::DeviceInfo& info = device().vulkan().info();
    std::vector<std::vector<DecodedEntry>> first;
    for (std::uint32_t size = std::max(4u, info.minSubgroupSize); size <= std::min(64u, info.maxSubgroupSize);
         size *= 2) {
        SCOPED_TRACE(size);
        Rig rig(device(), {.subgroupSize = size}, viewDescFor(input));
        ASSERT_TRUE(rig.ok());
        const FrameResult result = rig.run(input);
        checkFrame(input, result);
        if (first.empty()) first = decodeFinalLists(result);
        EXPECT_EQ(first, decodeFinalLists(result));
    }
    EXPECT_FALSE(first.empty());
}

/// The entries of casting lights that are not dark all over their tile.
std::vector<std::vector<DecodedEntry>> seenShadows(const FrameInput& input, const FrameResult& result) {
    std::vector<std::vector<DecodedEntry>> tiles = decodeFinalLists(result);
    for (std::vector<DecodedEntry>& tile : tiles)
        std::erase_if(tile, [&](const DecodedEntry& entry) {
            return entry.flag == gpu::kSlotAllUnlit || !input.lights[entry.hostLight].casts;
        });
    return tiles;
}

// Phase 2's own lists are what it counts and gives its groups, and phase 3's are a part of them that leaves out
// darkness alone.
TEST_P(ListsTest, ByFroxelAndByPixel) {
    RoomSetup setup{.seed = 21, .widthPx = 136, .heightPx = 72};
    setup.lights.filters = kAllBuiltInFilters;
    setup.lights.castingShare = 0.8;
    FrameInput input = makeRoomFrame(setup);
    Rig rig(device(), {}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    input.settings.lightLists = LightLists::Froxel;
    const FrameResult byFroxel = rig.run(input);
    input.settings.lightLists = LightLists::Pixel;
    const FrameResult byPixel = rig.run(input);
    EXPECT_EQ(byFroxel.approximateCounts, byPixel.approximateCounts);
    const auto froxelLists = decodeEarlyLists(byFroxel), pixelLists = decodeEarlyLists(byPixel);
    std::size_t fewer = 0;
    for (std::size_t tile = 0; tile < froxelLists.size(); ++tile) {
        EXPECT_EQ(froxelLists[tile].size(), byPixel.approximateCounts[tile]);
        EXPECT_TRUE(std::includes(froxelLists[tile].begin(), froxelLists[tile].end(), pixelLists[tile].begin(),
                                  pixelLists[tile].end()))
            << "tile " << tile;
        fewer += froxelLists[tile].size() - pixelLists[tile].size();
    }
    EXPECT_GT(fewer, 20u);
    EXPECT_EQ(seenShadows(input, byFroxel), seenShadows(input, byPixel));
}

// Without face normals they come from depth; without receiver flags every mask meets.
TEST_P(ListsTest, WithoutFaceNormalsAndReceiverFlags) {
    for (const bool normals : {false, true}) {
        FrameInput input = makeRoomFrame({.seed = 3});
        if (!normals) input.receivers.faceNormals.clear();
        if (normals) input.receivers.receiverFlags.clear();
        Rig rig(device(), {}, viewDescFor(input));
        ASSERT_TRUE(rig.ok());
        const FrameResult result = rig.run(input);
        checkFrame(input, result);
        input.settings.dropLightsFacedAway = false;  // then nothing hangs on the missing normals but bytes
        checkFrame(input, rig.run(input));
    }
}

// On flat ground, normals from depth are the ground's: a frame with them equals one with given normals.
TEST_P(ListsTest, NormalsFromDepthOnAPlane) {
    RoomSetup setup;
    setup.objects = 0;  // floor and back wall
    setup.lights.filters = only(Filter::Hard);
    FrameInput given = makeRoomFrame(setup);
    FrameInput derived = given;
    derived.receivers.faceNormals.clear();
    Rig rig(device(), {}, viewDescFor(given));
    ASSERT_TRUE(rig.ok());
    const FrameResult a = rig.run(given), b = rig.run(derived);
    std::size_t same = 0, all = 0;
    const auto listsA = decodeEarlyLists(a), listsB = decodeEarlyLists(b);
    for (std::size_t tile = 0; tile < listsA.size(); ++tile) {
        ++all;
        same += listsA[tile] == listsB[tile];
    }
    EXPECT_GT(same * 100, all * 95);
}

/// Min and max device depth per tile, background included or not.
std::vector<float> pyramidOf(const FrameInput& input, bool withBackground, float background) {
    const std::uint32_t tilesX = gpu::divideRoundingUp(input.widthPx, 8),
                        tilesY = gpu::divideRoundingUp(input.heightPx, 8);
    std::vector<float> out(2 * std::size_t(tilesX) * tilesY);
    for (std::size_t tile = 0; tile < out.size() / 2; ++tile) {
        float low = 2, high = -1;
        for (std::uint32_t i = 0; i < 64; ++i) {
            const std::uint32_t x = tile % tilesX * 8 + i % 8,
                                y = static_cast<std::uint32_t>(tile / tilesX) * 8 + i / 8;
            if (x >= input.widthPx || y >= input.heightPx) continue;
            const float d = input.receivers.depth[std::size_t(y) * input.widthPx + x];
            if (!withBackground && d == background) continue;
            low = std::min(low, d);
            high = std::max(high, d);
        }
        if (high < 0) low = high = background;
        out[2 * tile] = low;
        out[2 * tile + 1] = high;
    }
    return out;
}

TEST_P(ListsTest, HostDepthPyramid) {
    for (const bool reversed : {true, false}) {
        RoomSetup setup{.seed = 4, .widthPx = 100, .heightPx = 60};
        setup.camera.eye = {1.5, 2.2, -6};
        setup.camera.target = {-0.5, 2.2, 0};  // some sky
        setup.camera.reversed = reversed;
        FrameInput input = makeRoomFrame(setup);
        const float background = reversed ? 0.0f : 1.0f;
        input.settings.hostDepthPyramid = true;
        Rig rig(device(), {}, viewDescFor(input));
        ASSERT_TRUE(rig.ok());
        for (const bool withBackground : {false, true}) {
            SCOPED_TRACE(withBackground);
            input.depthPyramid = pyramidOf(input, withBackground, background);
            const FrameResult result = rig.run(input);
            CheckOptions options;
            options.depths = !withBackground;
            checkFrame(input, result, options);
            if (withBackground) {
                EXPECT_TRUE(std::any_of(result.depthRanges.begin(), result.depthRanges.end(),
                                        [](float f) { return f == std::numeric_limits<float>::infinity(); }));
            }
        }
        // An endless tile, and no light with a range: the zBins have no length.
        input.lights.assign(3, {});
        input.lightViews.clear();
        for (Light& light : input.lights) light.type = LightType::Directional;
        CheckOptions options;
        options.depths = false;
        const Checked checked = checkFrame(input, rig.run(input), options);
        EXPECT_GT(checked.early.must, 0u);
        input.lights.clear();
        checkFrame(input, rig.run(input), options);
    }
}

// Every tile has pixels at 2 m and at 10 m, and nothing between. A light in the gap reaches its froxel, but no pixel:
// no list has it. Lights that touch either surface are listed.
TEST_P(ListsTest, LightsBetweenTwoSurfacesAreLeftOut) {
    RoomSetup setup{.seed = 6};
    setup.camera.eye = {0, 0, 0};
    setup.camera.target = {0, 0, -1};
    for (const LightLists by : {LightLists::Froxel, LightLists::Pixel}) {
        FrameInput input = makeQuickFrame(setup);
        input.settings.lightLists = by;
        for (std::size_t i = 0; i < input.receivers.depth.size(); ++i)
            input.receivers.depth[i] = static_cast<float>(setup.camera.nearMetres / (i % 2 == 0 ? 2.0 : 10.0));
        Light light;
        light.rangeMetres = 1.0f;
        light.casts = false;
        input.lights.assign(3, light);
        const float depths[] = {6.0f, 2.5f, 9.5f};
        for (std::size_t i = 0; i < 3; ++i) input.lights[i].position[2] = -depths[i];
        input.lightViews.clear();
        Rig rig(device(), {}, viewDescFor(input));
        ASSERT_TRUE(rig.ok());
        const FrameResult result = rig.run(input);
        checkFrame(input, result);
        std::size_t listed[3] = {};
        for (std::size_t tile = 0; tile < result.slotIds.size(); ++tile) {
            EXPECT_EQ(result.depthSlices[tile], 0x80000001u);
            for (const std::uint32_t i : earlyLights(result.lists(), tile)) ++listed[result.lights[i].hostIndex];
        }
        EXPECT_EQ(listed[0], 0u);
        EXPECT_GT(listed[1], 0u);
        EXPECT_GT(listed[2], 0u);
        const std::uint32_t approximate =
            std::accumulate(result.approximateCounts.begin(), result.approximateCounts.end(), 0u);
        EXPECT_LT(approximate, 2 * result.slotIds.size());
        EXPECT_GE(approximate, listed[1] + listed[2]);
    }
}

// Infinities are exact: a tile of background alone has +inf above -inf.
TEST_P(ListsTest, BackgroundTilesAreEmpty) {
    RoomSetup setup{.seed = 5};
    setup.camera.eye = {1.5, 2.2, -6};
    setup.camera.target = {-0.5, 2.6, 0};
    const FrameInput input = makeRoomFrame(setup);
    Rig rig(device(), {}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    const FrameResult result = rig.run(input);
    const Checked checked = checkFrame(input, result);
    const std::vector<reference::TileDepths> depths = reference::tileDepths(checked.grid);
    std::size_t empty = 0;
    for (std::size_t tile = 0; tile < depths.size(); ++tile) {
        if (!depths[tile].empty()) continue;
        ++empty;
        EXPECT_EQ(result.depthRanges[2 * tile], std::numeric_limits<float>::infinity());
        EXPECT_EQ(result.depthRanges[2 * tile + 1], -std::numeric_limits<float>::infinity());
        EXPECT_EQ(result.approximateCounts[tile], 0u);
        EXPECT_EQ(result.earlyCounts[tile], 0u);
        EXPECT_EQ(result.finalCounts[tile], 0u);
    }
    EXPECT_GT(empty, 5u);
    EXPECT_LT(empty, depths.size());
}

}  // namespace
}  // namespace gnomon::test
