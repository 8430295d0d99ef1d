// Every member of ShadowSettings: what is within its range is taken, what is outside is refused with a sentence that
// names the member. No device is needed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "unit/house/fake_vulkan.h"

namespace gnomon::house {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

struct Case {
    const char* member;
    std::function<void(ShadowSettings&)> change;
    bool good;
};

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

#define SETTING(name, value, good)                                \
    {                                                             \
#name, [](ShadowSettings & s) { s.name = (value); }, good \
    }

std::vector<Case> cases() {
    using S = ShadowSettings&;
    return {
        SETTING(filters, 0u, true),
        SETTING(filters, kAllBuiltInFilters, true),
        SETTING(filters, only(Filter::PcssShared), true),
        SETTING(filters, 0x20u, false),
        SETTING(filters, kAllBuiltInFilters | 0x80000000u, false),
        SETTING(filters, ~0u, false),
        SETTING(pcfRadius, 1u, true),
        SETTING(pcfRadius, 3u, true),
        SETTING(pcfRadius, 0u, false),
        SETTING(pcfRadius, 4u, false),
        SETTING(pcfRadius, ~0u, false),
        SETTING(pcssPresetCount, 1u, true),
        SETTING(pcssPresetCount, 4u, true),
        SETTING(pcssPresetCount, 0u, false),
        SETTING(pcssPresetCount, 5u, false),
        SETTING(pcssPresetCount, ~0u, false),
        {"pcssPresets[0]",
         [](S s) {
             s.pcssPresets[0] = {1, 64};
         },
         true},
        {"pcssPresets[0]",
         [](S s) {
             s.pcssPresets[0] = {64, 1};
         },
         true},
        {"pcssPresets[0]",
         [](S s) {
             s.pcssPresets[0] = {0, 8};
         },
         false},
        {"pcssPresets[0]",
         [](S s) {
             s.pcssPresets[0] = {8, 0};
         },
         false},
        {"pcssPresets[0]",
         [](S s) {
             s.pcssPresets[0] = {65, 8};
         },
         false},
        {"pcssPresets[0]",
         [](S s) {
             s.pcssPresets[0] = {8, 65};
         },
         false},
        {"pcssPresets[0]",
         [](S s) {
             s.pcssPresets[0] = {~0u, ~0u};
         },
         false},
        // Those beyond the count are not looked at.
        {"pcssPresets[3]",
         [](S s) {
             s.pcssPresets[3] = {0, 0};
         },
         true},
        {"pcssPresets[3]",
         [](S s) {
             s.pcssPresetCount = 4, s.pcssPresets[3] = {0, 1};
         },
         false},
        SETTING(depthBias, DepthBias::OrientedConstant, true),
        SETTING(depthBias, DepthBias::Unbiased, true),
        SETTING(depthBias, static_cast<DepthBias>(3), false),
        SETTING(depthBias, static_cast<DepthBias>(255), false),
        SETTING(subsurfaceBiasMetres, 0.0f, true),
        SETTING(subsurfaceBiasMetres, 10.0f, true),
        SETTING(subsurfaceBiasMetres, -0.001f, false),
        SETTING(subsurfaceBiasMetres, kNan, false),
        SETTING(subsurfaceBiasMetres, kInfinity, false),
        SETTING(subsurfaceBiasMetres, -kInfinity, false),
        SETTING(visibilityBits, 4u, true),
        SETTING(visibilityBits, 0u, false),
        SETTING(visibilityBits, 1u, false),
        SETTING(visibilityBits, 5u, false),
        SETTING(visibilityBits, 16u, false),
        SETTING(visibilityBits, ~0u, false),
        SETTING(lightLists, LightLists::Pixel, true),
        SETTING(lightLists, static_cast<LightLists>(2), false),
        SETTING(listReservation, ListReservation::Approximate, true),
        SETTING(listReservation, static_cast<ListReservation>(3), false),
        SETTING(fixedListEntriesPerTile, ~0u, true),  // not looked at without ListReservation::Fixed
        {"fixedListEntriesPerTile",
         [](S s) { s.listReservation = ListReservation::Fixed, s.fixedListEntriesPerTile = 1; }, true},
        {"fixedListEntriesPerTile",
         [](S s) { s.listReservation = ListReservation::Fixed, s.fixedListEntriesPerTile = 1024; }, true},
        {"fixedListEntriesPerTile",
         [](S s) { s.listReservation = ListReservation::Fixed, s.fixedListEntriesPerTile = 0; }, false},
        {"fixedListEntriesPerTile",
         [](S s) { s.listReservation = ListReservation::Fixed, s.fixedListEntriesPerTile = 1025; }, false},
        // Both values are good.
        SETTING(patternPerFrame, true, true),
        SETTING(shadowBounds, true, true),
        SETTING(facedAwayIsDark, false, true),
        SETTING(dropLightsFacedAway, false, true),
        SETTING(hostDepthPyramid, true, true),
    };
}
#undef SETTING

// A member that is new breaks this, so that it gets its rows above.
TEST(Settings, AllMembersAreInTheTable) {
    const auto& [filters, pcfRadius, pcssPresets, pcssPresetCount, patternPerFrame, shadowBounds, depthBias,
                 facedAwayIsDark, dropLightsFacedAway, subsurfaceBiasMetres, visibilityBits, lightLists,
                 listReservation, fixedListEntriesPerTile, hostDepthPyramid] = ShadowSettings{};
    (void)filters;
    EXPECT_TRUE(checkSettings({}));
}

TEST(Settings, AreCheckedMemberByMember) {
    const std::vector<Case> all = cases();
    for (std::size_t i = 0; i < all.size(); ++i) {
        ShadowSettings settings;
        all[i].change(settings);
        const Result result = checkSettings(settings);
        EXPECT_EQ(result.ok(), all[i].good) << "row " << i << ", " << all[i].member << ": " << result.message();
        if (all[i].good) continue;
        EXPECT_EQ(result.status(), Status::BadArgument) << "row " << i;
        EXPECT_THAT(result.message(), HasSubstr(std::string("ShadowSettings::") + all[i].member)) << "row " << i;
        EXPECT_THAT(result.message(), MatchesRegex("^.+\\.$")) << "not a sentence";
    }
}

// Context::prepare() says the same sentences, and makes nothing.
TEST(Settings, PrepareRefusesTheSame) {
    FakeVulkan vulkan;
    std::unique_ptr<Context> context;
    ASSERT_TRUE(Context::create(vulkan.desc(), context));
    for (const Case& c : cases()) {
        if (c.good) continue;
        ShadowSettings settings;
        c.change(settings);
        const Result result = context->prepare(settings);
        EXPECT_EQ(result.status(), Status::BadArgument);
        EXPECT_STREQ(result.message(), checkSettings(settings).message());
    }
    EXPECT_EQ(context->pipelineCount(), 0u);
    EXPECT_TRUE(vulkan.pipelines.empty());
}

// The host's filter is good by itself, but needs a context with the host's shader.
TEST(Settings, TheHostsFilterNeedsItsShader) {
    ShadowSettings settings;
    settings.filters = only(Filter::Host) | only(Filter::Pcf);
    EXPECT_TRUE(checkSettings(settings));
    FakeVulkan vulkan;
    std::unique_ptr<Context> context;
    ASSERT_TRUE(Context::create(vulkan.desc(), context));
    const Result result = context->prepare(settings);
    EXPECT_EQ(result.status(), Status::BadArgument);
    EXPECT_THAT(result.message(), HasSubstr("filterPairsSpirv"));
    EXPECT_EQ(context->pipelineCount(), 0u);
    context.reset();

    ContextDesc desc = vulkan.desc();
    const std::uint32_t words[] = {1, 2, 3, 4, 5};
    desc.filterPairsSpirv = words;
    ASSERT_TRUE(Context::create(desc, context));
    ASSERT_TRUE(context->prepare(settings));
    // The pipelines of the host's queues are the host's, one for each kind of shadow views, and made last.
    ASSERT_EQ(vulkan.pipelines.size(), 9u);
    for (std::size_t i = 0; i < 9; ++i)
        EXPECT_EQ(vulkan.pipelines[i].spirvBytes == sizeof(words), i >= 6) << "pipeline " << i;
}

// Each member tells settings apart, and pipelines are shared by settings that their shaders cannot tell apart.
TEST(Settings, EqualSettingsHaveEqualPipelines) {
    FakeVulkan vulkan;
    std::unique_ptr<Context> context;
    ASSERT_TRUE(Context::create(vulkan.desc(), context));
    const ShadowSettings first;
    ASSERT_TRUE(context->prepare(first));
    const std::uint32_t ofFirst = 8;  // filter_pairs three times; no phase 3, no filter_tiles and no search_pairs
    EXPECT_EQ(context->pipelineCount(), ofFirst);
    ASSERT_TRUE(context->prepare(first));
    EXPECT_EQ(context->pipelineCount(), ofFirst);
    const struct {
        std::function<void(ShadowSettings&)> change;
        std::uint32_t pipelines;
    } changes[] = {
        {[](ShadowSettings& s) { s.filters = only(Filter::Pcf); }, 1},         // filter_tiles
        {[](ShadowSettings& s) { s.filters = only(Filter::PcssShared); }, 7},  // classify_pairs, and two three times
        {[](ShadowSettings& s) { s.filters |= only(Filter::Pcf); }, 1},        // classify_pairs: the others are there
        {[](ShadowSettings& s) { s.filters = 0; }, 1},                         // filter_tiles
        {[](ShadowSettings& s) { s.pcfRadius = 2; }, 0},                       // no filter asks it
        {[](ShadowSettings& s) {
             s.filters = only(Filter::Pcf);
             s.pcfRadius = 2;
         },
         1},
        {[](ShadowSettings& s) {
             s.filters = only(Filter::Pcf);
             s.pcfRadius = 2;
             s.pcssPresetCount = 3;  // no filter asks it
         },
         0},
        {[](ShadowSettings& s) { s.pcssPresets[0] = kPcssHigh; }, 0},  // constants of the frame
        {[](ShadowSettings& s) { s.pcssPresetCount = 2; }, 3},
        {[](ShadowSettings& s) { s.patternPerFrame = true; }, 0},
        {[](ShadowSettings& s) { s.shadowBounds = true; }, 0},
        {[](ShadowSettings& s) { s.depthBias = DepthBias::Unbiased; }, 3},
        {[](ShadowSettings& s) { s.facedAwayIsDark = false; }, 3},
        {[](ShadowSettings& s) { s.dropLightsFacedAway = false; }, 0},
        {[](ShadowSettings& s) { s.subsurfaceBiasMetres = 0.0f; }, 0},
        {[](ShadowSettings& s) { s.visibilityBits = 4; }, 3},
        {[](ShadowSettings& s) { s.lightLists = LightLists::Pixel; }, 2},
        {[](ShadowSettings& s) { s.listReservation = ListReservation::Approximate; }, 1},
        {[](ShadowSettings& s) { s.hostDepthPyramid = true; }, 1},
    };
    std::uint32_t expected = ofFirst;
    for (std::size_t i = 0; i < std::size(changes); ++i) {
        ShadowSettings settings;
        changes[i].change(settings);
        EXPECT_NE(settings, first) << "change " << i;
        expected += changes[i].pipelines;
        ASSERT_TRUE(context->prepare(settings));
        EXPECT_EQ(context->pipelineCount(), expected) << "change " << i;
        ASSERT_TRUE(context->prepare(settings));
        EXPECT_EQ(context->pipelineCount(), expected) << "change " << i << ", again";
    }
    const std::uint32_t made = vulkan.made;
    ASSERT_TRUE(context->prepare(first));
    EXPECT_EQ(vulkan.made, made);
}

// What a host gives for a frame of three lights without anything drawn: a spot with one view, a point light with six,
// and a sun with one cascade.
struct ThreeLights {
    std::vector<Light> lights = std::vector<Light>(3);
    std::vector<ShadowView> views = std::vector<ShadowView>(8);
    FrameDesc frame;
    ShadowAtlas atlas = {reinterpret_cast<VkImageView>(std::uintptr_t{7}), 256, 256};
    std::vector<LightShadowViews> lightViews;

