// Phase 4 against the oracle: final lists, flags, slots and their bytes, for every filter; and a host's own provider.
#include <gtest/gtest.h>

#include <cmath>

#include "checks.h"
#include "scenes.h"

namespace gnomon::test {
namespace {

class ShadowsTest : public GpuTest {};
GNOMON_ON_EVERY_DEVICE(ShadowsTest);

struct FilterCase {
    Filter filter;
    std::uint32_t radius;
    double mostAmbiguous;  // share of (pixel, light) pairs with more than one acceptable byte
};
constexpr FilterCase kFilters[] = {
    {Filter::Hard, 1, 0.002}, {Filter::Pcf, 1, 0.02}, {Filter::Pcf, 2, 0.02}, {Filter::Pcf, 3, 0.02}, {Filter::Off, 1, 0.0}};

void checkFilter(TestDevice& device, const FrameInput& input, const FilterCase& filter) {
    SCOPED_TRACE("filter " + std::to_string(int(filter.filter)) + " radius " + std::to_string(filter.radius));
    Rig rig(device, {.filter = filter.filter, .pcfRadius = filter.radius}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    const Checked checked = checkFrame(input, rig.run(input));
    const reference::ShadowReport& s = checked.shadows;
    EXPECT_GT(s.pairs, 3000u);
    EXPECT_LE(s.ambiguousShare(), filter.mostAmbiguous);
    EXPECT_EQ(s.wrongBytes, 0u);
    EXPECT_GT(s.allLit, 20u);
    if (filter.filter != Filter::Off) {
        EXPECT_GT(s.slots, 20u);
        EXPECT_GT(s.absent, 3u);
        EXPECT_GT(s.exactBytes, s.bytes / 2);
    }
    std::printf("    pairs %zu ambiguous %.4f slots %zu lit %zu absent %zu\n", s.pairs, s.ambiguousShare(), s.slots,
                s.allLit, s.absent);
}

TEST_P(ShadowsTest, EveryFilter) {
    RoomSetup setup{.seed = 6, .widthPx = 72, .heightPx = 64};
    setup.lights.castingShare = 0.9;
    const FrameInput input = makeRoomFrame(setup);
    for (const FilterCase& filter : kFilters) checkFilter(device(), input, filter);
}

// Finite far planes, standard depth, four atlases, the smallest rectangles.
TEST_P(ShadowsTest, EveryKindOfShadowView) {
    RoomSetup setup{.seed = 7, .widthPx = 56, .heightPx = 40};
    setup.lights.castingShare = 1.0;
    for (const std::uint32_t size : {8u, 33u}) {
        for (const bool reversed : {true, false}) {
            setup.shadows = {.viewSizePx = size, .cellsPerRow = 5, .atlasCount = 4, .layers = 3, .reversed = reversed,
                             .infiniteFar = false};
            const FrameInput input = makeRoomFrame(setup);
            Rig rig(device(), {.pcfRadius = size == 8 ? 3u : 2u}, viewDescFor(input));
            ASSERT_TRUE(rig.ok());
            const Checked checked = checkFrame(input, rig.run(input));
            EXPECT_LT(checked.shadows.ambiguousShare(), 0.03);
            EXPECT_GT(checked.shadows.slots, 10u);
        }
    }
}

// Rectangles that are not square, and orthographic views.
TEST_P(ShadowsTest, OrthographicShadowViews) {
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
        light.type = LightType::Spot;
        light.position[0] = reversed ? 1.0f : -1.0f;
        light.position[1] = 6;
        light.direction[1] = -1;
        light.direction[2] = 0;
        light.outerConeAngle = 0.8f;
        light.rangeMetres = 12;
        light.firstShadowView = static_cast<std::uint32_t>(shadows->views.size());
        input.lights.push_back(light);
        ShadowView view = reference::makeShadowView(reference::vec3(light.position), {0, -1, 0}, {0, 0, 1}, 5.0, 0.1,
                                                    10.0, true, reversed);
        view.xPx = reversed ? 1 : 45;
        view.yPx = 2;
        view.widthPx = 40;
        view.heightPx = 70;
        reference::renderShadowView(shapes, view, atlas);
        shadows->views.push_back(view);
    }
    input.shadows = shadows;
    for (const Filter filter : {Filter::Hard, Filter::Pcf}) {
        Rig rig(device(), {.filter = filter, .pcfRadius = 2}, viewDescFor(input));
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
