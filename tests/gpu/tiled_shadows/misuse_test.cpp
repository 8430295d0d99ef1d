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
        {"maxShadowAtlases", [](ContextDesc& d) { d.maxShadowAtlases = 0; }},
        {"maxShadowAtlases", [](ContextDesc& d) { d.maxShadowAtlases = 5; }},
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

struct SettingsCase {
    const char* word;
    std::function<void(ShadowSettings&)> spoil;
};

const float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

std::vector<SettingsCase> badSettings() {
    using S = ShadowSettings;
    return {
        {"filters", [](S& s) { s.filters = 1u << gpu::kFilterCount; }},
        {"filters", [](S& s) { s.filters |= 0x80000000u; }},
        {"filterPairsSpirv", [](S& s) { s.filters |= only(Filter::Host); }},  // this context has none
        {"pcfRadius", [](S& s) { s.pcfRadius = 0; }},
        {"pcfRadius", [](S& s) { s.pcfRadius = 4; }},
        {"pcssPresetCount", [](S& s) { s.pcssPresetCount = 0; }},
        {"pcssPresetCount", [](S& s) { s.pcssPresetCount = 5; }},
        {"taps", [](S& s) { s.pcssPresets[0].searchTaps = 0; }},
        {"taps", [](S& s) { s.pcssPresets[0].searchTaps = 65; }},
        {"taps", [](S& s) { s.pcssPresets[0].filterTaps = 0; }},
        {"pcssPresets[3]", [](S& s) { s.pcssPresetCount = 4, s.pcssPresets[3].filterTaps = 65; }},
        {"DepthBias", [](S& s) { s.depthBias = static_cast<DepthBias>(3); }},
        {"subsurface", [](S& s) { s.subsurfaceBiasMetres = -1; }},
        {"subsurface", [](S& s) { s.subsurfaceBiasMetres = kNan; }},
        {"visibilityBits", [](S& s) { s.visibilityBits = 0; }},
        {"visibilityBits", [](S& s) { s.visibilityBits = 5; }},
        {"ListReservation", [](S& s) { s.listReservation = static_cast<ListReservation>(3); }},
        {"fixedListEntriesPerTile", [](S& s) { s.listReservation = ListReservation::Fixed; }},
        {"fixedListEntriesPerTile",
         [](S& s) { s.listReservation = ListReservation::Fixed, s.fixedListEntriesPerTile = 1025; }},
    };
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
        {"visibilityBits", [](ViewDesc& d) { d.visibilityBits = 16; }},
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
    EXPECT_EQ(report.visibilitySlots, 480u * 270 * 4);
    desc.listEntries = 0xFFFFFFFFu;
    desc.visibilitySlots = 0xFFFFFFFFu;
    ASSERT_TRUE(View::memory(*context, desc, report).ok());
    EXPECT_TRUE(report.poolsCapped);
    EXPECT_LE(report.visibilitySlots, gpu::kMaxVisibilitySlots);
    EXPECT_GT(report.buffers().size(), 10u);
    for (const BufferMemory& buffer : report.buffers())
        EXPECT_LE(buffer.bytes, device().vulkan().limits().maxStorageBufferRange) << buffer.name;
}

/// Its last light is a sun, and the last shadow view that sun's last cascade.
FrameInput smallRoom() {
    RoomSetup setup{.seed = 40, .widthPx = 32, .heightPx = 24, .shadows = {.viewSizePx = 12}};
    setup.lights.suns = 1;
    return makeRoomFrame(setup);
}

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
    ASSERT_TRUE(rig.prepare(input).ok());  // what is refused has not used it up
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

TEST_P(MisuseTest, Settings) {
    const FrameInput input = smallRoom();
    const Context* context = device().context({});
    Rig rig(device(), {}, viewDescFor(input));
    ASSERT_TRUE(rig.ok() && context != nullptr);
    EXPECT_TRUE(checkSettings({}).ok());
    EXPECT_TRUE(context->prepare(input.settings).ok());
    ASSERT_TRUE(rig.prepare(input).ok());
    const std::vector<SettingsCase> cases = badSettings();
    for (std::size_t i = 0; i < cases.size(); ++i) {
        SCOPED_TRACE("case " + std::to_string(i) + " " + cases[i].word);
        FrameDesc frame = rig.frameDesc(input);
        cases[i].spoil(frame.settings);
        const std::uint32_t pipelines = context->pipelineCount();
        expectRefused(rig.view().beginFrame(frame), cases[i].word);
        expectRefused(context->prepare(frame.settings), cases[i].word);
        EXPECT_EQ(context->pipelineCount(), pipelines);
        // The settings by themselves are right where a context may have a provider of the host's.
        const bool knowsContext = std::strcmp(cases[i].word, "filterPairsSpirv") == 0;
        if (!knowsContext) expectRefused(checkSettings(frame.settings), cases[i].word);
        EXPECT_EQ(checkSettings(frame.settings).ok(), knowsContext);
    }
    ASSERT_TRUE(rig.view().beginFrame(rig.frameDesc(input)).ok());
}