    ThreeLights() {
        constexpr LightType kTypes[] = {LightType::Spot, LightType::Point, LightType::Directional};
        for (std::size_t i = 0; i < 3; ++i) {
            lights[i].type = kTypes[i];
            lights[i].position[2] = -3.0f;
            lights[i].rangeMetres = 4.0f;
        }
        for (std::size_t i = 0; i < views.size(); ++i) {
            ShadowView& view = views[i];
            for (const std::size_t diagonal : {0u, 5u, 10u}) view.clipFromWorld[diagonal] = 1.0f;
            view.orthographic = i == 7;
            view.clipFromWorld[view.orthographic ? 15 : 11] = 1.0f;
            view.widthPx = view.heightPx = 32;
            view.xPx = static_cast<std::uint32_t>(32 * i);
            view.farMetres = 10.0f;
        }
        frame.depth = {reinterpret_cast<VkImageView>(std::uintptr_t{5})};
        frame.atlases = {&atlas, 1};
        frame.shadowViews = views;
    }
    ThreeLights(const ThreeLights&) = delete;
    ThreeLights& operator=(const ThreeLights&) = delete;

    Result begin(View& view) {
        ViewInput input;
        input.widthPx = input.heightPx = 64;
        // A camera that looks along -z, one metre to the near plane, reversed Z without end.
        constexpr std::array<float, 16> kClip = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0};
        std::ranges::copy(kClip, input.camera.clipFromView);
        input.lights = lights;
        PreparedLights prepared;
        if (Result result = view.prepare(input, prepared); !result) return result;
        lightViews.clear();
        for (const LightOnScreen& light : prepared.visible) {
            const LightShadowViews of[] = {{0, 1}, {1, 6}, {7, 1}};
            lightViews.push_back(of[light.light]);
        }
        frame.lightViews = lightViews;
        ++frame.frameNumber;
        return view.beginFrame(frame);
    }
};

