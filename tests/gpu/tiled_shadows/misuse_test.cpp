// Every broken rule is answered by BadArgument and a sentence, and the next good call works.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>

#include "checks.h"
#include "scenes.h"

namespace gnomon::test {
namespace {

class MisuseTest : public GpuTest {};
GNOMON_ON_EVERY_DEVICE(MisuseTest);

void expectRefused(const Result& result, const char* word, Status status = Status::BadArgument) {
    EXPECT_EQ(result.status(), status) << word << ": " << result.message();
    EXPECT_NE(std::strstr(result.message(), word), nullptr) << "'" << result.message() << "' does not say " << word;
    const std::size_t length = std::strlen(result.message());
    EXPECT_GT(length, 15u);
    EXPECT_TRUE(length > 0 && result.message()[length - 1] == '.') << result.message();
}

TEST_P(MisuseTest, ContextDesc) {
    struct Case {
        const char* word;
        std::function<void(ContextDesc&)> spoil;
    };
    const std::vector<std::uint32_t> many(9, 0);
    const Case cases[] = {
        {"instance", [](ContextDesc& d) { d.instance = VK_NULL_HANDLE; }},
        {"device", [](ContextDesc& d) { d.physicalDevice = VK_NULL_HANDLE; }},
        {"device", [](ContextDesc& d) { d.device = VK_NULL_HANDLE; }},
        {"getInstanceProcAddr", [](ContextDesc& d) { d.getInstanceProcAddr = nullptr; }},
        {"queueFamilies", [](ContextDesc& d) { d.queueFamilies = {}; }},
        {"queueFamilies", [&](ContextDesc& d) { d.queueFamilies = many; }},
        {"pcfRadius", [](ContextDesc& d) { d.pcfRadius = 0; }},
        {"pcfRadius", [](ContextDesc& d) { d.pcfRadius = 4; }},
        {"taps", [](ContextDesc& d) { d.pcss.searchTaps = 0; }},
        {"taps", [](ContextDesc& d) { d.pcss.searchTaps = 65; }},
        {"taps", [](ContextDesc& d) { d.pcss.filterTaps = 0; }},
        {"taps", [](ContextDesc& d) { d.pcss.filterTaps = 65; }},
        {"maxShadowAtlases", [](ContextDesc& d) { d.maxShadowAtlases = 0; }},
        {"maxShadowAtlases", [](ContextDesc& d) { d.maxShadowAtlases = 5; }},
        {"visibilityBits", [](ContextDesc& d) { d.visibilityBits = 0; }},
        {"visibilityBits", [](ContextDesc& d) { d.visibilityBits = 5; }},
        {"fixedListEntriesPerTile", [](ContextDesc& d) { d.listReservation = ListReservation::Fixed; }},
        {"fixedListEntriesPerTile",
         [](ContextDesc& d) {
             d.listReservation = ListReservation::Fixed;
             d.fixedListEntriesPerTile = 1025;
         }},
    };
    for (const Case& c : cases) {
        ContextDesc desc = device().contextDesc({});
        c.spoil(desc);
        std::unique_ptr<Context> context;
        expectRefused(Context::create(desc, context), c.word);
        EXPECT_EQ(context, nullptr);
    }
    for (const std::uint32_t size : {1u, 2u, 3u, 12u, 128u}) {
        ContextDesc desc = device().contextDesc({});
        desc.subgroupSize = size;
        std::unique_ptr<Context> context;
        expectRefused(Context::create(desc, context), "subgroups", Status::UnsupportedDevice);
    }
}

TEST_P(MisuseTest, ViewDesc) {
    struct Case {
        const char* word;
        std::function<void(ViewDesc&)> spoil;
    };
    const Case cases[] = {
        {"0x10", [](ViewDesc& d) { d.maxWidthPx = 0, d.maxHeightPx = 10; }},
        {"10x0", [](ViewDesc& d) { d.maxWidthPx = 10, d.maxHeightPx = 0; }},
        {"16384", [](ViewDesc& d) { d.maxWidthPx = 16385; }},
        {"framesInFlight", [](ViewDesc& d) { d.framesInFlight = 0; }},
        {"framesInFlight", [](ViewDesc& d) { d.framesInFlight = 5; }},
        {"maxShadowViews", [](ViewDesc& d) { d.maxShadowViews = 0; }},
        {"maxShadowViews", [](ViewDesc& d) { d.maxShadowViews = 6 * 1024 + 1; }},
        {"guardBytes", [](ViewDesc& d) { d.guardBytes = 128; }},
        {"guardBytes", [](ViewDesc& d) { d.guardBytes = 257; }},
        {"rangeCutoffLux", [](ViewDesc& d) { d.prepare.rangeCutoffLux = 0; }},
        {"keepFactor", [](ViewDesc& d) { d.prepare.keepFactor = 0.5f; }},
    };
    const Context* context = device().context({});
    ASSERT_NE(context, nullptr);
    for (const Case& c : cases) {
        ViewDesc desc;
        desc.maxWidthPx = desc.maxHeightPx = 32;
        c.spoil(desc);
        std::unique_ptr<View> view;
        expectRefused(View::create(*context, desc, view), c.word);
        EXPECT_EQ(view, nullptr);
    }
}

TEST_P(MisuseTest, MemoryReport) {
    const Context* context = device().context({});
    ASSERT_NE(context, nullptr);
    ViewDesc desc;  // 4K, defaults
    MemoryReport report;
    ASSERT_TRUE(View::memory(*context, desc, report).ok());
    EXPECT_FALSE(report.poolsCapped);
    EXPECT_EQ(report.listEntries, 480u * 270 * 8);
    EXPECT_EQ(report.visibilitySlots, 480u * 270 * 8);
    desc.listEntries = 0xFFFFFFFFu;
    desc.visibilitySlots = 0xFFFFFFFFu;
    ASSERT_TRUE(View::memory(*context, desc, report).ok());
    EXPECT_TRUE(report.poolsCapped);
    EXPECT_LE(report.visibilitySlots, gpu::kMaxVisibilitySlots);
    for (std::uint32_t i = 0; i < report.bufferCount; ++i)
        EXPECT_LE(report.buffers[i].bytes, device().vulkan().limits().maxStorageBufferRange) << report.buffers[i].name;
}

/// Its last light is a sun, and the last shadow view that sun's last cascade.
FrameInput smallRoom() {
    RoomSetup setup{.seed = 40, .widthPx = 32, .heightPx = 24, .shadows = {.viewSizePx = 12}};
    setup.lights.suns = 1;
    return makeRoomFrame(setup);
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

TEST_P(MisuseTest, ShadowViews) {
    const FrameInput input = smallRoom();
    ASSERT_GT(input.shadows->views.size(), 1u);
    Rig rig(device(), {}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    struct Case {
        const char* word;
        std::function<void(ShadowView&)> spoil;
    };
    const Case cases[] = {
        {"view 1", [](ShadowView& v) { v.clipFromWorld[3] = kNan; }},
        {"view 1", [](ShadowView& v) { std::memset(v.clipFromWorld, 0, 64); }},
        {"view 1", [](ShadowView& v) { v.atlas = 4; }},
        {"outside", [](ShadowView& v) { v.layer = 99; }},
        {"outside", [](ShadowView& v) { v.xPx = 0xFFFFFFF0u; }},
        {"outside", [](ShadowView& v) { v.heightPx = 0xFFFFFFFFu; }},
        {"at least", [](ShadowView& v) { v.widthPx = 7; }},
        {"near", [](ShadowView& v) { v.nearMetres = 0; }},
        {"near", [](ShadowView& v) { v.farMetres = v.nearMetres; }},
        {"perspective", [](ShadowView& v) { v.orthographic = true, v.farMetres = 10; }},
        {"near", [](ShadowView& v) { v.nearMetres = kNan; }},
    };
    const auto refuses = [&](const Case& c, std::size_t which) {
        FrameDesc frame = rig.frameDesc(input);
        std::vector<ShadowView> views = input.shadows->views;
        c.spoil(views[which]);
        frame.shadowViews = views;
        expectRefused(rig.view().beginFrame(frame), c.word);
    };
    for (std::size_t i = 0; i < std::size(cases); ++i) {
        SCOPED_TRACE("case " + std::to_string(i) + " " + cases[i].word);
        refuses(cases[i], 1);
    }
    const std::size_t cascade = input.shadows->views.size() - 1;
    refuses({"orthographic", [](ShadowView& v) { v.orthographic = false; }}, cascade);
    refuses({"near", [](ShadowView& v) { v.farMetres = kInf; }}, cascade);
    checkFrame(input, rig.run(input));
}

TEST_P(MisuseTest, BeginFrame) {
    const FrameInput input = smallRoom();
    Rig rig(device(), {}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    std::vector<ShadowView> views = input.shadows->views;
    std::vector<ShadowAtlas> atlases;
    const auto withAtlases = [&](FrameDesc& f, auto spoil) {
        atlases.assign(f.atlases.begin(), f.atlases.end());
        spoil(atlases);
        f.atlases = atlases;
    };
    std::vector<Light> lights = input.lights;
    const auto withSun = [&](FrameDesc& f, auto spoil) {
        lights = input.lights;
        spoil(lights.back());
        f.view.lights = lights;
    };
    struct Case {
        const char* word;
        std::function<void(FrameDesc&)> spoil;
    };
    const Case cases[] = {
        {"depth", [](FrameDesc& f) { f.depth.view = VK_NULL_HANDLE; }},
        {"0x24", [](FrameDesc& f) { f.view.widthPx = 0; }},
        {"32x0", [](FrameDesc& f) { f.view.heightPx = 0; }},
        {"maximum", [](FrameDesc& f) { f.view.widthPx = 33; }},
        {"atlases", [&](FrameDesc& f) { withAtlases(f, [](auto& a) { a.resize(5, a[0]); }); }},
        {"atlas", [&](FrameDesc& f) { withAtlases(f, [](auto& a) { a[0].view = VK_NULL_HANDLE; }); }},
        {"atlas", [&](FrameDesc& f) { withAtlases(f, [](auto& a) { a[1].widthPx = 0; }); }},
        {"atlas", [&](FrameDesc& f) { withAtlases(f, [](auto& a) { a.resize(1); }); }},
        {"depthStep", [&](FrameDesc& f) { withAtlases(f, [](auto& a) { a[1].depthStep = -1.0f; }); }},
        {"depthStep", [&](FrameDesc& f) { withAtlases(f, [](auto& a) { a[1].depthStep = kNan; }); }},
        {"subsurface", [](FrameDesc& f) { f.subsurfaceBiasMetres = -1; }},
        {"subsurface", [](FrameDesc& f) { f.subsurfaceBiasMetres = kNan; }},
        {"depthStep", [](FrameDesc& f) { f.depthStep = -1e-6f; }},
        {"depthStep", [](FrameDesc& f) { f.depthStep = kNan; }},
        {"maxShadowViews",
         [&](FrameDesc& f) {
             views = input.shadows->views;
             views.push_back(views[0]);
             f.shadowViews = views;
         }},
        {"ight",
         [&](FrameDesc& f) {
             lights = input.lights;
             for (Light& light : lights) light.position[1] = kNan;
             f.view.lights = lights;
         }},
        {"ight", [&](FrameDesc& f) { f.shadowViews = f.shadowViews.first(1); }},  // lights refer beyond
        {"cascadeCount", [&](FrameDesc& f) { withSun(f, [](Light& sun) { sun.cascadeCount = 0; }); }},
        {"cascadeCount", [&](FrameDesc& f) { withSun(f, [](Light& sun) { sun.cascadeCount = 9; }); }},
        {"firstShadowView", [&](FrameDesc& f) { withSun(f, [](Light& sun) { ++sun.firstShadowView; }); }},
        {"sourceRadius", [&](FrameDesc& f) { withSun(f, [](Light& sun) { sun.sourceRadius = 0.51f; }); }},
        {"shadowFade", [&](FrameDesc& f) { withSun(f, [](Light& sun) { sun.shadowFadeEndMetres = 1; }); }},
        {"amera", [](FrameDesc& f) { f.view.camera.viewFromWorld[0] = 2; }},
        {"amera", [](FrameDesc& f) { std::memset(f.view.camera.clipFromView, 0, 64); }},
    };
    for (std::size_t i = 0; i < std::size(cases); ++i) {
        SCOPED_TRACE("case " + std::to_string(i) + " " + cases[i].word);
        FrameDesc frame = rig.frameDesc(input);
        cases[i].spoil(frame);
        expectRefused(rig.view().beginFrame(frame), cases[i].word);
    }
    checkFrame(input, rig.run(input));
}

TEST_P(MisuseTest, MissingDepthPyramid) {
    const FrameInput input = makeQuickFrame({.seed = 41, .widthPx = 16, .heightPx = 16});
    Rig rig(device(), {.hostDepthPyramid = true}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    expectRefused(rig.view().beginFrame(rig.frameDesc(input)), "depthPyramid");
}

}  // namespace
}  // namespace gnomon::test