// What lights need of the settings.
TEST_P(MisuseTest, FiltersOfLights) {
    FrameInput input = smallRoom();
    Rig rig(device(), {}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    const auto begin = [&] { return rig.begin(input); };
    ASSERT_TRUE(begin().ok());
    Light& sun = input.lights.back();
    for (const Filter other : {Filter::Hard, Filter::Pcss, Filter::Host}) {
        sun.filter = other;
        expectRefused(begin(), "filter is not among ShadowSettings::filters");
    }
    input.settings.filters = 0;  // nothing is evaluated
    EXPECT_TRUE(begin().ok());
    input.settings.filters = only(Filter::Pcf);
    sun.casts = false;
    EXPECT_TRUE(begin().ok());
    sun.casts = true;
    const std::vector<LightShadowViews> views = input.lightViews;
    input.lightViews.back() = {};
    EXPECT_TRUE(begin().ok());
    input.lightViews = views;
    sun.filter = Filter::Pcss;
    input.settings.filters |= only(Filter::Pcss);
    sun.pcssPreset = 1;
    expectRefused(begin(), "pcssPreset is 1; ShadowSettings::pcssPresetCount is 1");
    sun.pcssPreset = 4;
    expectRefused(begin(), "its pcssPreset must be below 4");
    sun.pcssPreset = 3;
    sun.filter = Filter::Pcf;  // of other filters nobody asks for a preset
    checkFrame(input, rig.run(input));
    sun.filter = Filter::Pcss;
    input.settings.pcssPresetCount = 4;
    checkFrame(input, rig.run(input));
}

TEST_P(MisuseTest, Prepare) {
    const FrameInput input = smallRoom();
    Rig rig(device(), {}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    std::vector<Light> lights = input.lights;
    const auto withSun = [&](ViewInput& v, auto spoil) {
        lights = input.lights;
        spoil(lights.back());
        v.lights = lights;
    };
    struct Case {
        const char* word;
        std::function<void(ViewInput&)> spoil;
    };
    const Case cases[] = {
        {"0x24", [](ViewInput& v) { v.widthPx = 0; }},
        {"32x0", [](ViewInput& v) { v.heightPx = 0; }},
        {"maximum", [](ViewInput& v) { v.widthPx = 33; }},
        {"maximum", [](ViewInput& v) { v.heightPx = 25; }},
        {"ight",
         [&](ViewInput& v) {
             lights = input.lights;
             for (Light& light : lights) light.position[1] = kNan;
             v.lights = lights;
         }},
        {"sourceRadius", [&](ViewInput& v) { withSun(v, [](Light& sun) { sun.sourceRadius = 0.51f; }); }},
        {"shadowFade", [&](ViewInput& v) { withSun(v, [](Light& sun) { sun.shadowFadeEndMetres = 1; }); }},
        {"Filter", [&](ViewInput& v) { withSun(v, [](Light& sun) { sun.filter = static_cast<Filter>(9); }); }},
        {"amera", [](ViewInput& v) { v.camera.viewFromWorld[0] = 2; }},
        {"amera", [](ViewInput& v) { std::memset(v.camera.clipFromView, 0, 64); }},
    };
    PreparedLights answer;
    for (std::size_t i = 0; i < std::size(cases); ++i) {
        SCOPED_TRACE("case " + std::to_string(i) + " " + cases[i].word);
        ASSERT_TRUE(rig.prepare(input).ok());
        ViewInput view = Rig::viewInput(input);
        cases[i].spoil(view);
        expectRefused(rig.view().prepare(view, answer), cases[i].word);
        // The answer before it does not count any more.
        expectRefused(rig.view().beginFrame(rig.frameDesc(input)), "View::prepare()");
    }
    checkFrame(input, rig.run(input));
}

// Every frame has a prepare() of its own, which counts once.
TEST_P(MisuseTest, BeginFrameWithoutPrepare) {
    const FrameInput input = smallRoom();
    Rig rig(device(), {}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    FrameDesc frame = rig.frameDesc(input);
    expectRefused(rig.view().beginFrame(frame), "View::prepare()");
    ASSERT_TRUE(rig.prepare(input).ok());
    frame = rig.frameDesc(input);
    frame.depth.view = VK_NULL_HANDLE;
    expectRefused(rig.view().beginFrame(frame), "depth");
    PrepareReport report;
    ASSERT_TRUE(rig.view().beginFrame(rig.frameDesc(input), &report).ok());  // what was refused did not use it up
    EXPECT_EQ(report.given, input.lights.size());
    expectRefused(rig.view().beginFrame(rig.frameDesc(input)), "View::prepare()");
    checkFrame(input, rig.run(input));
}

TEST_P(MisuseTest, LightViews) {
    const FrameInput input = smallRoom();
    Rig rig(device(), {}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    ASSERT_TRUE(rig.prepare(input).ok());
    const auto total = static_cast<std::uint32_t>(input.shadows->views.size());
    // The place in the answer of the first light of a type that casts.
    const auto placeOf = [&](LightType type) {
        for (std::size_t i = 0; i < rig.answer().size(); ++i)
            if (rig.answer()[i].type == type && rig.answer()[i].casts) return i;
        ADD_FAILURE() << "no light of type " << int(type);
        return std::size_t{0};
    };
    const std::size_t sun = placeOf(LightType::Directional), point = placeOf(LightType::Point),
                      spot = placeOf(LightType::Spot);
    using Views = std::vector<LightShadowViews>;
    struct Case {
        const char* word;
        std::function<void(Views&)> spoil;
    };
    const Case cases[] = {
        {"lights were given shadow views", [](Views& v) { v.pop_back(); }},
        {"lights were given shadow views", [](Views& v) { v.emplace_back(); }},
        {"lights were given shadow views", [](Views& v) { v.resize(1); }},
        {"1 to 8 shadow views", [&](Views& v) { v[sun].count = 0; }},
        {"1 to 8 shadow views", [&](Views& v) { v[sun].count = 9; }},
        {"out of bounds", [&](Views& v) { ++v[sun].first; }},
        {"six shadow views", [&](Views& v) { v[point].count = 5; }},
        {"six shadow views", [&](Views& v) { v[point].count = 7; }},
        {"out of bounds", [&](Views& v) { v[point].first = total - 5; }},
        {"one shadow view", [&](Views& v) { v[spot].count = 2; }},
        {"one shadow view", [&](Views& v) { v[spot].count = 0; }},
        {"out of bounds", [&](Views& v) { v[spot].first = total; }},
        {"out of bounds", [&](Views& v) { v[spot].first = kNoShadowViews - 1; }},
        {"must be perspective", [&](Views& v) { v[spot].first = total - 1; }},
        {"must be orthographic", [&](Views& v) { v[sun] = v[point]; }},
    };
    for (std::size_t i = 0; i < std::size(cases); ++i) {
        SCOPED_TRACE("case " + std::to_string(i) + " " + cases[i].word);
        FrameDesc frame = rig.frameDesc(input);
        Views views(frame.lightViews.begin(), frame.lightViews.end());
        cases[i].spoil(views);
        frame.lightViews = views;
        expectRefused(rig.view().beginFrame(frame), cases[i].word);
    }
    // No views at all are fine: nothing casts.
    FrameDesc frame = rig.frameDesc(input);
    frame.lightViews = {};
    PrepareReport report;
    ASSERT_TRUE(rig.view().beginFrame(frame, &report).ok());
    EXPECT_EQ(report.casting, 0u);
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
    struct Case {
        const char* word;
        std::function<void(FrameDesc&)> spoil;
    };
    const Case cases[] = {
        {"depth", [](FrameDesc& f) { f.depth.view = VK_NULL_HANDLE; }},
        {"depthPyramid", [](FrameDesc& f) { f.settings.hostDepthPyramid = true; }},
        {"atlases", [&](FrameDesc& f) { withAtlases(f, [](auto& a) { a.resize(5, a[0]); }); }},
        {"atlas", [&](FrameDesc& f) { withAtlases(f, [](auto& a) { a[0].view = VK_NULL_HANDLE; }); }},
        {"atlas", [&](FrameDesc& f) { withAtlases(f, [](auto& a) { a[1].widthPx = 0; }); }},
        {"atlas", [&](FrameDesc& f) { withAtlases(f, [](auto& a) { a.resize(1); }); }},
        {"depthStep", [&](FrameDesc& f) { withAtlases(f, [](auto& a) { a[1].depthStep = -1.0f; }); }},
        {"depthStep", [&](FrameDesc& f) { withAtlases(f, [](auto& a) { a[1].depthStep = kNan; }); }},
        {"depthStep", [](FrameDesc& f) { f.depthStep = -1e-6f; }},
        {"depthStep", [](FrameDesc& f) { f.depthStep = kNan; }},
        {"maxShadowViews",
         [&](FrameDesc& f) {
             views = input.shadows->views;
             views.push_back(views[0]);
             f.shadowViews = views;
         }},
        {"ight", [&](FrameDesc& f) { f.shadowViews = f.shadowViews.first(1); }},  // lights refer beyond
    };
    ASSERT_TRUE(rig.prepare(input).ok());
    for (std::size_t i = 0; i < std::size(cases); ++i) {
        SCOPED_TRACE("case " + std::to_string(i) + " " + cases[i].word);
        FrameDesc frame = rig.frameDesc(input);
        cases[i].spoil(frame);
        expectRefused(rig.view().beginFrame(frame), cases[i].word);
    }
    checkFrame(input, rig.run(input));
}

// What is refused leaves the view as it was.
TEST_P(MisuseTest, Resize) {
    FrameInput input = smallRoom();
    const ViewDesc good = viewDescFor(input);
    Rig rig(device(), {}, good);
    ASSERT_TRUE(rig.ok());
    struct Case {
        const char* word;
        std::function<void(ViewDesc&)> spoil;
    };
    const Case cases[] = {
        {"0x24", [](ViewDesc& d) { d.maxWidthPx = 0; }},
        {"16384", [](ViewDesc& d) { d.maxHeightPx = 16385; }},
        {"framesInFlight", [](ViewDesc& d) { d.framesInFlight = 0; }},
        {"cannot change framesInFlight", [](ViewDesc& d) { d.framesInFlight = 3; }},
        {"cannot change framesInFlight, guardBytes or statistics", [](ViewDesc& d) { d.statistics = false; }},
        {"maxShadowViews", [](ViewDesc& d) { d.maxShadowViews = 0; }},
        {"visibilityBits", [](ViewDesc& d) { d.visibilityBits = 6; }},
        {"rangeCutoffLux", [](ViewDesc& d) { d.prepare.rangeCutoffLux = 0; }},
        {"rangeCutoffLux", [](ViewDesc& d) { d.prepare.rangeCutoffLux = 0, d.maxWidthPx = 64; }},
        {"keepFactor", [](ViewDesc& d) { d.prepare.keepFactor = 0.5f; }},
    };
    checkFrame(input, rig.run(input));
    for (std::size_t i = 0; i < std::size(cases); ++i) {
        SCOPED_TRACE("case " + std::to_string(i) + " " + cases[i].word);
        ViewDesc desc = good;
        cases[i].spoil(desc);
        expectRefused(rig.resize(desc), cases[i].word);
    }
    ViewDesc guarded = good;
    guarded.guardBytes = 2 * kGuardBytes;
    expectRefused(rig.view().resize(guarded), "cannot change framesInFlight, guardBytes");
    checkFrame(input, rig.run(input));
    // A new extent takes a prepared answer away, and sets another limit.
    ASSERT_TRUE(rig.prepare(input).ok());
    ViewDesc smaller = good;
    smaller.maxWidthPx = 31;
    ASSERT_TRUE(rig.resize(smaller).ok());
    expectRefused(rig.view().beginFrame(rig.frameDesc(input)), "View::prepare()");
    expectRefused(rig.prepare(input), "maximum");
    ASSERT_TRUE(rig.resize(good).ok());
    checkFrame(input, rig.run(input));
}

TEST_P(MisuseTest, MissingDepthPyramid) {
    FrameInput input = makeQuickFrame({.seed = 41, .widthPx = 16, .heightPx = 16});
    input.settings.hostDepthPyramid = true;
    Rig rig(device(), {}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    ASSERT_TRUE(rig.prepare(input).ok());
    expectRefused(rig.view().beginFrame(rig.frameDesc(input)), "depthPyramid");
}

}  // namespace
}  // namespace gnomon::test
