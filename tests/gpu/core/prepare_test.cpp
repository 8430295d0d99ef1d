// Context::prepare: pipelines are made once per settings, on any thread, and never by a frame whose settings are known.
#include <gmock/gmock.h>

#include <atomic>
#include <set>
#include <span>
#include <thread>

#include "core/passes.h"
#include "gpu/core/small_scene.h"

namespace gnomon::test {
namespace {

class PrepareTest : public CoreTest {};

Shot shotOf(const ShadowSettings& settings) {
    Shot shot;
    shot.settings = settings;
    return shot;
}

// Settings that differ, with pipelines in common. Hard shadows: other filters take software devices long to compile.
std::vector<ShadowSettings> someSettings() {
    std::vector<ShadowSettings> out(4, ShadowSettings{.filters = only(Filter::Hard)});
    out[1].visibilityBits = 4;
    out[2].depthBias = DepthBias::Unbiased;
    out[3].visibilityBits = 4;
    out[3].depthBias = DepthBias::Unbiased;
    return out;
}

// How many pipelines these settings need: one per pass and set of values of the constants that it declares. Hard
// shadows are filtered tile by tile, so there are no pairs; and phase 2 writes the lists.
std::uint32_t pipelinesOf(const Context& context, std::span<const ShadowSettings> all) {
    std::set<std::pair<std::uint32_t, std::vector<std::uint32_t>>> distinct;
    for (const ShadowSettings& settings : all) {
        for (std::uint32_t id = 0; id < kPassCount; ++id) {
            if (id == kPassClassifyPairs || id == kPassSearchPairs || id == kPassFilterPairs) continue;
            if (id == kPassFindLightsAccurate) continue;
            std::vector<std::uint32_t> values;
            for (const std::uint32_t constant : passOf(static_cast<PassId>(id)).specialization)
                values.push_back(context.specialization(settings).values[constant]);
            distinct.insert({id, values});
        }
    }
    return static_cast<std::uint32_t>(distinct.size());
}

TEST_F(PrepareTest, MakesPipelinesOnce) {
    onEveryDevice([](const renderer::Device& device, const Context&, SmallScene& scene) {
        const std::unique_ptr<Context> context = makeContext(device);
        const std::unique_ptr<View> view = makeView(*context, smallView());
        Frames frames(device, scene, 2);
        EXPECT_EQ(context->pipelineCount(), 0u);
        const std::vector<ShadowSettings> all = someSettings();
        std::uint32_t count = 0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            ASSERT_TRUE(context->prepare(all[i]));
            EXPECT_GT(context->pipelineCount(), count);
            count = context->pipelineCount();
            EXPECT_EQ(count, pipelinesOf(*context, std::span(all).first(i + 1)));
            const ShadowSettings equal = all[i];
            ASSERT_TRUE(context->prepare(equal));
            frames.run(*view, shotOf(all[i]));
            frames.run(*view, shotOf(all[i]));
            EXPECT_EQ(context->pipelineCount(), count);
        }
        for (const ShadowSettings& settings : all) frames.run(*view, shotOf(settings));
        EXPECT_EQ(context->pipelineCount(), count);
        frames.wait();
        // A frame of settings that nobody prepared makes them itself, once.
        ShadowSettings fresh;
        fresh.filters = only(Filter::Hard);
        fresh.facedAwayIsDark = false;
        frames.run(*view, shotOf(fresh));
        EXPECT_GT(context->pipelineCount(), count);
        count = context->pipelineCount();
        ASSERT_TRUE(context->prepare(fresh));
        frames.run(*view, shotOf(fresh));
        EXPECT_EQ(context->pipelineCount(), count);
        frames.wait();
    });
}

// beginFrame() and prepare() refuse with the sentence of checkSettings(); the view then goes on.
TEST_F(PrepareTest, BadSettingsAreRefused) {
    onEveryDevice([](const renderer::Device& device, const Context& shared, SmallScene& scene) {
        const std::unique_ptr<View> view = makeView(shared, smallView());
        const std::uint32_t before = shared.pipelineCount();
        std::vector<ShadowSettings> bad(4, ShadowSettings{.filters = only(Filter::Pcf)});
        bad[0].pcfRadius = 9;
        bad[1].visibilityBits = 7;
        bad[2].pcssPresetCount = 0;
        bad[3].listReservation = ListReservation::Fixed;
        for (const ShadowSettings& settings : bad) {
            const Result checked = checkSettings(settings);
            ASSERT_FALSE(checked);
            EXPECT_STREQ(shared.prepare(settings).message(), checked.message());
            const Result begun = scene.begin(*view, shotOf(settings), 0);
            EXPECT_EQ(begun.status(), Status::BadArgument);
            EXPECT_STREQ(begun.message(), checked.message());
        }
        const ShadowSettings host = {.filters = only(Filter::Host)};
        EXPECT_THAT(shared.prepare(host).message(), ::testing::HasSubstr("filterPairsSpirv"));
        EXPECT_EQ(shared.pipelineCount(), before);
        Frames frames(device, scene, 2);
        const std::uint64_t number = frames.run(*view, {});
        frames.wait();
        FrameStatistics found;
        ASSERT_TRUE(view->statistics(number, found));
        expectSameCounts(found, countedAlone(device, shared, scene, {}));
    });
}

// Two threads prepare different and equal settings at once, while a third records and submits frames.
TEST_F(PrepareTest, ThreadsMayPrepareWhileFramesAreRecorded) {
    onEveryDevice([](const renderer::Device& device, const Context& shared, SmallScene& scene) {
        const std::vector<ShadowSettings> settings = someSettings();
        const std::unique_ptr<Context> context = makeContext(device);
        const std::unique_ptr<View> view = makeView(*context, smallView());
        Frames frames(device, scene, 2);
        ASSERT_TRUE(context->prepare(settings[0]));
        const std::uint32_t expected = pipelinesOf(*context, settings);
        std::atomic<std::uint32_t> ready = 0, done = 0, refused = 0;
        const auto prepareAll = [&](bool backwards) {
            ++ready;
            while (ready < 2) std::this_thread::yield();
            for (std::size_t i = 0; i < settings.size(); ++i) {
                const ShadowSettings& s = settings[backwards ? settings.size() - 1 - i : i];
                if (!context->prepare(s)) ++refused;
            }
            ++done;
        };
        std::thread forth(prepareAll, false), back(prepareAll, true);
        std::uint64_t last = 0;
        std::uint32_t recorded = 0;
        while (done < 2 || recorded < 6) {
            last = frames.run(*view, shotOf(settings[recorded % 2 == 0 ? 0 : 2]));
            ++recorded;
        }
        forth.join();
        back.join();
        EXPECT_EQ(refused, 0u);
        EXPECT_EQ(context->pipelineCount(), expected);
        last = frames.run(*view, shotOf(settings[1]));
        frames.wait();
        EXPECT_EQ(context->pipelineCount(), expected);
        FrameStatistics found;
        ASSERT_TRUE(view->statistics(last, found));
        expectSameCounts(found, countedAlone(device, shared, scene, shotOf(settings[1])));
    });
}

// Two contexts of one device, with other limits each, take turns; then one goes, and the other lives on.
TEST_F(PrepareTest, ContextsStandSideBySide) {
    onEveryDevice([](const renderer::Device& device, const Context& shared, SmallScene& scene) {
        const FrameStatistics counts = countedAlone(device, shared, scene, {});
        std::unique_ptr<Context> other = makeContext(device, {.maxShadowAtlases = 1});
        const std::unique_ptr<View> view = makeView(shared, smallView());
        std::unique_ptr<View> otherView = makeView(*other, smallView());
        Frames frames(device, scene, 2), otherFrames(device, scene, 2);
        const std::uint32_t before = shared.pipelineCount();
        std::uint64_t number = 0, otherNumber = 0;
        for (int i = 0; i < 3; ++i) {
            number = frames.run(*view, {});
            otherNumber = otherFrames.run(*otherView, {});
        }
        frames.wait();
        otherFrames.wait();
        FrameStatistics found;
        ASSERT_TRUE(view->statistics(number, found));
        expectSameCounts(found, counts);
        ASSERT_TRUE(otherView->statistics(otherNumber, found));
        expectSameCounts(found, counts);
        EXPECT_EQ(other->pipelineCount(), 5u);      // of all passes but phase 3 and those of pairs
        EXPECT_EQ(shared.pipelineCount(), before);  // one context makes none for the other
        otherView.reset();
        other.reset();
        number = frames.run(*view, {});
        frames.wait();
        ASSERT_TRUE(view->statistics(number, found));
        expectSameCounts(found, counts);
    });
}

// Contexts of all devices at once: the frames of one lie between those of the others.
TEST_F(PrepareTest, DevicesStandSideBySide) {
    std::vector<SharedDevice*> devices;
    for (const renderer::DeviceInfo& info : suitable()) devices.push_back(&shared(info));
    ASSERT_FALSE(devices.empty());
    std::vector<std::unique_ptr<View>> views;
    std::vector<std::unique_ptr<Frames>> frames;
    for (SharedDevice* d : devices) {
        views.push_back(makeView(*d->context, smallView()));
        frames.push_back(std::make_unique<Frames>(d->device, d->scene, 2));
    }
    for (int i = 0; i < 3; ++i) {
        for (std::size_t d = 0; d < devices.size(); ++d) frames[d]->run(*views[d], {});
    }
    for (std::size_t d = 0; d < devices.size(); ++d) {
        frames[d]->wait();
        FrameStatistics found;
        ASSERT_TRUE(views[d]->statistics(2, found));
        expectSameCounts(found, countedAlone(devices[d]->device, *devices[d]->context, devices[d]->scene, {}));
    }
    expectNoMessages();
}

}  // namespace
}  // namespace gnomon::test
