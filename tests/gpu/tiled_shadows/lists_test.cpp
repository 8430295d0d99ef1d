// Hierarchical depth and phases 2 and 3 against the oracle.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "checks.h"
#include "reference/hierarchical_depth.h"
#include "scenes.h"

namespace gnomon::test {
namespace {

class ListsTest : public GpuTest {};
GNOMON_ON_EVERY_DEVICE(ListsTest);

constexpr ListReservation kReservations[] = {ListReservation::Approximate, ListReservation::Accurate,
                                             ListReservation::Fixed};

TEST_P(ListsTest, DepthAndLightsOfARoom) {
    FrameInput input = makeRoomFrame({.widthPx = 136, .heightPx = 88});
    input.settings.fixedListEntriesPerTile = 50;
    for (const ListReservation reservation : kReservations) {
        SCOPED_TRACE(int(reservation));
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
    const FrameInput input = makeRoomFrame({.seed = 2});
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
