// Every member of ShadowSettings: what is within its range is taken, what is outside is refused with a sentence that
// names the member. No device is needed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

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
    ASSERT_EQ(vulkan.pipelines.size(), 10u);
    for (std::size_t i = 0; i < 10; ++i)
        EXPECT_EQ(vulkan.pipelines[i].spirvBytes == sizeof(words), i >= 7) << "pipeline " << i;
}

// Each member tells settings apart, and pipelines are shared by settings that their shaders cannot tell apart.
TEST(Settings, EqualSettingsHaveEqualPipelines) {
    FakeVulkan vulkan;
    std::unique_ptr<Context> context;
    ASSERT_TRUE(Context::create(vulkan.desc(), context));
    const ShadowSettings first;
    ASSERT_TRUE(context->prepare(first));
    const std::uint32_t ofFirst = 9;  // filter_pairs three times, no filter_tiles and no search_pairs
    EXPECT_EQ(context->pipelineCount(), ofFirst);
    ASSERT_TRUE(context->prepare(first));
    EXPECT_EQ(context->pipelineCount(), ofFirst);
    const struct {
        std::function<void(ShadowSettings&)> change;
        std::uint32_t pipelines;
    } changes[] = {
        {[](ShadowSettings& s) { s.filters = only(Filter::Pcf); }, 2},         // classify_pairs, filter_tiles
        {[](ShadowSettings& s) { s.filters = only(Filter::PcssShared); }, 7},  // classify_pairs, and two three times
        {[](ShadowSettings& s) { s.filters |= only(Filter::Pcf); }, 1},        // classify_pairs: the others are there
        {[](ShadowSettings& s) { s.filters = 0; }, 2},                         // classify_pairs, filter_tiles
        {[](ShadowSettings& s) { s.pcfRadius = 2; }, 3},
        {[](ShadowSettings& s) { s.pcssPresets[0] = kPcssHigh; }, 0},  // constants of the frame
        {[](ShadowSettings& s) { s.pcssPresetCount = 2; }, 3},
        {[](ShadowSettings& s) { s.patternPerFrame = true; }, 0},
        {[](ShadowSettings& s) { s.shadowBounds = true; }, 0},
        {[](ShadowSettings& s) { s.depthBias = DepthBias::Unbiased; }, 4},
        {[](ShadowSettings& s) { s.facedAwayIsDark = false; }, 4},
        {[](ShadowSettings& s) { s.dropLightsFacedAway = false; }, 0},
        {[](ShadowSettings& s) { s.subsurfaceBiasMetres = 0.0f; }, 0},
        {[](ShadowSettings& s) { s.visibilityBits = 4; }, 3},
        {[](ShadowSettings& s) { s.lightLists = LightLists::Pixel; }, 1},
        {[](ShadowSettings& s) { s.listReservation = ListReservation::Approximate; }, 2},
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

}  // namespace
}  // namespace gnomon::house
