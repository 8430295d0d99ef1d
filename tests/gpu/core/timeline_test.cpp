// Timeline: rows of library and host in one table, in order of execution.
#include <gmock/gmock.h>

#include <string>

#include "gpu/core/small_scene.h"

namespace gnomon::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Devices whose queue has no timestamps say so.
class TimelineTest : public CoreTest {
protected:
    template <typename Body>
    static void onEveryDeviceThatMeasures(const Body& body) {
        onEveryDevice([&](const renderer::Device& device, const Context& context, SmallScene& scene) {
            EXPECT_EQ(makeTimeline(context, {})->records(), device.timestampPeriodNs() != 0.0);
            if (device.timestampPeriodNs() == 0.0) {
                std::printf("skipped: %s has no timestamps\n", device.info().name.c_str());
                return;
            }
            body(device, context, scene);
        });
    }
};

std::vector<std::string> namesOf(std::span<const TimelineRow> rows) {
    std::vector<std::string> names;
    for (const TimelineRow& row : rows) names.emplace_back(row.name);
    return names;
}

void expectInOrder(std::span<const TimelineRow> rows) {
    double before = 0.0;
    for (const TimelineRow& row : rows) {
        EXPECT_GE(row.beginMilliseconds, before) << row.name;
        EXPECT_GE(row.endMilliseconds, row.beginMilliseconds) << row.name;
        EXPECT_LT(row.endMilliseconds, 60000.0) << row.name;
        before = row.beginMilliseconds;
    }
    if (!rows.empty()) {
        EXPECT_EQ(rows.front().beginMilliseconds, 0.0);
    }
}

TEST_F(TimelineTest, HoldsRowsOfHostAndLibraryInOrder) {
    onEveryDeviceThatMeasures([](const renderer::Device& device, const Context& context, SmallScene& scene) {
        const std::unique_ptr<Timeline> timeline = makeTimeline(context, {});
        Shot shot = {.timeline = timeline.get(), .hostRows = true};
        shot.settings.shadowBounds = true;
        shot.settings.lightLists = LightLists::Pixel;
        shot.settings.filters = only(Filter::PcssShared);
        const std::unique_ptr<View> view = makeView(context, smallView());
        Frames frames(device, scene, 2);
        for (int i = 0; i < 3; ++i) {
            const std::uint64_t number = frames.run(*view, shot);
            frames.wait();
            const auto rows = timeline->rows(number);
            expectInOrder(rows);
            ASSERT_THAT(namesOf(rows),
                        ElementsAre("gbuffer", "hierarchical_depth", "find_lights_approximate", "find_lights_accurate",
                                    "shadowmaps", "shadow_bounds", "classify_pairs", "search_pairs", "filter_pairs",
                                    "lighting", "gather_statistics"));
            const Phase phases[] = {Phase::Host,
                                    Phase::HierarchicalDepth,
                                    Phase::FindLightsApproximate,
                                    Phase::FindLightsAccurate,
                                    Phase::Host,
                                    Phase::ShadowBounds,
                                    Phase::GenerateShadows,
                                    Phase::GenerateShadows,
                                    Phase::GenerateShadows,
                                    Phase::Lighting,
                                    Phase::Statistics};
            ASSERT_EQ(rows.size(), std::size(phases));
            for (std::size_t r = 0; r < rows.size(); ++r) EXPECT_EQ(rows[r].phase, phases[r]) << rows[r].name;
            EXPECT_EQ(rows[0].kind, RowKind::Drawing);
            EXPECT_EQ(rows[1].kind, RowKind::Compute);
            EXPECT_GT(rows.back().endMilliseconds, 0.0);
            EXPECT_EQ(timeline->lostRows(number), 0u);
        }
    });
}

