// How many lights, and which: the limits of the lists, masks, facing, cones, and lights at awkward places.
#include <gtest/gtest.h>

#include <algorithm>

#include "checks.h"
#include "scenes.h"

namespace gnomon::test {
namespace {

class CapacityTest : public GpuTest {};
GNOMON_ON_EVERY_DEVICE(CapacityTest);

/// A floor seen from above, without objects, 24 x 16 pixels.
FrameInput floorFrame() {
    RoomSetup setup{.widthPx = 24, .heightPx = 16};
    setup.objects = 0;
    setup.lights.count = 0;
    setup.camera.eye = {0, 3, 4};
    setup.camera.target = {0, 0, 2};
    return makeQuickFrame(setup);
}

/// Point lights over the floor that all reach everything in view.
std::vector<Light> everywhere(std::uint32_t count) {
    reference::Random random(12);
    std::vector<Light> lights(count);
    for (Light& light : lights) {
        light.position[0] = static_cast<float>(random.uniform(-3, 3));
        light.position[1] = static_cast<float>(random.uniform(0.5, 4));
        light.position[2] = static_cast<float>(random.uniform(-4, 4));
        light.rangeMetres = 60;
        light.fadeEndMetres = std::numeric_limits<float>::infinity();
        light.casts = random.chance(0.3);
        light.filter = Filter::Pcf;
    }
    return lights;
}

ViewDesc roomFor(const FrameInput& input, std::uint32_t entriesPerTile) {
    ViewDesc desc = viewDescFor(input);
    desc.listEntries = entriesPerTile * 6;
    desc.visibilitySlots = entriesPerTile * 6;
    return desc;
}

TEST_P(CapacityTest, NumberOfLights) {
    FrameInput input = floorFrame();
    input.settings.filters = only(Filter::Hard);
    for (const LightLists lists : {LightLists::Froxel, LightLists::Pixel}) {
        input.settings.lightLists = lists;
        input.settings.listReservation =
            lists == LightLists::Froxel ? ListReservation::Approximate : ListReservation::Accurate;
        Rig rig(device(), {}, roomFor(input, 1026));
        ASSERT_TRUE(rig.ok());
        for (const std::uint32_t count : {0u, 1u, 2u, 3u, 4u, 31u, 32u, 33u, 1023u, 1024u, 1025u, 1400u}) {
            SCOPED_TRACE(count);
            input.lights = everywhere(count);
            input.lightViews = sharedViews(input.lights);
            useFilter(input, Filter::Hard);
            const FrameResult result = rig.run(input);
            checkFrame(input, result, {.bytes = count < 100});
            EXPECT_EQ(result.report.given, count);
            EXPECT_EQ(result.report.visible, std::min(count, 1024u));
            EXPECT_EQ(result.report.dropped, count - std::min(count, 1024u));
            EXPECT_EQ(result.statistics.maxLightsInTile, std::min(count, 1024u));
            EXPECT_EQ(result.statistics.lights.dropped, result.report.dropped);
        }
    }
}

TEST_P(CapacityTest, DirectionalLights) {
    FrameInput input = floorFrame();
    Rig rig(device(), {}, roomFor(input, 200));
    ASSERT_TRUE(rig.ok());
    for (const std::uint32_t suns : {1u, 31u, 32u, 33u, 40u, 64u, 100u}) {
        for (const std::uint32_t points : {0u, 50u}) {
            SCOPED_TRACE(std::to_string(suns) + " directional, " + std::to_string(points) + " points");
            input.lights = everywhere(points);
            input.lightViews = sharedViews(input.lights);
            if (points != 0) input.lights[0].rangeMetres = 0.3f;
            for (std::uint32_t i = 0; i < suns; ++i) {
                Light sun;
                sun.type = LightType::Directional;
                sun.mask = i % 5 == 4 ? 0x00 : 0xFF;  // reaches nothing
                input.lights.push_back(sun);
            }
            const FrameResult result = rig.run(input);
            const Checked checked = checkFrame(input, result);
            EXPECT_EQ(result.report.directional, suns - suns / 5);
            EXPECT_GE(checked.early.must, (suns - suns / 5) * 6);
        }
    }
}

// Whether a light is in any early list.
bool listed(const FrameResult& result, std::uint32_t hostLight) {
    for (const auto& tile : decodeEarlyLists(result))
        for (const std::uint32_t light : tile)
            if (result.lights[light].hostIndex == hostLight) return true;
    return false;
}

// Below the floor: casting lights are dropped, unless the rule is off or the floor is subsurface.
TEST_P(CapacityTest, LightsThatFacesLookAwayFrom) {
    FrameInput input = floorFrame();
    input.settings.lightLists = LightLists::Pixel;
    input.lights = everywhere(2);
    for (Light& light : input.lights) {
        light.position[0] = light.position[2] = 0;
        light.position[1] = -0.5f;
    }
    input.lights[0].casts = true;
    input.lights[1].casts = false;
    input.lightViews = sharedViews(input.lights);
    Rig rig(device(), {}, roomFor(input, 30));
    ASSERT_TRUE(rig.ok());
    for (const bool drop : {true, false}) {
        for (const bool subsurface : {true, false}) {
            input.settings.dropLightsFacedAway = drop;
            for (std::size_t i = 1; i < input.receivers.receiverFlags.size(); i += 2)
                input.receivers.receiverFlags[i] = subsurface ? gpu::kReceiverSubsurfaceBit : 0;
            const FrameResult result = rig.run(input);
            checkFrame(input, result);
            EXPECT_EQ(listed(result, 0), subsurface || !drop);
            EXPECT_TRUE(listed(result, 1));
        }
    }
}

TEST_P(CapacityTest, LightAndReceiverMasks) {
    FrameInput input = floorFrame();
    Rig rig(device(), {}, roomFor(input, 30));
    ASSERT_TRUE(rig.ok());
    input.settings.lightLists = LightLists::Pixel;
    input.lights = everywhere(9);
    input.lightViews = sharedViews(input.lights);
    for (std::uint32_t i = 0; i < 9; ++i) input.lights[i].mask = static_cast<std::uint8_t>(i == 8 ? 0 : 1u << i);
    for (std::uint32_t receiver : {0x01u, 0x80u, 0x3Cu, 0xFFu, 0x00u}) {
        for (std::size_t i = 0; i < input.receivers.receiverFlags.size(); i += 2)
            input.receivers.receiverFlags[i] = static_cast<std::uint8_t>(receiver);
        const FrameResult result = rig.run(input);
        checkFrame(input, result);
        for (std::uint32_t i = 0; i < 9; ++i) EXPECT_EQ(listed(result, i), (receiver & input.lights[i].mask) != 0);
    }
}

TEST_P(CapacityTest, AwkwardPlaces) {
    RoomSetup setup{.seed = 13, .widthPx = 72, .heightPx = 48};
    setup.lights.count = 0;
    for (const bool orthographic : {false, true}) {
        setup.camera.orthographic = orthographic;
        setup.camera.nearMetres = 0.4;
        FrameInput input = makeQuickFrame(setup);
        const reference::Vec3 eye = setup.camera.eye, forward = normalize(setup.camera.target - eye);
        reference::Random random(14);
        for (const double ahead : {-3.0, -0.2, 0.0, 0.2, 0.4, 0.6, 2.0}) {
            for (const double range : {0.05, 0.3, 1.0, 5.0, 500.0}) {
                for (const float angle : {0.0f, 0.002f, 0.05f, 0.8f, 1.4f, 1.57079637f}) {  // 0: a point light
                    Light light;
                    const reference::Vec3 at = eye + forward * ahead;
                    const reference::Vec3 way = random.chance(0.6) ? forward : random.unitVector();
                    const double p[3] = {at.x, at.y, at.z}, d[3] = {way.x, way.y, way.z};
                    for (int i = 0; i < 3; ++i) {
                        light.position[i] = static_cast<float>(p[i]);
                        light.direction[i] = static_cast<float>(d[i]);
                    }
                    light.type = angle == 0.0f ? LightType::Point : LightType::Spot;
                    if (angle != 0.0f) light.outerConeAngle = angle;
                    light.rangeMetres = static_cast<float>(range);
                    light.casts = random.chance(0.5);
                    input.lights.push_back(light);
                }
            }
        }
        input.lightViews = sharedViews(input.lights);
        useFilter(input, Filter::Hard);
        ViewDesc desc = viewDescFor(input);
        desc.listEntries = 54 * 240;
        desc.visibilitySlots = 54 * 120;
        Rig rig(device(), {}, desc);
        ASSERT_TRUE(rig.ok());
        const Checked checked = checkFrame(input, rig.run(input));
        EXPECT_GT(checked.early.must, 500u);
    }
}

}  // namespace
}  // namespace gnomon::test
