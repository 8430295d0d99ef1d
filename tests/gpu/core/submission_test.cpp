// What is counted is what was executed: a frame that was recorded and never submitted has no statistics, and not those
// of the frame whose place it took.
#include "gpu/core/small_scene.h"

namespace gnomon::test {
namespace {

class Submission : public CoreTest {};

TEST_F(Submission, FramesThatWereNeverSubmittedAreNotCounted) {
    onEveryDevice([](const renderer::Device& device, const Context& context, SmallScene& scene) {
        const Shot shot, fewer = {.lights = 5};
        const FrameStatistics counts = countedAlone(device, context, scene, shot);
        const std::unique_ptr<View> view = makeView(context, smallView());
        renderer::Commands commands[2] = {renderer::Commands(device), renderer::Commands(device)};
        const auto submit = [&](std::uint64_t number) {
            ASSERT_TRUE(scene.begin(*view, shot, number));
            SmallScene::record(*view, shot, commands[number % 2].begin());
            commands[number % 2].submit();
        };
        submit(0);
        submit(1);
        for (renderer::Commands& c : commands) c.wait();
        renderer::Commands dropped(device);
        ASSERT_TRUE(scene.begin(*view, fewer, 2));
        SmallScene::record(*view, fewer, dropped.begin());  // in the place of frame 0
        FrameStatistics found;
        EXPECT_FALSE(view->statistics(2, found));
        EXPECT_FALSE(view->statistics(0, found)) << "its place is taken";
        ASSERT_TRUE(view->statistics(1, found));
        expectSameCounts(found, counts);
        submit(3);
        submit(4);
        for (renderer::Commands& c : commands) c.wait();
        for (const std::uint64_t number : {3u, 4u}) {
            ASSERT_TRUE(view->statistics(number, found)) << number;
            EXPECT_EQ(found.frameNumber, number);
            expectSameCounts(found, counts);
        }
    });
}

// Pools do not follow counts of a frame that did not happen.
TEST_F(Submission, PoolsFollowFramesThatWereSubmitted) {
    onEveryDevice([](const renderer::Device& device, const Context& context, SmallScene& scene) {
        ViewDesc desc = smallView();
        desc.framesInFlight = 1;
        desc.listEntries = desc.visibilitySlots = 64;
        desc.mostListEntries = desc.mostVisibilitySlots = 1u << 16;
        const std::unique_ptr<View> view = makeView(context, desc);
        renderer::Commands commands(device), dropped(device);
        const std::uint32_t before = view->memory().listEntries;
        ASSERT_TRUE(scene.begin(*view, {}, 0));
        SmallScene::record(*view, {}, dropped.begin());
        ASSERT_TRUE(scene.begin(*view, {}, 1));
        EXPECT_EQ(view->memory().listEntries, before);
        SmallScene::record(*view, {}, commands.begin());
        commands.submit();
        commands.wait();
        ASSERT_TRUE(scene.begin(*view, {}, 2));
        EXPECT_GT(view->memory().listEntries, before);
        SmallScene::record(*view, {}, commands.begin());
        commands.submit();
        commands.wait();
    });
}

}  // namespace
}  // namespace gnomon::test
