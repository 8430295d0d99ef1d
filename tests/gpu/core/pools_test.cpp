// Pools that follow what finished frames would have needed: ViewDesc::mostListEntries and mostVisibilitySlots.
#include <gmock/gmock.h>

#include "gpu/core/small_scene.h"

namespace gnomon::test {
namespace {

class Pools : public CoreTest {};

bool overflowed(const FrameStatistics& s) {
    return s.listOverflowTiles != 0 || s.slotOverflowEntries != 0;
}

// The statistics of frames 0 to count - 1 of a new view, each read as soon as a host that never waits may read it.
std::vector<FrameStatistics> runFrames(const renderer::Device& device, const Context& context, SmallScene& scene,
                                       const ViewDesc& desc, std::uint32_t count, const Shot& shot) {
    const std::unique_ptr<View> view = makeView(context, desc);
    const std::uint32_t inFlight = desc.framesInFlight;
    std::vector<std::unique_ptr<renderer::Commands>> commands;
    for (std::uint32_t i = 0; i < inFlight; ++i) commands.push_back(std::make_unique<renderer::Commands>(device));
    std::vector<FrameStatistics> out(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const VkCommandBuffer c = commands[i % inFlight]->begin();  // waits for frame i - inFlight
        if (i >= inFlight) {
            EXPECT_TRUE(view->statistics(i - inFlight, out[i - inFlight]));
        }
        const Result begun = scene.begin(*view, shot, i);
        EXPECT_TRUE(begun) << begun.message();
        SmallScene::record(*view, shot, c);
        commands[i % inFlight]->submit();
    }
    for (const auto& c : commands) c->wait();
    for (std::uint32_t i = count - std::min(count, inFlight); i < count; ++i) EXPECT_TRUE(view->statistics(i, out[i]));
    return out;
}

ViewDesc starved(std::uint32_t inFlight) {
    ViewDesc desc = smallView(64, 64, inFlight);
    desc.listEntries = 90;
    desc.visibilitySlots = 10;
    return desc;
}

TEST_F(Pools, FollowAnOverflow) {
    onEveryDevice([](const renderer::Device& device, const Context& context, SmallScene& scene) {
        for (const std::uint32_t bits : {8u, 4u}) {
            Shot shot;
            shot.settings.visibilityBits = bits;
            const FrameStatistics counts = countedAlone(device, context, scene, shot);
            for (const std::uint32_t inFlight : {1u, 2u, 4u}) {
                ViewDesc desc = starved(inFlight);
                desc.mostListEntries = desc.mostVisibilitySlots = 100000;
                const auto frames = runFrames(device, context, scene, desc, inFlight + 4, shot);
                EXPECT_GT(frames[0].listOverflowTiles, 0u);
                EXPECT_LE(frames[0].listCapacity, desc.listEntries);
                for (std::uint32_t i = 0; i < frames.size(); ++i) {
                    if (i < inFlight) {
                        EXPECT_TRUE(overflowed(frames[i])) << "of " << inFlight << ", frame " << i;
                    }
                    if (i <= inFlight) continue;
                    EXPECT_FALSE(overflowed(frames[i])) << "of " << inFlight << ", frame " << i;
                    expectSameCounts(frames[i], counts);
                    EXPECT_GE(frames[i].listCapacity, counts.listEntries);
                    EXPECT_GE(frames[i].slotCapacity, counts.visibilitySlots);
                    // They follow the need, and do not run away from it.
                    EXPECT_LE(frames[i].listCapacity, frames[0].recommendedListEntries + 2);
                    EXPECT_LE(frames[i].slotCapacity, frames[0].recommendedVisibilitySlots + 1);
                    EXPECT_EQ(frames[i].listCapacity, frames.back().listCapacity);
                    EXPECT_EQ(frames[i].slotCapacity, frames.back().slotCapacity);
                }
            }
        }
    });
}

TEST_F(Pools, NeverExceedTheirLimit) {
    onEveryDevice([](const renderer::Device& device, const Context& context, SmallScene& scene) {
        // Whole words of three entries, and not; no more than there is; less than there is.
        for (const std::uint32_t most : {150u, 151u, 152u, 90u, 20u}) {
            ViewDesc desc = starved(2);
            desc.mostListEntries = most;
            desc.mostVisibilitySlots = most / 3;
            const auto frames = runFrames(device, context, scene, desc, 7, {});
            for (std::uint32_t i = 0; i < frames.size(); ++i) {
                EXPECT_TRUE(overflowed(frames[i]));
                EXPECT_LE(frames[i].listCapacity, std::max(most, desc.listEntries)) << "of " << most << ", frame " << i;
                EXPECT_LE(frames[i].slotCapacity, std::max(most / 3, desc.visibilitySlots)) << "of " << most;
            }
            EXPECT_GE(frames.back().listCapacity, std::max(most / 3 * 3, desc.listEntries)) << most;
            EXPECT_GE(frames.back().slotCapacity, std::max(most / 3, desc.visibilitySlots)) << most;
        }
    });
}

// One pool may follow while the other stays; without the option, both stay.
TEST_F(Pools, StayWithoutTheOption) {
    onEveryDevice([](const renderer::Device& device, const Context& context, SmallScene& scene) {
        for (const bool lists : {false, true}) {
            for (const bool slots : {false, true}) {
                if (lists && slots) continue;
                ViewDesc desc = starved(2);
                if (lists) desc.mostListEntries = 100000;
                if (slots) desc.mostVisibilitySlots = 100000;
                const auto frames = runFrames(device, context, scene, desc, 6, {});
                for (const FrameStatistics& frame : frames) {
                    if (!lists) {
                        EXPECT_EQ(frame.listCapacity, desc.listEntries);
                    }
                    if (!slots) {
                        EXPECT_EQ(frame.slotCapacity, desc.visibilitySlots);
                    }
                }
                if (lists) {
                    EXPECT_EQ(frames.back().listOverflowTiles, 0u);
                }
                if (!lists && !slots) {
                    EXPECT_TRUE(overflowed(frames.back()));
                }
                EXPECT_GE(frames.back().listCapacity, desc.listEntries);
            }
        }
    });
}

// Pools that suffice stay as they are, whatever they may become.
TEST_F(Pools, StayWhereTheySuffice) {
    onEveryDevice([](const renderer::Device& device, const Context& context, SmallScene& scene) {
        const FrameStatistics counts = countedAlone(device, context, scene, {});
        ViewDesc desc = smallView();
        desc.listEntries = (counts.listEntries + 2) / 3 * 3;
        desc.visibilitySlots = counts.visibilitySlots;
        desc.mostListEntries = desc.mostVisibilitySlots = 100000;
        const auto frames = runFrames(device, context, scene, desc, 5, {});
        for (const FrameStatistics& frame : frames) {
            expectSameCounts(frame, counts);
            EXPECT_EQ(frame.listCapacity, desc.listEntries);
            EXPECT_EQ(frame.slotCapacity, desc.visibilitySlots);
        }
    });
}

// A resize that asks for the same pools as before keeps what has grown. One that asks for other pools gets them, and
// they grow again.
TEST_F(Pools, KeepTheirSizeThroughAResizeUnlessOtherPoolsAreAskedFor) {
    onEveryDevice([](const renderer::Device& device, const Context& context, SmallScene& scene) {
        ViewDesc desc = starved(2);
        desc.mostListEntries = desc.mostVisibilitySlots = 100000;
        const std::unique_ptr<View> view = makeView(context, desc);
        Frames frames(device, scene, 2);
        for (int round = 0; round < 3; ++round) {
            std::uint64_t last = 0;
            for (int i = 0; i < 4; ++i) last = frames.run(*view, {});
            frames.wait();
            FrameStatistics s;
            ASSERT_TRUE(view->statistics(last, s));
            EXPECT_FALSE(overflowed(s)) << round;
            EXPECT_GT(s.listCapacity, desc.listEntries);
            desc.maxWidthPx += 8;
            ASSERT_TRUE(view->resize(desc));
            EXPECT_EQ(view->memory().listEntries, s.listCapacity);
            EXPECT_EQ(view->memory().visibilitySlots, s.slotCapacity);
            desc.listEntries += 3;
            desc.visibilitySlots += 1;
            ASSERT_TRUE(view->resize(desc));
            EXPECT_EQ(view->memory().listEntries, desc.listEntries);
            EXPECT_EQ(view->memory().visibilitySlots, desc.visibilitySlots);
        }
    });
}

}  // namespace
}  // namespace gnomon::test
