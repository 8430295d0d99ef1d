// View::resize: another extent, other pools, while frames are in flight.
#include <gmock/gmock.h>

#include <map>
#include <set>
#include <string>

#include "gpu/core/small_scene.h"

namespace gnomon::test {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

class Resize : public CoreTest {};

// Buffers by name; those of a frame in flight are those of the frame begun last.
std::map<std::string, VkBuffer> buffersOf(const View& view) {
    std::map<std::string, VkBuffer> out;
    for (const BufferMemory& buffer : view.memory().buffers()) out[buffer.name] = view.buffer(buffer.name);
    return out;
}

std::map<std::string, std::uint64_t> bytesOf(const View& view) {
    std::map<std::string, std::uint64_t> out;
    for (const BufferMemory& buffer : view.memory().buffers()) out[buffer.name] = buffer.bytes;
    return out;
}

void expectCounts(const View& view, std::uint64_t frame, const FrameStatistics& expected) {
    FrameStatistics found;
    ASSERT_TRUE(view.statistics(frame, found));
    EXPECT_EQ(found.frameNumber, frame);
    expectSameCounts(found, expected);
}

// The names of buffers that are others than before.
std::set<std::string> changed(const std::map<std::string, VkBuffer>& before,
                              const std::map<std::string, VkBuffer>& now) {
    std::set<std::string> out;
    for (const auto& [name, buffer] : now) {
        // The host reads this one; it cannot be copied from.
        if (name != "statistics_readback") {
            EXPECT_NE(buffer, VkBuffer{VK_NULL_HANDLE}) << name;
        }
        if (before.at(name) != buffer) out.insert(name);
    }
    return out;
}

// A buffer is another one exactly where its size is another one. The new one may not have an old handle: the old
// buffers still live, since their frames are in flight.
TEST_F(Resize, MakesOnlyTheBuffersWhoseSizeChanges) {
    onEveryDevice([](const renderer::Device& device, const Context& context, SmallScene& scene) {
        const ViewDesc first = smallView();
        ViewDesc wider = first, longer = first, more = first, views = first, bounds = first;
        wider.maxWidthPx = 128;
        longer.listEntries = 30000;
        more.visibilitySlots = 30000;
        views.maxShadowViews = 100;
        bounds.shadowBoundsTexels *= 4;
        const struct {
            const char* what;
            ViewDesc desc;
            std::set<std::string> buffers;
        } cases[] = {
            {"nothing", first, {}},
            {"lists", longer, {"early_light_list", "final_light_list", "list_tiles", "queued_pairs"}},
            {"slots", more, {"visibility"}},
            {"views", views, {"shadow_views"}},
            {"bounds", bounds, {"shadow_bounds", "shadow_bounds_cells"}},
            {"width",
             wider,
             {"tile_light_masks", "tile_group_light_masks", "tile_depth_ranges", "tile_depth_slices",
              "tile_light_slot_ids", "approximate_counts", "early_counts", "final_counts", "evaluate_tiles"}},
        };
        for (const auto& c : cases) {
            SCOPED_TRACE(c.what);
            const std::unique_ptr<View> view = makeView(context, first);
            Frames frames(device, scene, 2);
            frames.run(*view, {});
            frames.run(*view, {});
            const auto before = buffersOf(*view);
            const auto bytesBefore = bytesOf(*view);
            const Result resized = view->resize(c.desc);
            ASSERT_TRUE(resized) << resized.message();
            const auto now = buffersOf(*view);  // of the same frame in flight
            EXPECT_EQ(changed(before, now), c.buffers);
            for (const auto& [name, bytes] : bytesOf(*view))
                EXPECT_EQ(bytes != bytesBefore.at(name), c.buffers.contains(name)) << name;
            frames.run(*view, {});
            frames.wait();
        }
    });
}

TEST_F(Resize, FramesGoOnThroughGrowingAndShrinking) {
    onEveryDevice([](const renderer::Device& device, const Context& context, SmallScene& scene) {
        const Shot small = {.widthPx = 64, .heightPx = 64}, large = {.widthPx = 104, .heightPx = 136, .lights = 24},
                   tiny = {.widthPx = 24, .heightPx = 17};
        const FrameStatistics smallCounts = countedAlone(device, context, scene, small),
                              largeCounts = countedAlone(device, context, scene, large),
                              tinyCounts = countedAlone(device, context, scene, tiny);
        ViewDesc desc = smallView(64, 64);
        const std::unique_ptr<View> view = makeView(context, desc);
        Frames frames(device, scene, 2);
        frames.run(*view, small);
        std::uint64_t last = frames.run(*view, small);
        // Too large, until the view is.
        PreparedLights prepared;
        EXPECT_FALSE(view->prepare(scene.input(large), prepared));

        desc.maxWidthPx = 104;
        desc.maxHeightPx = 136;
        ASSERT_TRUE(view->resize(desc));  // two frames are in flight
        std::uint64_t next = frames.run(*view, large);
        frames.wait();
        expectCounts(*view, last, smallCounts);  // was in flight while its buffers were replaced
        next = frames.run(*view, large);
        frames.wait();
        expectCounts(*view, next - 1, largeCounts);
        expectCounts(*view, next, largeCounts);

        desc.listEntries *= 2;
        desc.visibilitySlots *= 2;
        last = frames.run(*view, large);
        ASSERT_TRUE(view->resize(desc));
        EXPECT_EQ(view->memory().visibilitySlots, desc.visibilitySlots);
        next = frames.run(*view, large);
        frames.wait();
        expectCounts(*view, last, largeCounts);
        expectCounts(*view, next, largeCounts);
        FrameStatistics found;
        ASSERT_TRUE(view->statistics(last, found));
        EXPECT_EQ(found.slotCapacity, desc.visibilitySlots / 2);  // what the frame had
        ASSERT_TRUE(view->statistics(next, found));
        EXPECT_EQ(found.slotCapacity, desc.visibilitySlots);

        desc = smallView(24, 17);
        desc.listEntries = desc.visibilitySlots = 4000;
        frames.run(*view, large);
        ASSERT_TRUE(view->resize(desc));
        EXPECT_FALSE(view->prepare(scene.input(small), prepared));
        for (int i = 0; i < 5; ++i) next = frames.run(*view, tiny);
        frames.wait();
        expectCounts(*view, next - 1, tinyCounts);
        expectCounts(*view, next, tinyCounts);
    });
}

// As a host does that follows the size of its window. Validation tells a buffer that is freed too early, and, when the
// device goes, one that is never freed.
TEST_F(Resize, EveryFrame) {
    onEveryDevice([](const renderer::Device& device, const Context& context, SmallScene& scene) {
        for (const std::uint32_t inFlight : {1u, 3u, 4u}) {
            const std::unique_ptr<View> view = makeView(context, smallView(64, 64, inFlight));
            Frames frames(device, scene, inFlight);
            std::uint64_t last = 0;
            Shot shot;
            for (std::uint32_t i = 0; i < 9; ++i) {
                shot.widthPx = 24 + 40 * (i % 3);
                shot.heightPx = 40 + 32 * (i % 2);
                ViewDesc desc = smallView(shot.widthPx, shot.heightPx, inFlight);
                desc.listEntries += 999 * i;
                ASSERT_TRUE(view->resize(desc));
                ASSERT_TRUE(view->resize(desc));  // twice is fine
                last = frames.run(*view, shot);
            }
            frames.wait();
            expectCounts(*view, last, countedAlone(device, context, scene, shot));
        }
    });
}

TEST_F(Resize, RefusesWhatCannotChange) {
    onEveryDevice([](const renderer::Device& device, const Context& context, SmallScene& scene) {
        const ViewDesc desc = smallView();
        const std::unique_ptr<View> view = makeView(context, desc);
        Frames frames(device, scene, 2);
        frames.run(*view, {});
        const auto before = buffersOf(*view);
        ViewDesc other[5] = {desc, desc, desc, desc, desc};
        other[0].framesInFlight = 3;
        other[1].guardBytes = 256;
        other[2].statistics = false;
        other[3].maxWidthPx = 0;
        other[4].maxHeightPx = 16385;
        for (int i = 0; i < 5; ++i) {
            other[i].listEntries = 50000;
            const Result result = view->resize(other[i]);
            EXPECT_EQ(result.status(), Status::BadArgument) << i;
            EXPECT_THAT(result.message(), MatchesRegex("^.+\\.$")) << "not a sentence";
            if (i < 3) {
                EXPECT_THAT(result.message(), HasSubstr("cannot change framesInFlight, guardBytes or statistics"));
            }
        }
        EXPECT_TRUE(changed(before, buffersOf(*view)).empty());
        const std::uint64_t last = frames.run(*view, {});
        frames.wait();
        expectCounts(*view, last, countedAlone(device, context, scene, {}));
    });
}

// What phase 1 goes by is a limit of the view, too.
TEST_F(Resize, PassesOnTheLimitsOfPhase1) {
    onEveryDevice([](const renderer::Device&, const Context& context, SmallScene& scene) {
        ViewDesc desc = smallView();
        const std::unique_ptr<View> view = makeView(context, desc);
        Light light;
        light.position[2] = -4.0f;
        ViewInput input = scene.input({});
        input.lights = {&light, 1};
        PreparedLights prepared;
        ASSERT_TRUE(view->prepare(input, prepared));
        ASSERT_EQ(prepared.visible.size(), 1u);
        const float farthest = prepared.visible[0].farthestMetres;
        desc.prepare.rangeCutoffLux /= 4.0f;  // half as dark: twice as far
        ASSERT_TRUE(view->resize(desc));
        ASSERT_TRUE(view->prepare(input, prepared));
        EXPECT_NEAR(prepared.visible[0].farthestMetres - 4.0f, 2.0f * (farthest - 4.0f), 0.01f);
        desc.prepare.rangeCutoffLux = -1.0f;
        EXPECT_FALSE(view->resize(desc));
    });
}

TEST_F(Resize, ReportsTheMemoryThatItHas) {
    onEveryDevice([](const renderer::Device&, const Context& context, SmallScene&) {
        const std::unique_ptr<View> view = makeView(context, smallView());
        for (const ViewDesc& desc : {smallView(200, 100), smallView(16, 16), smallView()}) {
            MemoryReport asked;
            ASSERT_TRUE(View::memory(context, desc, asked));
            ASSERT_TRUE(view->resize(desc));
            EXPECT_EQ(view->memory().totalBytes, asked.totalBytes);
            EXPECT_EQ(view->memory().listEntries, asked.listEntries);
            EXPECT_EQ(view->memory().visibilitySlots, asked.visibilitySlots);
        }
    });
}

// Shadow bounds stay as they are, unless their own size changes: the pass is recorded only where a cell must be made.
TEST_F(Resize, KeepsShadowBounds) {
    onEveryDevice([](const renderer::Device& device, const Context& context, SmallScene& scene) {
        const std::unique_ptr<Timeline> timeline = makeTimeline(context, {});
        if (!timeline->records()) {
            std::printf("skipped: %s has no timestamps\n", device.info().name.c_str());
            return;
        }
        Shot shot = {.timeline = timeline.get()};
        shot.settings.shadowBounds = true;
        ViewDesc desc = smallView();
        const std::unique_ptr<View> view = makeView(context, desc);
        Frames frames(device, scene, 2);
        const auto makesBounds = [&](bool viewsChanged) {
            shot.viewsChanged = viewsChanged;
            const std::uint64_t number = frames.run(*view, shot);
            frames.wait();
            for (const TimelineRow& row : timeline->rows(number))
                if (row.phase == Phase::ShadowBounds) return true;
            return false;
        };
        EXPECT_TRUE(makesBounds(true));
        EXPECT_FALSE(makesBounds(false));
        desc.listEntries += 3000;
        desc.maxWidthPx = 128;
        ASSERT_TRUE(view->resize(desc));
        EXPECT_FALSE(makesBounds(false));
        desc.shadowBoundsTexels *= 4;
        ASSERT_TRUE(view->resize(desc));
        EXPECT_TRUE(makesBounds(false));
        EXPECT_FALSE(makesBounds(false));
        EXPECT_TRUE(makesBounds(true));
    });
}

}  // namespace
}  // namespace gnomon::test
