// Deferred shadows equal shadows evaluated while lighting: every stored visibility has 8 bits (or 4), and both ways
// return the same ones, so the pictures may differ by the rounding of one sum of lights alone: 1/255.
#include <algorithm>
#include <cmath>

#include "image/renderer/harness.h"

namespace gnomon::renderer::image_test {
namespace {

GNOMON_IMAGE_TEST_SUITE(DeferredIsInline);

struct FilterCase {
    const char* name;
    Filter filter;
    std::uint32_t radius = 1;
    PcssTaps taps = kFewTaps;
    std::uint32_t bits = 8;
};
constexpr FilterCase kHard = {"hard", Filter::Hard}, kPcf1 = {"pcf1", Filter::Pcf, 1}, kPcf3 = {"pcf3", Filter::Pcf, 3},
                     kPcss = {"pcss", Filter::Pcss}, kPcssMany = {"pcss 16+24", Filter::Pcss, 1, kPcssMedium},
                     kPcssFourBits = {"pcss, 4 bits", Filter::Pcss, 1, kFewTaps, 4},
                     kPcfFourBits = {"pcf1, 4 bits", Filter::Pcf, 1, kFewTaps, 4},
                     kShared = {"pcss-shared", Filter::PcssShared},
                     kSharedMany = {"pcss-shared 16+24", Filter::PcssShared, 1, kPcssMedium},
                     kSharedFourBits = {"pcss-shared, 4 bits", Filter::PcssShared, 1, kFewTaps, 4};

RendererDesc withFilter(const FilterCase& filter) {
    RendererDesc desc = smallDesc();
    desc.frame.filters = {filter.filter};
    desc.frame.shadows.pcfRadius = filter.radius;
    desc.frame.shadows.pcssPresets[0] = filter.taps;
    desc.frame.shadows.visibilityBits = filter.bits;
    return desc;
}

// Scenes in which one thing stands in another's light, seen by the default camera.
bool castsShadows(const std::string& scene) {
    return scene != "empty-plane" && scene != "single-triangle" && scene != "lights-only";
}

void compareBoth(const Device& device, const char* scene, std::uint32_t scattered, const FilterCase& filter,
                 Worst& worst) {
    const View3d view = builtin(scene, scattered);
    expectDeferredIsInline(device, view.name + " " + filter.name, view, withFilter(filter), worst, castsShadows(scene));
}

void everyScene(const Device& device, const FilterCase& filter, std::uint32_t scattered, Worst& worst) {
    for (const BuiltinInfo& info : builtinScenes())
        compareBoth(device, std::string(info.name).c_str(), scattered, filter, worst);
}

TEST_P(DeferredIsInline, EverySceneWithItsOwnLights) {
    Worst worst;
    for (const FilterCase& filter : {kPcss, kShared}) {
        if (thorough())
            everyScene(device(), filter, 0, worst);
        else
            for (const char* scene : {"boxes", "sundial"}) compareBoth(device(), scene, 0, filter, worst);
    }
    if (fullRun())
        for (const FilterCase& filter : {kHard, kPcf1, kPcf3}) everyScene(device(), filter, 0, worst);
    worst.report(device(), "deferred against inline, own lights");
}

TEST_P(DeferredIsInline, OtherFilters) {
    Worst worst;
    compareBoth(device(), "columns", 64, kPcf3, worst);
    if (thorough()) {
        compareBoth(device(), "boxes", 0, kHard, worst);
        compareBoth(device(), "sundial", 0, kPcf1, worst);
        compareBoth(device(), "masked", 0, kPcssMany, worst);
        compareBoth(device(), "masked", 0, kSharedMany, worst);
    }
    worst.report(device(), "deferred against inline, other filters");
}

// Derived from the depth of neighbours, in each pipeline anew: with columns a pixel wide, and without perspective.
TEST_P(DeferredIsInline, FaceNormalsFromDepth) {
    Worst worst;
    RendererDesc desc = withFilter(kHard);
    desc.frame.readFaceNormals = false;
    const View3d columns = builtin("columns");
    expectDeferredIsInline(device(), "columns, normals from depth", columns, desc, worst, true);
    if (thorough())
        expectDeferredIsInline(device(), "orthographic columns, normals from depth", orthographic(columns, 8.0f), desc,
                               worst, true);
    worst.report(device(), "deferred against inline, normals from depth");
}

// Slots of 4 bits against themselves: evaluated shadows are rounded as stored ones are.
TEST_P(DeferredIsInline, SlotsOfFourBits) {
    Worst worst;
    compareBoth(device(), "sundial", 64, kPcssFourBits, worst);
    compareBoth(device(), "sundial", 64, kSharedFourBits, worst);
    if (thorough()) {
        compareBoth(device(), "courtyard", 0, kPcssFourBits, worst);
        compareBoth(device(), "boxes", 0, kPcfFourBits, worst);
    }
    worst.report(device(), "deferred against inline, 4 bits");
}

// Lights of all three types take turns with four filters and two presets of taps, in one frame.
TEST_P(DeferredIsInline, FiltersMixedInOneFrame) {
    Worst worst;
    const View3d view = builtin("sundial", 64);
    RendererDesc desc = withFilter(kPcss);
    desc.frame.filters = {Filter::Hard, Filter::PcssShared, Filter::Pcf, Filter::Pcss, Filter::Pcss};
    desc.frame.shadows.pcssPresets = {kFewTaps, PcssTaps{8, 12}};
    desc.frame.shadows.pcssPresetCount = 2;
    const Frame mixed = expectDeferredIsInline(device(), "mixed filters", view, desc, worst, true);
    if (thorough()) {
        desc.frame.shadows.visibilityBits = 4;
        expectDeferredIsInline(device(), "mixed filters, 4 bits", view, desc, worst, true);
    }
    // The turns are taken: no single filter makes this picture.
    for (const FilterCase& filter : {kHard, kPcss}) {
        const Frame alone = drawOnce(device(), view, withFilter(filter), ShadowMode::Deferred);
        EXPECT_FALSE(alone.linear.rgba == mixed.linear.rgba) << filter.name;
    }
    worst.report(device(), "deferred against inline, mixed filters");
}

TEST_P(DeferredIsInline, With64And256LightsMore) {
    Worst worst;
    if (fullRun()) {
        for (const FilterCase& filter : {kPcss, kPcf3})
            for (const std::uint32_t scattered : {64u, 256u}) everyScene(device(), filter, scattered, worst);
    } else if (thorough()) {
        compareBoth(device(), "sundial", 64, kPcssMany, worst);
        compareBoth(device(), "courtyard", 256, kPcss, worst);
        compareBoth(device(), "columns", 256, kPcss, worst);
    }
    worst.report(device(), "deferred against inline, many lights");
}

// The pattern turns with the frame's number, so each way needs a renderer of its own that is as many frames old.
TEST_P(DeferredIsInline, PatternPerFrame) {
    const View3d view = builtin("boxes");
    RendererDesc desc = withFilter(kPcss);
    desc.frame.filters = {Filter::Pcss, Filter::PcssShared};
    desc.frame.shadows.patternPerFrame = true;
    Renderer inlined(device(), view.scene, desc, pipelinesOf(device()));
    Renderer deferred(device(), view.scene, desc, pipelinesOf(device()));
    HdrPicture before;
    Worst worst;
    for (int frame = 0; frame < 3; ++frame) {
        const HdrPicture expected = draw(inlined, view.camera, ShadowMode::Inline).linear;
        const HdrPicture actual = draw(deferred, view.camera, ShadowMode::Deferred).linear;
        worst.add(expectEqual(device(), "pattern of frame " + std::to_string(frame), expected, actual, 1), "pattern");
        EXPECT_FALSE(actual.rgba == before.rgba) << "the pattern has not turned";
        before = actual;
    }
    worst.report(device(), "pattern per frame");
}

// Channels that differ by more than the rounding of a sum of lights. A step of one stored visibility is more than that.
std::size_t differing(const HdrPicture& a, const HdrPicture& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        count += std::abs(a.rgba[i] - b.rgba[i]) > 1e-5f * std::max(a.rgba[i], b.rgba[i]);
    return count;
}

// One search for four pixels: passes make it once for a tile, and shaders of the host anew for every pixel. Both find
// the same, with every size of subgroup and in extents that cut the four pixels.
TEST_P(DeferredIsInline, SharedSearchesToTheBit) {
    const View3d view = builtin("sundial", 32);
    const DeviceInfo& info = device().info();
    HdrPicture first;
    for (std::uint32_t size = std::max(4u, info.minSubgroupSize); size <= info.maxSubgroupSize; size *= 2) {
        SCOPED_TRACE("subgroups of " + std::to_string(size));
        RendererDesc desc = withFilter(kShared);
        desc.frame.widthPx = 131;
        desc.frame.heightPx = 77;
        desc.subgroupSize = size;
        Renderer renderer(device(), view.scene, desc, pipelinesOf(device(), size));
        const HdrPicture inlined = draw(renderer, view.camera, ShadowMode::Inline).linear;
        const HdrPicture deferred = draw(renderer, view.camera, ShadowMode::Deferred).linear;
        ASSERT_EQ(inlined.rgba.size(), deferred.rgba.size());
        EXPECT_EQ(differing(inlined, deferred), 0u);
        if (first.rgba.empty()) first = deferred;
        EXPECT_EQ(differing(first, deferred), 0u);
    }
    EXPECT_FALSE(first.rgba.empty());
}

// Bounds of the shadowmaps end searches, and change no bit; not even where frames without them came in between.
TEST_P(DeferredIsInline, ShadowBoundsChangeNothing) {
    for (const char* scene : {"sundial", "courtyard"}) {
        if (!thorough() && scene == std::string("courtyard")) continue;
        const View3d view = builtin(scene, 32);
        SCOPED_TRACE(view.name);
        RendererDesc desc = withFilter(kPcss);
        desc.frame.filters = {Filter::Pcss, Filter::PcssShared};
        desc.frame.shadows.shadowBounds = false;
        Renderer plain(device(), view.scene, desc, pipelinesOf(device()));
        const HdrPicture expected = draw(plain, view.camera, ShadowMode::Deferred).linear;
        desc.frame.shadows.shadowBounds = true;
        Renderer bounded(device(), view.scene, desc, pipelinesOf(device()));
        draw(bounded, view.camera, ShadowMode::Off);  // draws the shadowmaps, makes no bounds
        for (const ShadowMode mode : {ShadowMode::Deferred, ShadowMode::Inline}) {
            const HdrPicture actual = draw(bounded, view.camera, mode).linear;
            expectEqual(device(), view.name + " with shadow bounds", expected, actual, 0);
            EXPECT_TRUE(mode == ShadowMode::Inline || actual.rgba == expected.rgba);
        }
    }
}

}  // namespace
}  // namespace gnomon::renderer::image_test