// A frame makes the pipelines of the queues that its lights may fill, and no other. prepare() makes them all.
TEST(Settings, FramesMakePipelinesOfTheirLightsAlone) {
    FakeVulkan vulkan;
    std::unique_ptr<Context> context;
    ASSERT_TRUE(Context::create(vulkan.desc(), context));
    ViewDesc desc;
    desc.maxWidthPx = desc.maxHeightPx = 64;
    std::unique_ptr<View> view;
    ASSERT_TRUE(View::create(*context, desc, view));
    ThreeLights host;
    host.frame.settings.filters = kAllBuiltInFilters;
    std::uint32_t expected = 0;
    const auto begin = [&](const char* what, std::uint32_t more) {
        const Result result = host.begin(*view);
        ASSERT_TRUE(result) << what << ": " << result.message();
        expected += more;
        EXPECT_EQ(context->pipelineCount(), expected) << what;
    };
    for (Light& light : host.lights) light.filter = Filter::Hard;
    begin("hard shadows go by tile", 6);
    host.lights[0].filter = Filter::Pcss;
    begin("a spot", 1);
    host.lights[1].filter = Filter::Pcss;
    begin("a point light", 1);
    host.lights[2].filter = Filter::PcssShared;
    begin("a sun, with a search", 2);
    host.lights[0].filter = Filter::PcssShared;
    host.lights[1].casts = false;
    begin("a spot, with a search", 2);
    begin("the same again", 0);
    ASSERT_TRUE(context->prepare(host.frame.settings));
    EXPECT_EQ(context->pipelineCount(), 6u + 3u + 6u);
}

}  // namespace
}  // namespace gnomon::house
