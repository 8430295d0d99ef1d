// Pools that are too small: nothing is written outside, nothing is lost, and the counters tell.
#include <gtest/gtest.h>

#include <algorithm>

#include "checks.h"
#include "scenes.h"

namespace gnomon::test {
namespace {

class OverflowTest : public GpuTest {};
GNOMON_ON_EVERY_DEVICE(OverflowTest);

FrameInput crowdedRoom() {
    RoomSetup setup{.seed = 10, .widthPx = 88, .heightPx = 72};
    setup.lights.castingShare = 0.8;
    setup.lights.suns = 1;
    return makeRoomFrame(setup);
}

/// Every list that is left equals the one of a frame without overflow, but for EVALUATE in place of slots. `orFlags`:
/// in place of flags, too, since it was not known yet that no slot is needed.
void expectSameButEvaluate(const FrameResult& full, const FrameResult& small, bool orFlags = false) {
    const auto fullLists = decodeFinalLists(full), smallLists = decodeFinalLists(small);
    ASSERT_EQ(fullLists.size(), smallLists.size());
    for (std::size_t tile = 0; tile < fullLists.size(); ++tile) {
        if (small.slotIds[tile] == gpu::kNoListSpace) {
            EXPECT_NE(small.finalCounts[tile] & gpu::kFinalEvaluateBit, 0u);
            continue;
        }
        ASSERT_EQ(fullLists[tile].size(), smallLists[tile].size()) << "tile " << tile;
        for (std::size_t i = 0; i < fullLists[tile].size(); ++i) {
            const DecodedEntry &a = fullLists[tile][i], &b = smallLists[tile][i];
            EXPECT_EQ(a.hostLight, b.hostLight);
            if (b.flag == gpu::kSlotEvaluate) {
                EXPECT_TRUE(a.flag == 0 || orFlags);
            } else {
                EXPECT_TRUE(a == b) << "tile " << tile;
            }
        }
    }
}

TEST_P(OverflowTest, PoolsOfEverySize) {
    FrameInput input = crowdedRoom();
    input.settings.pcssPresets[0] = kPcssLow;
    struct Way {
        LightLists lists;
        ListReservation reservation;
        Filter filter;
        std::uint32_t bits;
    };
    for (const Way& way : {Way{LightLists::Pixel, ListReservation::Approximate, Filter::Pcf, 8},
                           Way{LightLists::Pixel, ListReservation::Accurate, Filter::Pcss, 4},
                           Way{LightLists::Froxel, ListReservation::Accurate, Filter::PcssShared, 8}}) {
        SCOPED_TRACE(int(way.filter));
        useFilter(input, way.filter);
        input.settings.visibilityBits = way.bits;
        input.settings.lightLists = way.lists;
        input.settings.listReservation = way.reservation;
        Rig generous(device(), {}, viewDescFor(input));
        ASSERT_TRUE(generous.ok());
        const FrameResult full = generous.run(input);
        checkFrame(input, full);
        const std::uint32_t entries = full.counters.listEntries, slots = full.counters.visibilitySlots;
        ASSERT_GT(entries, 300u);
        ASSERT_GT(slots, 60u);
        struct Pools {
            std::uint32_t entries, slots;
        };
        for (const Pools pools :
             {Pools{1, 1}, Pools{2, slots}, Pools{3, 2}, Pools{61, 7}, Pools{entries, 1}, Pools{entries / 2, slots / 2},
              Pools{entries - 1, slots}, Pools{entries, slots - 1}, Pools{entries, slots}}) {
            SCOPED_TRACE(std::to_string(pools.entries) + " entries, " + std::to_string(pools.slots) + " slots");
            ViewDesc desc = viewDescFor(input);
            desc.listEntries = pools.entries;
            desc.visibilitySlots = pools.slots;
            Rig rig(device(), {}, desc);
            ASSERT_TRUE(rig.ok());
            const FrameResult small = rig.run(input);
            EXPECT_EQ(small.listCapacity, pools.entries / 3 * 3);
            EXPECT_EQ(small.slotCapacity, pools.slots);
            const bool listsFit = pools.entries >= entries, slotsFit = pools.slots >= slots;
            CheckOptions options{.bytes = false, .listOverflow = !listsFit, .slotOverflow = !slotsFit};
            checkFrame(input, small, options);
            const bool queued = way.filter != Filter::Pcf;
            expectSameButEvaluate(full, small, way.filter == Filter::PcssShared || (queued && !listsFit));
            EXPECT_EQ(small.counters.listEntries, entries);  // asked for, whether or not there was space
            EXPECT_EQ(small.counters.listOverflowTiles > 0, !listsFit);
            if (listsFit) {
                EXPECT_EQ(small.counters.visibilitySlots, slots);
                EXPECT_EQ(small.counters.slotOverflowEntries, slotsFit ? 0 : slots - pools.slots);
                EXPECT_GE(small.statistics.recommendedVisibilitySlots, slots);
            }
            EXPECT_GE(small.statistics.recommendedListEntries, entries);
        }
    }
}

TEST_P(OverflowTest, FixedEntriesTooFew) {
    FrameInput input = crowdedRoom();
    input.settings.listReservation = ListReservation::Fixed;
    input.settings.fixedListEntriesPerTile = 90;
    Rig generous(device(), {}, viewDescFor(input));
    ASSERT_TRUE(generous.ok());
    const FrameResult full = generous.run(input);
    for (const std::uint32_t fixed : {1u, 4u, 12u}) {
        SCOPED_TRACE(fixed);
        ViewDesc desc = viewDescFor(input);
        if (fixed == 12) desc.listEntries = 500;  // and the pool ends within the frame
        input.settings.fixedListEntriesPerTile = fixed;
        Rig rig(device(), {}, desc);
        ASSERT_TRUE(rig.ok());
        const FrameResult small = rig.run(input);
        checkFrame(input, small, {.bytes = false, .listOverflow = true});
        expectSameButEvaluate(full, small);
        EXPECT_GT(small.counters.listOverflowTiles, 0u);
        EXPECT_LT(small.counters.listOverflowTiles, small.slotIds.size());
    }
}

// More than 1024 tiles to evaluate: rows of the indirect dispatch.
TEST_P(OverflowTest, IndirectRows) {
    RoomSetup setup{.seed = 11, .widthPx = 264, .heightPx = 256};
    setup.lights.count = 0;
    FrameInput input = makeQuickFrame(setup);
    Light sun;
    sun.type = LightType::Directional;
    input.lights = {sun};
    input.receivers.depth.assign(input.receivers.depth.size(), 0.01f);
    ViewDesc desc = viewDescFor(input);
    for (const std::uint32_t tilesWithSpace : {0u, 31u, 32u, 33u}) {
        desc.listEntries = std::max(1u, tilesWithSpace * 3);
        Rig rig(device(), {}, desc);
        ASSERT_TRUE(rig.ok());
        const FrameResult result = rig.run(input);
        checkFrame(input, result, {.bytes = false, .listOverflow = true});
        const std::uint32_t tiles = 33 * 32 - tilesWithSpace;
        EXPECT_EQ(result.evaluateTiles[3], tiles);
        EXPECT_EQ(result.evaluateTiles[1], tiles > 1024 ? 2u : 1u);
        EXPECT_EQ(result.statistics.evaluateTiles, tiles);
    }
}

}  // namespace
}  // namespace gnomon::test