// Recorded in one order, executed in another: the table follows what the device did.
TEST_F(TimelineTest, FollowsExecutionAndNotRecording) {
    onEveryDeviceThatMeasures([](const renderer::Device& device, const Context& context, SmallScene&) {
        const std::unique_ptr<Timeline> timeline = makeTimeline(context, {});
        renderer::Buffer buffer(device, "work", 1 << 20, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        renderer::Commands first(device), second(device);
        device.submitAndWait([&](VkCommandBuffer c) { timeline->beginFrame(c, 7); });
        const auto work = [&](renderer::Commands& commands, const char* name) {
            const VkCommandBuffer c = commands.begin();
            const Timeline::Row row = timeline->begin(c, name, Phase::Host, RowKind::Transfer);
            vkCmdFillBuffer(c, buffer.handle(), 0, VK_WHOLE_SIZE, 1);
            timeline->end(c, row);
        };
        work(first, "recorded first");
        work(second, "recorded second");
        second.submit();
        second.wait();
        first.submit();
        first.wait();
        const auto rows = timeline->rows(7);
        EXPECT_THAT(namesOf(rows), ElementsAre("recorded second", "recorded first"));
        expectInOrder(rows);
    });
}

TEST_F(TimelineTest, CountsRowsWithoutSpace) {
    onEveryDeviceThatMeasures([](const renderer::Device& device, const Context& context, SmallScene& scene) {
        const std::unique_ptr<Timeline> timeline = makeTimeline(context, {.maxRows = 3});
        const Shot shot = {.timeline = timeline.get(), .hostRows = true};
        const std::unique_ptr<View> view = makeView(context, smallView());
        Frames frames(device, scene, 2);
        for (int i = 0; i < 3; ++i) {
            const std::uint64_t number = frames.run(*view, shot);
            frames.wait();
            EXPECT_THAT(namesOf(timeline->rows(number)),
                        ElementsAre("gbuffer", "hierarchical_depth", "find_lights_approximate"));
            EXPECT_EQ(timeline->lostRows(number), 4u) << "each frame counts anew";
        }
        EXPECT_EQ(timeline->lostRows(100), 0u);
        // Beyond the space there is no row, and ending none is nothing.
        device.submitAndWait([&](VkCommandBuffer c) {
            timeline->beginFrame(c, 3);
            for (std::uint32_t i = 0; i < 3; ++i)
                EXPECT_NE(timeline->begin(c, "row", Phase::Host, RowKind::Compute), Timeline::kNone);
            const Timeline::Row none = timeline->begin(c, "row", Phase::Host, RowKind::Compute);
            EXPECT_EQ(none, Timeline::kNone);
            timeline->end(c, none);
        });
        EXPECT_EQ(timeline->lostRows(3), 1u);
        EXPECT_THAT(timeline->rows(3), IsEmpty()) << "none was ended";
    });
}

TEST_F(TimelineTest, LeavesOutRowsThatWereNotEnded) {
    onEveryDeviceThatMeasures([](const renderer::Device& device, const Context& context, SmallScene&) {
        const std::unique_ptr<Timeline> timeline = makeTimeline(context, {});
        device.submitAndWait([&](VkCommandBuffer c) {
            timeline->beginFrame(c, 0);
            const Timeline::Row whole = timeline->begin(c, "whole", Phase::Host, RowKind::Compute);
            (void)timeline->begin(c, "begun", Phase::Host, RowKind::Compute);
            const Timeline::Row within = timeline->begin(c, "within", Phase::Host, RowKind::Compute);
            timeline->end(c, within);
            timeline->end(c, whole);
            timeline->end(c, whole);  // once is enough
        });
        const auto rows = timeline->rows(0);
        EXPECT_THAT(namesOf(rows), ElementsAre("whole", "within"));
        expectInOrder(rows);
        EXPECT_GE(rows[0].endMilliseconds, rows[1].endMilliseconds);
    });
}

TEST_F(TimelineTest, KnowsTheLastFramesAlone) {
    onEveryDeviceThatMeasures([](const renderer::Device& device, const Context& context, SmallScene& scene) {
        for (const std::uint32_t inFlight : {1u, 3u}) {
            const std::unique_ptr<Timeline> timeline = makeTimeline(context, {.framesInFlight = inFlight});
            EXPECT_THAT(timeline->rows(0), IsEmpty());
            const Shot shot = {.timeline = timeline.get()};
            const std::unique_ptr<View> view = makeView(context, smallView(64, 64, inFlight));
            Frames frames(device, scene, inFlight);
            std::uint64_t last = 0;
            for (int i = 0; i < 6; ++i) last = frames.run(*view, shot);
            frames.wait();
            for (std::uint64_t number = 0; number <= last; ++number) {
                const bool known = number + inFlight > last;
                EXPECT_EQ(timeline->rows(number).size(), known ? 4u : 0u) << number << " of " << last;
            }
            EXPECT_THAT(timeline->rows(last + 1), IsEmpty());
            EXPECT_THAT(timeline->rows(last + inFlight), IsEmpty());
        }
    });
}

}  // namespace
}  // namespace gnomon::test
