// Phase 4 against the oracle: final lists, flags, slots and their bytes, for every filter; and a host's own provider.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "checks.h"
#include "scenes.h"

namespace gnomon::test {
namespace {

class ShadowsTest : public GpuTest {};
GNOMON_ON_EVERY_DEVICE(ShadowsTest);

constexpr std::optional<Filter> kOff;  // no filter in use: everything is lit

struct FilterCase {
    std::optional<Filter> filter;
    std::uint32_t radius;
    PcssTaps taps;
    std::uint32_t bits;
    double mostAmbiguous, mostLoose;  // shares of (pixel, light) pairs with more than one, two acceptable values
};
constexpr FilterCase kFilters[] = {{Filter::Hard, 1, {}, 8, 0.001, 0.001},
                                   {Filter::Hard, 1, {}, 4, 0.001, 0.001},
                                   {Filter::Pcf, 1, {}, 8, 0.006, 0.001},
                                   {Filter::Pcf, 2, {}, 4, 0.001, 0.001},
                                   {Filter::Pcf, 3, {}, 8, 0.006, 0.001},
                                   {kOff, 1, {}, 8, 0.0, 0.0},
                                   {Filter::Pcss, 1, kPcssMedium, 8, 0.01, 0.001},
                                   {Filter::Pcss, 1, kPcssHigh, 8, 0.01, 0.001},
                                   {Filter::Pcss, 1, kPcssLow, 4, 0.001, 0.001},
                                   {Filter::Pcss, 1, {1, 1}, 8, 0.01, 0.001},
                                   {Filter::PcssShared, 1, kPcssMedium, 8, 0.01, 0.002},
                                   {Filter::PcssShared, 1, kPcssHigh, 8, 0.01, 0.002},
                                   {Filter::PcssShared, 1, kPcssLow, 4, 0.002, 0.001},
                                   {Filter::PcssShared, 1, {1, 1}, 8, 0.01, 0.002}};

void checkFilter(TestDevice& device, FrameInput input, const FilterCase& filter) {
    const int number = filter.filter ? int(*filter.filter) : -1;
    SCOPED_TRACE("filter " + std::to_string(number) + " radius " + std::to_string(filter.radius) + " search taps " +
                 std::to_string(filter.taps.searchTaps) + " bits " + std::to_string(filter.bits));
    useFilter(input, filter.filter.value_or(Filter::Pcf));
    if (!filter.filter) input.settings.filters = 0;
    input.settings.pcfRadius = filter.radius;
    input.settings.pcssPresets[0] = filter.taps;
    input.settings.visibilityBits = filter.bits;
    Rig rig(device, {}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    const Checked checked = checkFrame(input, rig.run(input));
    const reference::ShadowReport& s = checked.shadows;
    EXPECT_GT(s.pairs, 3000u);
    EXPECT_LE(s.ambiguousShare(), filter.mostAmbiguous);
    EXPECT_LE(s.looseShare(), filter.mostLoose);
    EXPECT_EQ(s.wrongBytes, 0u);
    EXPECT_GT(s.allLit, 20u);
    if (filter.filter) {
        EXPECT_GT(s.slots, 20u);
        EXPECT_GT(s.allUnlit, 3u);
        EXPECT_GT(s.exactBytes, s.bytes / 2);
    }
    std::printf("    filter %d: pairs %zu ambiguous %.4f loose %.4f slots %zu lit %zu dark %zu\n", number, s.pairs,
                s.ambiguousShare(), s.looseShare(), s.slots, s.allLit, s.allUnlit);
}

TEST_P(ShadowsTest, EveryFilter) {
    RoomSetup setup{.seed = 6, .widthPx = 72, .heightPx = 64};
    setup.lights.castingShare = 0.9;
    setup.lights.suns = 3;
    setup.lights.maxSourceRadius = 0.3;
    FrameInput input = makeRoomFrame(setup);
    input.lights.back().shadowFadeStartMetres = 4;
    input.lights.back().shadowFadeEndMetres = 9;
    for (const FilterCase& filter : kFilters) {
        input.settings.patternPerFrame = filter.bits == 8;
        checkFilter(device(), input, filter);
    }
}

// The modes beside the default, with and without the rule for faces that look away.
TEST_P(ShadowsTest, EveryDepthBias) {
    RoomSetup setup{.seed = 14, .widthPx = 56, .heightPx = 40};
    setup.lights.castingShare = 1.0;
    setup.lights.suns = 1;
    setup.lights.maxSourceRadius = 0.3;
    FrameInput input = makeRoomFrame(setup);
    // Every third light without a bias: only the rounding says which way it points.
    FrameInput nothing = input;
    for (std::size_t i = 0; i < nothing.lights.size(); i += 3) nothing.lights[i].biasMetres = 0.0f;
    struct Mode {
        DepthBias bias;
        bool facedAwayIsDark;
        Filter filter;
    };
    constexpr Mode kModes[] = {
        {DepthBias::Oriented, true, Filter::Hard},          {DepthBias::Oriented, false, Filter::Hard},
        {DepthBias::OrientedConstant, true, Filter::Hard},  {DepthBias::OrientedConstant, false, Filter::Hard},
        {DepthBias::Unbiased, true, Filter::Hard},          {DepthBias::Unbiased, false, Filter::Hard},
        {DepthBias::OrientedConstant, false, Filter::Pcss}, {DepthBias::Unbiased, true, Filter::Pcss},
        {DepthBias::Oriented, false, Filter::PcssShared},   {DepthBias::OrientedConstant, false, Filter::PcssShared},
        {DepthBias::Unbiased, false, Filter::PcssShared}};
    std::vector<std::vector<std::uint32_t>> bytes;
    for (const Mode& mode : kModes) {
        SCOPED_TRACE("bias " + std::to_string(int(mode.bias)) + " faced away is dark: " +
                     std::to_string(mode.facedAwayIsDark) + " filter " + std::to_string(int(mode.filter)));
        for (FrameInput* frame : {&input, &nothing}) {
            useFilter(*frame, mode.filter);
            frame->settings.depthBias = mode.bias;
            frame->settings.facedAwayIsDark = mode.facedAwayIsDark;
        }
        Rig rig(device(), {}, viewDescFor(input));
        ASSERT_TRUE(rig.ok());
        const FrameResult result = rig.run(input);
        const Checked checked = checkFrame(input, result);
        // Without a bias, a surface that lies level in a map ties with itself.
        EXPECT_LT(checked.shadows.ambiguousShare(), mode.bias == DepthBias::Unbiased ? 0.5 : 0.02);
        EXPECT_LT(checkFrame(nothing, rig.run(nothing)).shadows.ambiguousShare(), 0.5);
        EXPECT_GT(checked.shadows.slots, 10u);
        std::printf("    bias %d %d: pairs %zu ambiguous %.4f\n", int(mode.bias), int(mode.facedAwayIsDark),
                    checked.shadows.pairs, checked.shadows.ambiguousShare());
        bytes.push_back(result.visibility);
    }
    for (std::size_t i = 0; i < bytes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) EXPECT_NE(bytes[i], bytes[j]) << i << " and " << j << " do the same";
}

// No mode needs face normals that has no use for them.
TEST_P(ShadowsTest, UnbiasedWithoutFaceNormals) {
    RoomSetup setup{.seed = 15, .widthPx = 40, .heightPx = 32};
    setup.lights.castingShare = 1.0;
    FrameInput input = makeRoomFrame(setup);
    input.settings.depthBias = DepthBias::Unbiased;
    input.settings.facedAwayIsDark = false;
    Rig rig(device(), {}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    const FrameResult with = rig.run(input);
    input.receivers.faceNormals.clear();
    rig.dropImages();
    const FrameResult without = rig.run(input);
    const Checked checked = checkFrame(input, without);
    EXPECT_LT(checked.shadows.ambiguousShare(), 0.5);
    EXPECT_EQ(decodeFinalLists(with), decodeFinalLists(without));
}

// A depth image of few bits: the bias grows with its step, and standard Z makes that metres far away.
TEST_P(ShadowsTest, CoarseDepthImages) {
    RoomSetup setup{.seed = 16, .widthPx = 48, .heightPx = 40};
    setup.lights.castingShare = 1.0;
    setup.lights.filters = only(Filter::Hard);
    FrameInput input = makeRoomFrame(setup);
    const auto lit = [&](double step) {
        input.receivers.depthStep = step;
        Rig rig(device(), {}, viewDescFor(input));
        if (!rig.ok()) return std::size_t{0};
        const Checked checked = checkFrame(input, rig.run(input));
        EXPECT_LT(checked.shadows.ambiguousShare(), 0.02);
        return checked.shadows.allLit;
    };
    const std::size_t fine = lit(0), d16 = lit(1.0 / 65535.0), coarse = lit(1e-2);
    EXPECT_LE(fine, d16);
    EXPECT_LT(d16, coarse);
}

// Near planes that cut no housing of a lamp: depths are a millionth of what they were, and as fine.
TEST_P(ShadowsTest, TinyNearPlanes) {
    RoomSetup setup{.seed = 18, .widthPx = 56, .heightPx = 40};
    setup.lights.castingShare = 1.0;
    setup.lights.maxSourceRadius = 0.3;
    setup.shadows.nearMetres = 1e-7;
    setup.shadows.mixDepthKinds = false;  // with standard Z nothing is left of such depths
    for (const bool infinite : {true, false}) {
        setup.shadows.infiniteFar = infinite;
        FrameInput input = makeRoomFrame(setup);
        for (const Filter filter : {Filter::Hard, Filter::Pcss}) {
            SCOPED_TRACE(int(filter));
            useFilter(input, filter);
            input.settings.shadowBounds = filter == Filter::Pcss;
            Rig rig(device(), {}, viewDescFor(input));
            ASSERT_TRUE(rig.ok());
            const Checked checked = checkFrame(input, rig.run(input));
            EXPECT_LT(checked.shadows.ambiguousShare(), 0.02);
            EXPECT_GT(checked.shadows.slots, 10u);
            EXPECT_GT(checked.shadows.allLit, 10u);
        }
    }
}

// Shadowmaps of 16 bits: without their step in the bias, faces shadow themselves.
TEST_P(ShadowsTest, CoarseShadowAtlases) {
    RoomSetup setup{.seed = 17, .widthPx = 48, .heightPx = 40};
    setup.lights.castingShare = 1.0;
    setup.lights.suns = 2;
    setup.shadows.reversed = false;
    setup.shadows.infiniteFar = false;
    setup.shadows.nearMetres = 0.02;
    setup.lights.filters = only(Filter::Hard);
    FrameInput input = makeRoomFrame(setup);
    constexpr double kStep = 1.0 / 65535.0;
    auto lit = [&](double step) {
        auto coarse = std::make_shared<reference::TestShadows>(*input.shadows);
        for (reference::AtlasCopy& atlas : coarse->atlases) {
            atlas.depthStep = step;
            for (float& depth : atlas.depth)
                depth = static_cast<float>(std::floor(static_cast<double>(depth) / kStep) * kStep);
        }
        FrameInput stepped = input;
        stepped.shadows = coarse;
        Rig rig(device(), {}, viewDescFor(input));
        if (!rig.ok()) return std::size_t{0};
        const Checked checked = checkFrame(stepped, rig.run(stepped));
        EXPECT_LT(checked.shadows.ambiguousShare(), 0.02);
        return checked.shadows.allLit;
    };
    const std::size_t without = lit(0), with = lit(kStep);
    EXPECT_LT(without, with);
}

// Six faces that reach farther beyond 90 degrees than PCF needs: soft shadows look at the next face less often.
TEST_P(ShadowsTest, WideFaces) {
    RoomSetup setup{.seed = 19, .widthPx = 56, .heightPx = 40};
    setup.lights.castingShare = 1.0;
    setup.lights.maxSourceRadius = 0.5;
    setup.shadows.viewSizePx = 64;
    std::vector<std::vector<std::uint32_t>> bytes;
    for (const double border : {0.0, 8.0, 20.0}) {
        setup.shadows.borderTexels = border;
        FrameInput input = makeRoomFrame(setup);
        for (const Filter filter : {Filter::Pcss, Filter::PcssShared, Filter::Pcf, Filter::Hard}) {
            if (border == 0.0 && !isSoft(filter)) continue;  // other tests have it
            SCOPED_TRACE("border " + std::to_string(border) + " filter " + std::to_string(int(filter)));
            useFilter(input, filter);
            input.settings.shadowBounds = isSoft(filter);
            Rig rig(device(), {}, viewDescFor(input));
            ASSERT_TRUE(rig.ok());
            const FrameResult result = rig.run(input);
            const Checked checked = checkFrame(input, result);
            EXPECT_LT(checked.shadows.ambiguousShare(), 0.02);
            EXPECT_GT(checked.shadows.slots, 10u);
            EXPECT_GT(checked.shadows.allLit, 10u);
            std::printf("    border %g filter %d: pairs %zu ambiguous %.4f\n", border, int(filter),
                        checked.shadows.pairs, checked.shadows.ambiguousShare());
            bytes.push_back(result.visibility);
        }
    }
    for (std::size_t i = 0; i < bytes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) EXPECT_NE(bytes[i], bytes[j]) << i << " and " << j << " are the same";
}

// Any camera, any mixture of depths, any size of rectangle. GNOMON_FULL=1 looks at many more.
TEST_P(ShadowsTest, RandomRooms) {
    const std::uint64_t seeds = fullRun() ? 200 : 3;
    std::size_t pairs = 0, ambiguous = 0, loose = 0;
    for (std::uint64_t seed = 1; seed <= seeds && !HasFailure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        reference::Random random(seed + 9000);
        RoomSetup setup{.seed = seed, .widthPx = 32, .heightPx = 24};
        setup.camera = reference::randomCamera(random);
        setup.lights.count = 20;
        setup.lights.suns = random.below(3);
        setup.lights.castingShare = 1;
        setup.lights.maxSourceRadius = random.uniform(0, 0.6);
        setup.shadows.viewSizePx = 12 + random.below(60);
        setup.shadows.infiniteFar = random.chance(0.5);
        setup.shadows.borderTexels = random.below(1 + setup.shadows.viewSizePx / 4);
        setup.lights.filters = only(Filter::Pcss) | only(Filter::PcssShared);
        FrameInput input = makeRoomFrame(setup);
        const PcssTaps presets[] = {kPcssLow, kPcssMedium, kPcssHigh};
        input.settings.shadowBounds = seed % 2 != 0;
        input.settings.pcssPresets[0] = presets[seed % 3];
        input.settings.visibilityBits = seed % 2 == 0 ? 4 : 8;
        Rig rig(device(), {}, viewDescFor(input));
        ASSERT_TRUE(rig.ok());
        const Checked checked = checkFrame(input, rig.run(input));
        pairs += checked.shadows.pairs;
        ambiguous += checked.shadows.ambiguousPairs;
        loose += checked.shadows.loosePairs;
    }
    // Pixels far from a camera with standard Z are known to no better than the bias.
    EXPECT_LT(double(ambiguous), 0.1 * double(pairs));
    std::printf("    %llu rooms: pairs %zu ambiguous %.4f loose %.4f\n", static_cast<unsigned long long>(seeds), pairs,
                double(ambiguous) / double(pairs), double(loose) / double(pairs));
}

// Bounds of the shadowmaps spare searches, and change nothing: fresh ones, kept ones, and those of other shadowmaps.
TEST_P(ShadowsTest, ShadowBounds) {
    RoomSetup setup{.seed = 12, .widthPx = 72, .heightPx = 48};
    setup.lights = {.count = 12, .castingShare = 1, .maxRangeMetres = 9, .spreadMetres = 5, .suns = 2};
    setup.lights.maxSourceRadius = 0.4;
    setup.shadows = {.viewSizePx = 90, .mixDepthKinds = true};
    setup.lights.filters = only(Filter::Pcss) | only(Filter::PcssShared);
    FrameInput input = makeRoomFrame(setup);
    Rig plain(device(), {}, viewDescFor(input)), bounded(device(), {}, viewDescFor(input));
    ASSERT_TRUE(plain.ok() && bounded.ok());
    for (const bool changed : {true, false}) {
        input.settings.shadowBounds = false;
        const FrameResult result = plain.run(input);
        if (changed) checkFrame(input, result);
        input.settings.shadowBounds = true;
        input.shadowViewsChanged = changed;
        EXPECT_EQ(decodeFinalLists(result), decodeFinalLists(bounded.run(input))) << "changed " << changed;
    }
    reference::Random random(setup.seed + 1);
    const reference::Shapes others = reference::makeRoom(random, 4);
    auto shadows = std::make_shared<reference::TestShadows>(*input.shadows);
    for (const ShadowView& view : shadows->views)
        reference::renderShadowView(others, view, shadows->atlases[view.atlas]);
    input.shadows = shadows;
    input.shadowViewsChanged = true;
    const FrameResult result = bounded.run(input);
    checkFrame(input, result);
    input.settings.shadowBounds = false;
    EXPECT_EQ(decodeFinalLists(result), decodeFinalLists(plain.run(input)));
}

// Extents that cut tiles, and quads of pixels that share a search.
TEST_P(ShadowsTest, RaggedExtents) {
    struct Extent {
        std::uint32_t widthPx, heightPx;
    };
    RoomSetup setup{.seed = 20};
    setup.lights.castingShare = 1.0;
    setup.lights.suns = 1;
    setup.lights.maxSourceRadius = 0.4;
    setup.lights.filters = only(Filter::PcssShared);
    std::size_t bytes = 0;
    for (const Extent extent : {Extent{1, 1}, Extent{3, 40}, Extent{45, 7}, Extent{37, 29}, Extent{42, 31}}) {
        SCOPED_TRACE(std::to_string(extent.widthPx) + "x" + std::to_string(extent.heightPx));
        setup.widthPx = extent.widthPx;
        setup.heightPx = extent.heightPx;
        FrameInput input = makeRoomFrame(setup);
        input.viewportXPx = 7;
        input.viewportYPx = 3;  // quads are those of the active extent
        for (const LightLists lists : {LightLists::Froxel, LightLists::Pixel}) {
            input.settings.lightLists = lists;
            Rig rig(device(), {}, viewDescFor(input));
            ASSERT_TRUE(rig.ok());
            const Checked checked = checkFrame(input, rig.run(input));
            EXPECT_LE(checked.shadows.looseShare(), 0.003);
            bytes += checked.shadows.bytes;
        }
    }
    EXPECT_GT(bytes, 2000u);
}

// Finite far planes, standard depth, four atlases, the smallest rectangles.
TEST_P(ShadowsTest, EveryKindOfShadowView) {
    RoomSetup setup{.seed = 7, .widthPx = 56, .heightPx = 40};
    setup.lights.castingShare = 1.0;
    setup.lights.suns = 2;
    for (const std::uint32_t size : {8u, 33u}) {
        for (const bool reversed : {true, false}) {
            setup.shadows = {.viewSizePx = size,
                             .cellsPerRow = 5,
                             .atlasCount = 4,
                             .layers = 3,
                             .reversed = reversed,
                             .infiniteFar = false};
            FrameInput input = makeRoomFrame(setup);
            input.settings.pcfRadius = size == 8 ? 3 : 2;
            input.settings.pcssPresets[0] = kPcssLow;
            for (const Filter filter : {Filter::Pcf, Filter::Pcss, Filter::PcssShared}) {
                useFilter(input, filter);
                Rig rig(device(), {}, viewDescFor(input));
                ASSERT_TRUE(rig.ok());
                const Checked checked = checkFrame(input, rig.run(input));
                EXPECT_LT(checked.shadows.ambiguousShare(), 0.03);
                EXPECT_GT(checked.shadows.slots, 10u);
            }
        }
    }
}

// Cascades whose rectangles are not square, and end within the picture; in the one atlas that the context allows.
TEST_P(ShadowsTest, OblongCascades) {
    RoomSetup setup{.seed = 8, .widthPx = 56, .heightPx = 40};
    setup.lights.count = 0;
    FrameInput input = makeRoomFrame(setup);
    reference::Random random(setup.seed);
    const reference::Shapes shapes = reference::makeRoom(random, setup.objects);
    auto shadows = std::make_shared<reference::TestShadows>();
    shadows->atlases.assign(1, {});
    reference::AtlasCopy& atlas = shadows->atlases[0];
    atlas.widthPx = 100;
    atlas.heightPx = 80;
    atlas.depth.assign(8000, 1.0f);
    for (const bool reversed : {true, false}) {
        Light light;
        light.type = LightType::Directional;
        // Not quite down: a wall that the light grazes may or may not look at it.
        const reference::Vec3 direction = normalize(reference::Vec3{0.1, -1, 0.15});
        const reference::Vec3 down = normalize(cross(direction, reference::Vec3{1, 0, 0}));
        light.direction[0] = static_cast<float>(direction.x);
        light.direction[1] = static_cast<float>(direction.y);
        light.direction[2] = static_cast<float>(direction.z);
        light.sourceRadius = 0.1f;
        input.lightViews.push_back({static_cast<std::uint32_t>(shadows->views.size()), 1});
        input.lights.push_back(light);
        ShadowView view =
            reference::makeShadowView({reversed ? 1.0 : -1.0, 6, 0}, direction, down, 5.0, 0.1, 10.0, true, reversed);
        view.xPx = reversed ? 1 : 45;
        view.yPx = 2;
        view.widthPx = 40;
        view.heightPx = 70;
        reference::renderShadowView(shapes, view, atlas);
        shadows->views.push_back(view);
    }
    input.shadows = shadows;
    for (const Filter filter : {Filter::Hard, Filter::Pcf, Filter::Pcss, Filter::PcssShared}) {
        useFilter(input, filter);
        input.settings.pcfRadius = 2;
        Rig rig(device(), {.maxShadowAtlases = 1}, viewDescFor(input));
        ASSERT_TRUE(rig.ok());
        const Checked checked = checkFrame(input, rig.run(input));
        EXPECT_LT(checked.shadows.ambiguousShare(), 0.03);
        EXPECT_GT(checked.shadows.slots, 5u);
    }
}

// A provider that the host compiled in: bright and grey cells of half a metre. See host_provider/.
TEST_P(ShadowsTest, HostProvider) {
    RoomSetup setup{.seed = 9};
    setup.lights.castingShare = 1;
    setup.lights.fadingShare = 0;
    setup.lights.filters = only(Filter::Host);
    const FrameInput input = makeRoomFrame(setup);
    Rig rig(device(), {.hostProvider = true}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    const FrameResult result = rig.run(input);
    CheckOptions options;
    options.bytes = false;  // the oracle knows the library's own filters
    const Checked checked = checkFrame(input, result, options);
    const reference::ListBuffers lists = result.lists();
    std::size_t bright = 0, grey = 0, dark = 0;
    for (std::uint32_t tile = 0; tile < result.slotIds.size(); ++tile) {
        for (const reference::FinalEntry& entry : reference::finalEntries(lists, tile)) {
            const reference::LightModel& light = checked.lights[entry.light];
            if (!light.casts || !reference::isSlot(entry.slotOrFlag)) continue;
            for (const auto [x, y] : checked.grid.tilePixels(tile % lists.tilesX, tile / lists.tilesX)) {
                const reference::Pixel& pixel = checked.grid.at(x, y);
                if (reference::inInfluence(light, pixel) != reference::Verdict::Must) continue;
                const reference::Verdict facing =
                    pixel.subsurface ? reference::Verdict::Must : reference::facesLight(light, pixel);
                if (facing == reference::Verdict::May) continue;
                const double p[3] = {2 * pixel.position.x, 2 * pixel.position.y, 2 * pixel.position.z};
                int cell = 0;
                bool border = false;
                for (const double v : p) {
                    cell += static_cast<int>(std::floor(v));
                    border = border || std::abs(v - std::round(v)) < 1e-4;
                }
                if (border) continue;
                const int expected = facing == reference::Verdict::Never ? 0 : cell % 2 == 0 ? 255 : 128;
                ASSERT_EQ(int(reference::storedVisibility(lists, entry.slotOrFlag, x % 8, y % 8)), expected);
                ++(expected == 0 ? dark : expected == 255 ? bright : grey);
            }
        }
    }
    EXPECT_GT(bright, 100u);
    EXPECT_GT(grey, 100u);
    EXPECT_GT(dark, 10u);
}

}  // namespace
}  // namespace gnomon::test
