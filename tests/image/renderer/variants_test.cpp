// Deferred equals inline whatever the camera, the depth buffer, the extent, the way list space is given out, and
// however small the pools are: without a slot or list space a light is evaluated while lighting, and the picture stays.
#include <functional>

#include "image/renderer/harness.h"

namespace gnomon::renderer::image_test {
namespace {

GNOMON_IMAGE_TEST_SUITE(Variants);
GNOMON_IMAGE_TEST_SUITE(Overflow);

const View3d& courtyard64() {
    static const View3d view = builtin("courtyard", 64);
    return view;
}
// Directional light with cascades, and 64 lights of the other kinds.
const View3d& sundial64() {
    static const View3d view = builtin("sundial", 64);
    return view;
}
const View3d& columns64() {
    static const View3d view = builtin("columns", 64);
    return view;
}

TEST_P(Variants, StandardDepth) {
    Worst worst;
    for (const View3d* view : {&sundial64(), &columns64()}) {
        if (!fullRun() && view == &columns64()) continue;
        RendererDesc desc = smallDesc();
        desc.frame.deviceDepth = DeviceDepth::StandardZ;
        const Frame standard =
            expectDeferredIsInline(device(), view->name + " standard depth", *view, desc, worst, true);
        // The same picture, but for what standard depth loses (lavapipe 0.02/255, SwiftShader 0.34).
        const Frame reversed = drawOnce(device(), *view, smallDesc(), ShadowMode::Deferred);
        const float exposure = automaticExposure(reversed.linear);
        const Difference apart = compare(toneMap(reversed.linear, exposure), toneMap(standard.linear, exposure));
        EXPECT_LT(apart.meanAbsolute, 0.75) << view->name;
        std::printf("[ figure   ] standard against reversed depth, %s: mean difference %.4f/255\n", view->name.c_str(),
                    apart.meanAbsolute);
    }
    worst.report(device(), "standard depth");
}

TEST_P(Variants, OrthographicCamera) {
    Worst worst;
    for (const DeviceDepth depth : {DeviceDepth::ReversedZ, DeviceDepth::StandardZ}) {
        for (const View3d* source : {&sundial64(), &columns64()}) {
            if (!fullRun() && (depth == DeviceDepth::StandardZ) != (source == &columns64())) continue;
            const View3d view = orthographic(*source, 12.0f);
            RendererDesc desc = smallDesc();
            desc.frame.deviceDepth = depth;
            expectDeferredIsInline(device(), view.name, view, desc, worst, true);
        }
    }
    worst.report(device(), "orthographic camera");
}

TEST_P(Variants, RaggedExtents) {
    Worst worst;
    const View3d view = columns64();
    const auto nameOf = [](std::uint32_t width, std::uint32_t height) {
        return "columns+64 " + std::to_string(width) + "x" + std::to_string(height);
    };
    // One renderer: smaller extents use a part of its images.
    RendererDesc desc = smallDesc(211, 117);
    desc.frame.filters = {Filter::PcssShared, Filter::Pcss};  // odd extents cut the pixels that share a search
    Renderer renderer(device(), view.scene, desc, pipelinesOf(device()));
    const std::pair<std::uint32_t, std::uint32_t> extents[] = {{211, 117}, {1, 1},  {131, 2}, {9, 7},
                                                               {65, 63},   {1, 97}, {8, 8},   {64, 64}};
    for (const auto& [width, height] : extents) {
        FrameSettings settings = renderer.settings();
        settings.widthPx = width;
        settings.heightPx = height;
        renderer.set(settings);
        expectDeferredIsInline(device(), nameOf(width, height), renderer, view.camera, worst, width * height > 4000);
    }
    // Images of just that extent: a renderer each, which software devices compile anew.
    std::size_t left = fullRun() ? std::size(extents) : thorough() ? 3 : 0;
    for (const auto& [width, height] : extents) {
        if (left == 0) break;
        --left;
        expectDeferredIsInline(device(), nameOf(width, height) + ", alone", view, smallDesc(width, height), worst,
                               width * height > 4000);
    }
    worst.report(device(), "ragged extents");
}

TEST_P(Variants, SubgroupSizes) {
    Worst worst;
    const DeviceInfo& info = device().info();
    for (std::uint32_t size = info.minSubgroupSize; size <= info.maxSubgroupSize; size *= 2) {
        RendererDesc desc = smallDesc();
        desc.subgroupSize = size;
        desc.frame.filters = {Filter::Pcss, Filter::PcssShared};
        expectDeferredIsInline(device(), "columns+64 subgroups of " + std::to_string(size), columns64(), desc, worst,
                               true);
    }
    worst.report(device(), "subgroup sizes");
}

// --- Pools ---------------------------------------------------------------------------------------------------------

constexpr std::uint32_t kAmple = 1u << 16;

RendererDesc ampleDesc(ListReservation reservation) {
    RendererDesc desc = smallDesc();
    desc.frame.filters = {Filter::PcssShared, Filter::Pcss};
    // With LightLists::Froxel it is the same as Approximate.
    if (reservation == ListReservation::Accurate) desc.frame.shadows.lightLists = LightLists::Pixel;
    desc.frame.shadows.listReservation = reservation;
    desc.frame.shadows.fixedListEntriesPerTile = 96;  // more than any tile of these scenes has
    desc.listEntries = desc.visibilitySlots = kAmple;
    return desc;
}

struct PoolCase {
    const char* name;
    std::function<void(RendererDesc&, const FrameStatistics&)> shrink;
    bool lists, slots;  // what must overflow
};

const PoolCase kPools[] = {
    {"3 list entries", [](RendererDesc& d, const FrameStatistics&) { d.listEntries = 3; }, true, false},
    {"1 slot", [](RendererDesc& d, const FrameStatistics&) { d.visibilitySlots = 1; }, false, true},
    {"3 entries and 1 slot", [](RendererDesc& d, const FrameStatistics&) { d.listEntries = 3, d.visibilitySlots = 1; },
     true, false},
    {"half the entries", [](RendererDesc& d, const FrameStatistics& s) { d.listEntries = s.listEntries / 2; }, true,
     false},
    {"half the slots", [](RendererDesc& d, const FrameStatistics& s) { d.visibilitySlots = s.visibilitySlots / 2; },
     false, true},
    {"half the entries, few slots",
     [](RendererDesc& d, const FrameStatistics& s) {
         d.listEntries = s.listEntries / 2;
         d.visibilitySlots = s.visibilitySlots / 16;
     },
     true, true},
};

void expectOverflow(const PoolCase& pool, const FrameStatistics& s) {
    EXPECT_EQ(s.listOverflowTiles > 0, pool.lists) << s.listOverflowTiles;
    // With next to no list entries hardly a tile comes to asking for a slot.
    if (pool.slots || !pool.lists) {
        EXPECT_EQ(s.slotOverflowEntries > 0, pool.slots) << s.slotOverflowEntries;
    }
    EXPECT_GT(s.evaluateTiles, 0u);
    EXPECT_LE(s.evaluateTiles, s.tilesWithGeometry);
    EXPECT_GE(s.recommendedListEntries, s.listEntries);
    EXPECT_GE(s.recommendedVisibilitySlots, s.visibilitySlots);
}

void overflow(const Device& device, const View3d& view, ListReservation reservation, const char* way, Worst& worst) {
    const std::string name = view.name + " " + way;
    SCOPED_TRACE(name);
    const RendererDesc ample = ampleDesc(reservation);
    const Frame whole = expectDeferredIsInline(device, name + ", ample pools", view, ample, worst, true);
    const FrameStatistics& s = whole.report.statistics;
    EXPECT_EQ(s.listOverflowTiles, 0u);
    EXPECT_EQ(s.slotOverflowEntries, 0u);
    EXPECT_EQ(s.evaluateTiles, 0u);
    for (const PoolCase& pool : kPools) {
        const bool chosen = pool.slots && pool.lists;  // the others are alike but for who gives out the space
        if (!fullRun() && (reservation != ListReservation::Approximate || !thorough()) && !chosen) continue;
        SCOPED_TRACE(pool.name);
        RendererDesc desc = ample;
        pool.shrink(desc, s);
        const std::string full = name + ", " + pool.name;
        const Frame frame = expectDeferredIsInline(device, full, view, desc, worst, false);
        worst.add(expectEqual(device, full + " against ample", whole.linear, frame.linear, 1), full);
        expectOverflow(pool, frame.report.statistics);
    }
}

void overflowInScenes(const Device& device, ListReservation reservation, const char* way) {
    Worst worst;
    overflow(device, sundial64(), reservation, way, worst);
    if (fullRun()) overflow(device, courtyard64(), reservation, way, worst);
    if (fullRun()) overflow(device, columns64(), reservation, way, worst);
    worst.report(device, std::string("pools, reservation ") + way);
}

TEST_P(Overflow, ApproximateReservation) {
    overflowInScenes(device(), ListReservation::Approximate, "approximate");
}
TEST_P(Overflow, AccurateReservation) {
    overflowInScenes(device(), ListReservation::Accurate, "accurate");
}
TEST_P(Overflow, FixedReservation) {
    overflowInScenes(device(), ListReservation::Fixed, "fixed");
}

}  // namespace
}  // namespace gnomon::renderer::image_test
