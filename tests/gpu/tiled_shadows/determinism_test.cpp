// The same input gives the same frame; views, contexts and frames in flight do not disturb each other.
#include <gtest/gtest.h>

#include "checks.h"
#include "scenes.h"

namespace gnomon::test {
namespace {

class DeterminismTest : public GpuTest {};
GNOMON_ON_EVERY_DEVICE(DeterminismTest);

FrameInput crowdedRoom(std::uint64_t seed = 30, FilterSet filters = only(Filter::Pcf)) {
    RoomSetup setup{.seed = seed, .widthPx = 88, .heightPx = 72};
    setup.lights.castingShare = 0.8;
    setup.lights.suns = 1;
    setup.shadows.viewSizePx = 16;
    setup.lights.filters = filters;
    return makeRoomFrame(setup);
}

TEST_P(DeterminismTest, SameInputSameFrame) {
    for (const LightLists lists : {LightLists::Pixel, LightLists::Froxel}) {
        SCOPED_TRACE(int(lists));
        FrameInput input = crowdedRoom(30, only(Filter::Pcss) | only(Filter::PcssShared));
        input.settings.lightLists = lists;
        input.settings.fixedListEntriesPerTile = 90;
        std::vector<std::vector<DecodedEntry>> first;
        for (const ListReservation reservation :
             {ListReservation::Approximate, ListReservation::Accurate, ListReservation::Fixed}) {
            input.settings.listReservation = reservation;
            Rig rig(device(), {}, viewDescFor(input));
            ASSERT_TRUE(rig.ok());
            for (int i = 0; i < 3; ++i) {
                const FrameResult result = rig.run(input, {.fill = i != 1});
                if (first.empty()) {
                    checkFrame(input, result);
                    first = decodeFinalLists(result);
                }
                EXPECT_EQ(first, decodeFinalLists(result));
            }
        }
    }
}

// The pattern turns with the frame's number where that is asked for, and only there.
TEST_P(DeterminismTest, PatternPerFrame) {
    FrameInput input = crowdedRoom(30, only(Filter::Pcss));
    for (Light& light : input.lights) light.sourceRadius = light.type == LightType::Directional ? 0.05f : 0.3f;
    Rig still(device(), {}, viewDescFor(input));
    ASSERT_TRUE(still.ok());
    const auto first = decodeFinalLists(still.run(input));
    EXPECT_EQ(first, decodeFinalLists(still.run(input)));
    input.settings.patternPerFrame = true;
    const auto turned = decodeFinalLists(still.run(input));
    EXPECT_NE(first, turned);
    EXPECT_NE(turned, decodeFinalLists(still.run(input)));
}

// Several views of two contexts, their frames interleaved, each with its own input.
TEST_P(DeterminismTest, ViewsSideBySide) {
    const FrameInput a = crowdedRoom(31), b = crowdedRoom(32), c = crowdedRoom(31, only(Filter::Hard));
    std::unique_ptr<Context> second;
    ASSERT_TRUE(Context::create(device().contextDesc({}), second).ok());  // one more, of the same kind
    Rig one(device(), {}, viewDescFor(a)), two(device(), {}, viewDescFor(b)), three(device(), {}, viewDescFor(c));
    ASSERT_TRUE(one.ok() && two.ok() && three.ok());
    const auto oneFirst = decodeFinalLists(one.run(a)), twoFirst = decodeFinalLists(two.run(b)),
               threeFirst = decodeFinalLists(three.run(c));
    EXPECT_NE(oneFirst, threeFirst);
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(twoFirst, decodeFinalLists(two.run(b)));
        EXPECT_EQ(threeFirst, decodeFinalLists(three.run(c)));
        EXPECT_EQ(oneFirst, decodeFinalLists(one.run(a)));
    }
    second.reset();
    checkFrame(a, one.run(a));
}

// Statistics are kept for the last framesInFlight frames, each under its own number.
TEST_P(DeterminismTest, StatisticsByFrameNumber) {
    const FrameInput input = crowdedRoom();
    for (std::uint32_t inFlight = 1; inFlight <= 4; ++inFlight) {
        SCOPED_TRACE(inFlight);
        ViewDesc desc = viewDescFor(input);
        desc.framesInFlight = inFlight;
        Rig rig(device(), {}, desc);
        ASSERT_TRUE(rig.ok());
        FrameStatistics statistics;
        EXPECT_FALSE(rig.view().statistics(0, statistics));
        EXPECT_FALSE(rig.view().statistics(1, statistics));
        std::vector<FrameInput> inputs;
        for (std::uint32_t i = 0; i < inFlight; ++i) {
            inputs.push_back(input);
            inputs.back().lights.resize(40 - 9 * i);
        }
        std::vector<FrameStatistics> alone;
        for (const FrameInput& frame : inputs) alone.push_back(rig.run(frame).statistics);
        const std::uint64_t before = rig.lastFrame();
        rig.runInFlight(inputs);  // all recorded before any is waited for
        for (std::uint32_t i = 0; i < inFlight; ++i) {
            ASSERT_TRUE(rig.view().statistics(before + 1 + i, statistics));
            EXPECT_EQ(statistics.frameNumber, before + 1 + i);
            EXPECT_EQ(statistics.lights.given, 40 - 9 * i);
            EXPECT_EQ(statistics.lights.visible, alone[i].lights.visible);
            EXPECT_EQ(statistics.earlyEntries, alone[i].earlyEntries);
            EXPECT_EQ(statistics.finalEntries, alone[i].finalEntries);
            EXPECT_EQ(statistics.visibilitySlots, alone[i].visibilitySlots);
            EXPECT_EQ(statistics.listEntries, alone[i].listEntries);
            EXPECT_GE(statistics.prepareMilliseconds, 0.0);
            const std::span<const TimelineRow> rows = rig.timeline().rows(before + 1 + i);
            for (const TimelineRow& row : rows) EXPECT_GE(row.milliseconds(), 0.0) << row.name;
            EXPECT_EQ(rows.size(), rig.timeline().records() ? 4u : 0u);
        }
        EXPECT_FALSE(rig.view().statistics(before, statistics));
        EXPECT_FALSE(rig.view().statistics(before + 1 + inFlight, statistics));
        EXPECT_FALSE(rig.view().statistics(~0ull, statistics));
        rig.run(input, {.endFrame = false});
        EXPECT_FALSE(rig.view().statistics(rig.lastFrame(), statistics));  // it had no recordEndFrame()
    }
}

// A host may leave out phase 4; what an earlier frame left is not counted.
TEST_P(DeterminismTest, WithoutPhase4) {
    const FrameInput input = crowdedRoom();
    Rig rig(device(), {}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    rig.run(input);
    const FrameResult result = rig.run(input, {.shadows = false, .fill = false});
    EXPECT_EQ(result.statistics.finalEntries, 0u);
    EXPECT_EQ(result.statistics.finalSlotEntries, 0u);
    EXPECT_EQ(result.statistics.visibilitySlots, 0u);
    EXPECT_GT(result.statistics.earlyEntries, 100u);
    const FrameResult filled = rig.run(input, {.shadows = false});
    checkFrame(input, filled, {.shadows = false});
    ViewDesc plain = viewDescFor(input);
    plain.statistics = false;
    Rig quiet(device(), {}, plain);
    ASSERT_TRUE(quiet.ok());
    const FrameResult silent = quiet.run(input, {.timeline = false});
    EXPECT_TRUE(silent.hasStatistics);
    EXPECT_TRUE(silent.rows.empty());
    EXPECT_EQ(silent.statistics.earlyEntries, 0u);
    EXPECT_EQ(silent.statistics.visibilitySlots, silent.counters.visibilitySlots);
}

// Images that a host destroys and makes anew may get their old handles back. Without the validation layer, which hands
// out handles of its own.
TEST_P(DeterminismTest, NewImagesUnderOldHandles) {
    const renderer::VulkanInstance plain({.validation = false});
    const std::string name = device().vulkan().info().name;
    TestDevice bare(plain, plain.chooseDevice(name));
    const FrameInput a = crowdedRoom(33), b = crowdedRoom(34);
    ViewDesc desc = viewDescFor(a);
    desc.maxShadowViews = 1000;
    desc.framesInFlight = 1;
    Rig rig(bare, {}, desc);
    ASSERT_TRUE(rig.ok());
    for (int i = 0; i < 4; ++i) {
        const FrameInput& input = i % 2 == 0 ? a : b;
        checkFrame(input, rig.run(input));
        rig.dropImages();
    }
}

}  // namespace
}  // namespace gnomon::test
