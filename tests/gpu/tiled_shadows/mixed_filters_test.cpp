// Lights of one frame with filters of their own: hard, percentage closer, and soft with two presets; points, spots and
// suns with cascades, each against the oracle.
#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "checks.h"
#include "scenes.h"

namespace gnomon::test {
namespace {

class MixedFiltersTest : public GpuTest {};
GNOMON_ON_EVERY_DEVICE(MixedFiltersTest);

struct Made {
    Filter filter;
    std::uint8_t preset;
};
constexpr Made kMade[] = {{Filter::Hard, 0}, {Filter::Pcf, 0},        {Filter::Pcss, 0},
                          {Filter::Pcss, 1}, {Filter::PcssShared, 0}, {Filter::PcssShared, 1}};

void put(const reference::Vec3& v, float out[3]) {
    out[0] = static_cast<float>(v.x);
    out[1] = static_cast<float>(v.y);
    out[2] = static_cast<float>(v.z);
}

/// Of every filter and preset three points, three spots that look down at the room, and a sun.
std::vector<Light> mixedLights(reference::Random& random) {
    std::vector<Light> lights;
    for (int round = 0; round < 7; ++round) {
        for (const Made& made : kMade) {
            Light light;
            light.filter = made.filter;
            light.pcssPreset = made.preset;
            light.type = round == 6 ? LightType::Directional : round % 2 == 0 ? LightType::Spot : LightType::Point;
            const reference::Vec3 from = random.inBox({-3, 1.5, -4}, {3, 3.5, 2});
            put(from, light.position);
            put(normalize(random.inBox({-2, 0, -4}, {2, 0.5, 2}) - from), light.direction);
            if (round == 6) put(normalize(random.inBox({-1, -1.5, -1}, {1, -0.5, 1})), light.direction);
            light.outerConeAngle = 0.7f;
            light.rangeMetres = 8;
            light.sourceRadius = round == 6 ? 0.04f : 0.25f;
            lights.push_back(light);
        }
    }
    return lights;
}

FrameInput mixedRoom() {
    RoomSetup setup{.seed = 60, .widthPx = 64, .heightPx = 56};
    setup.lights.count = 0;
    FrameInput input = makeRoomFrame(setup);
    reference::Random random(setup.seed);
    const reference::Shapes shapes = reference::makeRoom(random, setup.objects);
    input.lights = mixedLights(random);
    input.shadows = std::make_shared<reference::TestShadows>(
        reference::buildShadows(shapes, input.lights, {.viewSizePx = 40, .mixDepthKinds = true}));
    input.lightViews = input.shadows->lightViews;
    input.settings.filters = kAllBuiltInFilters;
    input.settings.pcfRadius = 2;
    input.settings.pcssPresetCount = 2;
    input.settings.pcssPresets = {kPcssMedium, PcssTaps{5, 7}, kPcssHigh, kPcssHigh};
    input.settings.patternPerFrame = true;
    return input;
}

/// What a light's visibility is made by.
using Kind = std::tuple<LightType, Filter, int>;
Kind kindOf(const Light& light) {
    return {light.type, light.filter, isSoft(light.filter) ? light.pcssPreset : 0};
}

/// Slots by what made them.
std::map<Kind, std::size_t> slotsByKind(const FrameInput& input, const FrameResult& result) {
    std::map<Kind, std::size_t> slots;
    for (const auto& tile : decodeFinalLists(result))
        for (const DecodedEntry& entry : tile)
            if (entry.flag == 0) ++slots[kindOf(input.lights[entry.hostLight])];
    return slots;
}

TEST_P(MixedFiltersTest, EveryLightHasItsOwn) {
    FrameInput input = mixedRoom();
    Rig rig(device(), {}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    for (const std::uint32_t bits : {8u, 4u}) {
        SCOPED_TRACE(bits);
        input.settings.visibilityBits = bits;
        const FrameResult result = rig.run(input);
        const Checked checked = checkFrame(input, result);
        EXPECT_EQ(checked.shadows.wrongBytes, 0u);
        EXPECT_LE(checked.shadows.ambiguousShare(), bits == 8 ? 0.01 : 0.001);
        EXPECT_LE(checked.shadows.looseShare(), 0.001);
        EXPECT_GT(checked.shadows.exactBytes, checked.shadows.bytes / 2);
        const std::map<Kind, std::size_t> slots = slotsByKind(input, result);
        EXPECT_EQ(slots.size(),
                  3u * 6u);  // three types; hard, percentage closer, two soft ones each searched alone and shared
        for (const auto& [kind, count] : slots)
            EXPECT_GT(count, 2u) << "type " << int(std::get<0>(kind)) << " filter " << int(std::get<1>(kind))
                                 << " preset " << std::get<2>(kind);
        std::printf("    %u bits: slots %zu bytes %zu exact %zu ambiguous %.4f\n", bits, checked.shadows.slots,
                    checked.shadows.bytes, checked.shadows.exactBytes, checked.shadows.ambiguousShare());
    }
}

// The check above can fail: an oracle that takes one kind of light for another finds wrong values.
TEST_P(MixedFiltersTest, OthersAreFound) {
    FrameInput input = mixedRoom();
    Rig rig(device(), {}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    const FrameResult result = rig.run(input);
    const Checked checked = checkFrame(input, result, {.bytes = false});
    const reference::ShadowInput shadows = shadowInputOf(input, result);
    const auto findingsAfter = [&](auto change) {
        std::vector<reference::LightModel> lights = checked.lights;
        for (reference::LightModel& light : lights) change(light);
        return reference::checkFinalLists(checked.grid, lights, shadows, result.lists()).findings.errors;
    };
    using Model = reference::LightModel;
    EXPECT_EQ(findingsAfter([](Model&) {}), 0u);
    for (const LightType type : {LightType::Point, LightType::Spot, LightType::Directional}) {
        SCOPED_TRACE(int(type));
        const auto swapped = [&](Filter from, Filter to) {
            return findingsAfter([=](Model& light) {
                if (light.type == type && light.filter == from) light.filter = to;
            });
        };
        EXPECT_GT(swapped(Filter::Hard, Filter::Pcf), 10u);
        EXPECT_GT(swapped(Filter::Pcf, Filter::Hard), 10u);
        EXPECT_GT(swapped(Filter::Pcf, Filter::Pcss), 10u);
        EXPECT_GT(swapped(Filter::Pcss, Filter::Pcf), 10u);
        EXPECT_GT(swapped(Filter::Pcss, Filter::PcssShared), 10u);
        EXPECT_GT(swapped(Filter::PcssShared, Filter::Pcss), 10u);
        EXPECT_GT(findingsAfter([=](Model& light) {
                      if (light.type == type) light.pcssPreset ^= 1;
                  }),
                  10u);
    }
}

// What a light's own filter makes of it does not hang on the others: alone in the frame it has the same lists and slots
// as among all, whatever its pipelines hold beside.
TEST_P(MixedFiltersTest, NeighboursChangeNothing) {
    FrameInput input = mixedRoom();
    input.settings.patternPerFrame = false;
    Rig rig(device(), {}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    const auto mixed = decodeFinalLists(rig.run(input));
    std::size_t compared = 0;
    for (const Filter filter : {Filter::Hard, Filter::Pcf, Filter::Pcss, Filter::PcssShared}) {
        SCOPED_TRACE(int(filter));
        FrameInput one = input;
        useFilter(one, filter);  // all lights, and pipelines without the others' code
        const FrameResult result = rig.run(one);
        checkFrame(one, result);
        const auto alone = decodeFinalLists(result);
        ASSERT_EQ(alone.size(), mixed.size());
        for (std::size_t tile = 0; tile < mixed.size(); ++tile) {
            std::map<std::uint32_t, DecodedEntry> entries;
            for (const DecodedEntry& entry : alone[tile]) entries[entry.hostLight] = entry;
            for (const DecodedEntry& entry : mixed[tile]) {
                if (input.lights[entry.hostLight].filter != filter) continue;
                ++compared;
                EXPECT_TRUE(entries[entry.hostLight] == entry) << "tile " << tile << " light " << entry.hostLight;
            }
        }
    }
    EXPECT_GT(compared, 300u);
}

}  // namespace
}  // namespace gnomon::test
