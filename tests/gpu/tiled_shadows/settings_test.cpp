// One View whose settings, extent and pools change from frame to frame: every frame against the oracle, nothing left of
// the frame before, and no pipeline made twice.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "checks.h"
#include "scenes.h"

namespace gnomon::test {
namespace {

class SettingsTest : public GpuTest {};
GNOMON_ON_EVERY_DEVICE(SettingsTest);

RoomSetup roomSetup() {
    RoomSetup setup{.seed = 70, .widthPx = 56, .heightPx = 48, .shadows = {.viewSizePx = 16, .mixDepthKinds = true}};
    setup.lights = {.count = 36, .castingShare = 0.9, .maxRangeMetres = 8, .spreadMetres = 6, .suns = 3};
    setup.lights.maxSourceRadius = 0.3;
    // Shared searches are a change of their own: software devices compile long for them. All filters at once stand in
    // mixed_filters_test.cpp.
    setup.lights.filters = kAllBuiltInFilters & ~only(Filter::PcssShared);
    setup.lights.pcssPresets = 2;
    return setup;
}

FrameInput room() {
    FrameInput input = makeRoomFrame(roomSetup());
    input.settings.pcssPresets[1] = kPcssLow;
    return input;
}

struct Change {
    const char* what;
    std::function<void(FrameInput&)> make;
};

/// Each is made to the frame of room(), so that every frame differs from its neighbours by two of them.
std::vector<Change> changes() {
    using In = FrameInput;
    return {
        {"nothing", [](In&) {}},
        {"4 bits", [](In& f) { f.settings.visibilityBits = 4; }},
        {"hard", [](In& f) { useFilter(f, Filter::Hard); }},
        {"wide percentage closer filters", [](In& f) { f.settings.pcfRadius = 3; }},
        {"accurate reservation", [](In& f) { f.settings.listReservation = ListReservation::Accurate; }},
        {"other taps",
         [](In& f) {
             f.settings.pcssPresets = {PcssTaps{3, 5}, kPcssMedium, kPcssLow, kPcssLow};
         }},
        {"fixed reservation",
         [](In& f) {
             f.settings.listReservation = ListReservation::Fixed;
             f.settings.fixedListEntriesPerTile = 60;
         }},
        {"no shadows", [](In& f) { f.settings.filters = 0; }},
        {"constant bias",
         [](In& f) {
             f.settings.depthBias = DepthBias::OrientedConstant;
             f.settings.facedAwayIsDark = false;
         }},
        {"4 bits, accurate, soft",
         [](In& f) {
             useFilter(f, Filter::Pcss);
             f.settings.visibilityBits = 4;
             f.settings.listReservation = ListReservation::Accurate;
         }},
        {"no bias", [](In& f) { f.settings.depthBias = DepthBias::Unbiased; }},
        {"lists by pixel", [](In& f) { f.settings.lightLists = LightLists::Pixel; }},
        {"shared searches", [](In& f) { useFilter(f, Filter::PcssShared); }},
        {"facing lights kept", [](In& f) { f.settings.dropLightsFacedAway = false; }},
        {"pattern per frame", [](In& f) { f.settings.patternPerFrame = true; }},
        {"shadow bounds", [](In& f) { f.settings.shadowBounds = true; }},
        {"subsurface bias", [](In& f) { f.settings.subsurfaceBiasMetres = 0.3f; }},
        {"other presets",
         [](In& f) {
             f.settings.pcssPresetCount = 4;
             f.settings.pcssPresets = {kPcssLow, kPcssHigh, PcssTaps{1, 1}, PcssTaps{7, 9}};
             for (std::size_t i = 0; i < f.lights.size(); ++i) f.lights[i].pcssPreset = i % 4;
         }},
        {"a smaller extent",
         [](In& f) {
             RoomSetup setup = roomSetup();
             setup.widthPx = 37;
             setup.heightPx = 21;
             renderRoom(f, setup);
             f.viewportXPx = 5;
         }},
    };
}

FrameInput changed(const FrameInput& base, const Change& change) {
    FrameInput frame = base;
    change.make(frame);
    return frame;
}

ViewDesc poolsFor(const FrameInput& base) {
    ViewDesc desc = viewDescFor(base);
    desc.listEntries = 42 * 66;
    return desc;
}

TEST_P(SettingsTest, EveryFrameHasItsOwn) {
    const FrameInput base = room();
    const std::vector<Change> all = changes();
    std::unique_ptr<Context> context;  // of its own, to count its pipelines
    ASSERT_TRUE(Context::create(device().contextDesc({}), context).ok());
    Rig rig(device(), *context, poolsFor(base));
    ASSERT_TRUE(rig.ok());
    EXPECT_EQ(context->pipelineCount(), 0u);
    const VkBuffer visibility = rig.view().buffer("visibility");
    std::vector<std::vector<std::vector<DecodedEntry>>> lists;
    std::vector<std::uint32_t> pipelines;
    for (const Change& change : all) {
        SCOPED_TRACE(change.what);
        const FrameInput frame = changed(base, change);
        const FrameResult result = rig.run(frame);
        const Checked checked = checkFrame(frame, result);
        EXPECT_GT(checked.early.must, 100u);
        EXPECT_EQ(checked.shadows.wrongBytes, 0u);
        lists.push_back(decodeFinalLists(result));
        pipelines.push_back(context->pipelineCount());
    }
    EXPECT_GT(pipelines.front(), 4u);
    EXPECT_TRUE(std::is_sorted(pipelines.begin(), pipelines.end()));
    // Other taps, biases of subsurface, patterns, bounds and extents need no pipeline of their own.
    for (const char* what : {"other taps", "facing lights kept", "pattern per frame", "shadow bounds",
                             "subsurface bias", "a smaller extent"})
        for (std::size_t i = 1; i < all.size(); ++i)
            if (std::string(all[i].what) == what) {
                EXPECT_EQ(pipelines[i], pipelines[i - 1]) << what;
            }
    // The other way round, with what the frame before left still in the buffers: the same, and no new pipeline.
    for (std::size_t i = all.size(); i-- > 0;) {
        SCOPED_TRACE(all[i].what);
        const FrameInput frame = changed(base, all[i]);
        const FrameResult result = rig.run(frame, {.fill = false});
        EXPECT_EQ(result.brokenGuards, 0u);
        if (!frame.settings.patternPerFrame) {
            EXPECT_EQ(lists[i], decodeFinalLists(result));
        }
    }
    EXPECT_EQ(context->pipelineCount(), pipelines.back());
    EXPECT_EQ(rig.view().buffer("visibility"), visibility);
    // Changes that ought to show do.
    for (std::size_t i = 0; i < lists.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const auto quiet = [&](std::size_t k) {
                const std::string what = all[k].what;
                return what == "accurate reservation" || what == "fixed reservation" || what == "shadow bounds" ||
                       what == "nothing" || what == "facing lights kept" || what == "pattern per frame";
            };
            if (!quiet(i) || !quiet(j)) {
                EXPECT_NE(lists[i], lists[j]) << all[i].what << " does the same as " << all[j].what;
            }
        }
}

// Pipelines that were made ahead of time are those that the frame takes.
TEST_P(SettingsTest, PreparedPipelinesAreTheFrames) {
    const FrameInput base = room();
    std::unique_ptr<Context> context;
    ASSERT_TRUE(Context::create(device().contextDesc({}), context).ok());
    FrameInput frame = base;
    frame.settings.listReservation = ListReservation::Accurate;
    ASSERT_TRUE(context->prepare(frame.settings).ok());
    const std::uint32_t made = context->pipelineCount();
    EXPECT_GT(made, 0u);
    ASSERT_TRUE(context->prepare(frame.settings).ok());
    Rig rig(device(), *context, poolsFor(base));
    ASSERT_TRUE(rig.ok());
    checkFrame(frame, rig.run(frame));
    EXPECT_EQ(context->pipelineCount(), made);
    // Another filter is another phase 4, by tile or by pair, and nothing else.
    useFilter(frame, Filter::Hard);
    checkFrame(frame, rig.run(frame));
    EXPECT_GT(context->pipelineCount(), made);
    EXPECT_LE(context->pipelineCount(), made + 2);
}

// Larger and smaller views, other pools, other bits of the pool.
TEST_P(SettingsTest, Resize) {
    RoomSetup setup = roomSetup();
    FrameInput input = room();
    Rig rig(device(), {}, poolsFor(input));
    ASSERT_TRUE(rig.ok());
    checkFrame(input, rig.run(input));
    struct Extent {
        std::uint32_t widthPx, heightPx;
    };
    for (const Extent extent : {Extent{56, 48}, Extent{97, 65}, Extent{8, 8}, Extent{120, 24}, Extent{56, 48}}) {
        SCOPED_TRACE(std::to_string(extent.widthPx) + "x" + std::to_string(extent.heightPx));
        setup.widthPx = extent.widthPx;
        setup.heightPx = extent.heightPx;
        renderRoom(input, setup);
        input.settings.visibilityBits = extent.widthPx % 2 == 0 ? 8 : 4;
        ViewDesc desc = viewDescFor(input);
        desc.visibilityBits = extent.widthPx > 100 ? 4 : 8;
        ASSERT_TRUE(rig.resize(desc).ok());
        const FrameResult result = rig.run(input);
        checkFrame(input, result);
        EXPECT_EQ(result.listCapacity, desc.listEntries / 3 * 3);
    }
}

// Pools change between frames that are still in flight; what those use is freed when they have finished.
TEST_P(SettingsTest, ResizeWhileFramesAreInFlight) {
    const FrameInput input = room();
    ViewDesc desc = poolsFor(input);
    desc.framesInFlight = 3;
    desc.guardBytes = kGuardBytes;
    Rig rig(device(), {}, desc);
    ASSERT_TRUE(rig.ok());
    const auto expected = decodeFinalLists(rig.run(input));
    for (int round = 0; round < 2; ++round) {
        rig.runInFlight({input, input, input}, [&](std::size_t) {
            desc.listEntries += 300;
            desc.visibilitySlots += 10;
            ASSERT_TRUE(rig.view().resize(desc).ok());
        });
        const FrameResult result = rig.run(input);
        checkFrame(input, result);
        EXPECT_EQ(decodeFinalLists(result), expected);
        EXPECT_EQ(result.listCapacity, desc.listEntries / 3 * 3);
        EXPECT_EQ(result.slotCapacity, desc.visibilitySlots);
    }
}

// Pools that are too small grow to what a finished frame would have needed, and no further than the host allows.
TEST_P(SettingsTest, PoolsGrow) {
    FrameInput input = room();
    for (const std::uint32_t bits : {8u, 4u}) {
        SCOPED_TRACE(bits);
        input.settings.visibilityBits = bits;
        Rig generous(device(), {}, poolsFor(input));
        ASSERT_TRUE(generous.ok());
        const FrameResult full = generous.run(input);
        const std::uint32_t entries = full.counters.listEntries, slots = full.counters.visibilitySlots;
        ViewDesc desc = viewDescFor(input);
        desc.listEntries = 60;
        desc.visibilitySlots = 10;
        desc.visibilityBits = 8;
        desc.mostListEntries = 42 * 96;
        desc.mostVisibilitySlots = 42 * 96;
        Rig growing(device(), {}, desc);
        ASSERT_TRUE(growing.ok());
        FrameResult last;
        for (int frame = 0; frame < 8; ++frame) {
            last = growing.run(input);
            const bool listsFit = last.listCapacity >= entries, slotsFit = last.slotCapacity >= slots;
            EXPECT_TRUE(frame < 6 || (listsFit && slotsFit)) << "frame " << frame;
            checkFrame(input, last,
                       {.bytes = listsFit && slotsFit, .listOverflow = !listsFit, .slotOverflow = !slotsFit});
        }
        EXPECT_EQ(last.counters.listOverflowTiles, 0u);
        EXPECT_EQ(last.counters.slotOverflowEntries, 0u);
        EXPECT_EQ(decodeFinalLists(last), decodeFinalLists(full));
        EXPECT_LE(last.listCapacity, desc.mostListEntries);
        desc.mostListEntries = entries / 2;
        desc.mostVisibilitySlots = 10;
        Rig bounded(device(), {}, desc);
        ASSERT_TRUE(bounded.ok());
        for (int frame = 0; frame < 6; ++frame) last = bounded.run(input);
        EXPECT_GT(last.listCapacity, 60u);
        EXPECT_LE(last.listCapacity, gpu::roundUpToEarlyWord(entries / 2));
        EXPECT_EQ(bounded.view().memory().visibilitySlots, 10u);
        checkFrame(input, last, {.bytes = false, .listOverflow = true, .slotOverflow = true});
    }
}

}  // namespace
}  // namespace gnomon::test
