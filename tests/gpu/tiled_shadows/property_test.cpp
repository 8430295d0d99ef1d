// Seeded random views: no light that reaches a pixel is ever missing from its tile's early list, no accurate count
// exceeds the approximate one, and the broken-invariant counter stays 0. GNOMON_FULL=1 runs many more.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "checks.h"
#include "scenes.h"

namespace gnomon::test {
namespace {

class PropertyTest : public GpuTest {};
GNOMON_ON_EVERY_DEVICE(PropertyTest);

constexpr std::uint32_t kWidth = 40, kHeight = 24;

// Unless GNOMON_FULL=1: so many views at least, and more while there is time.
constexpr std::uint64_t kLeastSeeds = 8;
constexpr std::chrono::seconds kLongEnough{8};

void move(float position[3], reference::Vec3 by) {
    position[0] += static_cast<float>(by.x);
    position[1] += static_cast<float>(by.y);
    position[2] += static_cast<float>(by.z);
}

/// A room of its own, far from the origin at times, with cones from hair-thin to half-spaces and ranges of centimetres
/// to kilometres.
FrameInput randomFrame(std::uint64_t seed) {
    reference::Random random(seed);
    RoomSetup setup;
    FrameInput input;
    setup.seed = seed;
    setup.camera = reference::randomCamera(random);
    setup.widthPx = 1 + random.below(kWidth);
    setup.heightPx = 1 + random.below(kHeight);
    const double far = random.chance(0.3) ? random.uniform(100, 8000) : 0.0;
    const reference::Vec3 offset = {far, far * 0.1, -far};
    reference::Shapes shapes = reference::makeRoom(random, 3 + random.below(10));
    reference::LightSetup lights;
    lights.count = 5 + random.below(55);
    lights.directionalShare = 0;
    if (far > 0) lights.fadingShare = 0;  // the eye is known to a millimetre there, which a short fade would magnify
    lights.spotShare = random.uniform();
    lights.maxRangeMetres = random.chance(0.3) ? 40 : 5;
    lights.spreadMetres = random.uniform(1, 20);
    input.lights = reference::makeLights(random, setup.camera, lights);
    for (Light& light : input.lights) {
        if (light.type == LightType::Spot && random.chance(0.5))
            light.outerConeAngle = static_cast<float>(std::exp(random.uniform(std::log(5e-4), std::log(1.5707963))));
        if (light.type == LightType::Spot && random.chance(0.1)) light.outerConeAngle = 1.57079637f;
        if (random.chance(0.1)) light.rangeMetres = static_cast<float>(std::exp(random.uniform(-3, 8)));
        move(light.position, offset);
    }
    setup.camera.eye = setup.camera.eye + offset;
    setup.camera.target = setup.camera.target + offset;
    for (reference::Shape& shape : shapes) {
        shape.a = shape.a + offset;
        if (shape.kind == reference::Shape::Kind::Box) shape.b = shape.b + offset;
    }
    input.widthPx = setup.widthPx;
    input.heightPx = setup.heightPx;
    input.camera = reference::makeCamera(setup.camera, setup.widthPx, setup.heightPx);
    input.receivers = reference::renderReceivers(shapes, input.camera, setup.widthPx, setup.heightPx);
    input.shadows = sharedPlainShadows();
    input.lightViews = sharedViews(input.lights);
    Light sun;
    sun.type = LightType::Directional;
    for (std::uint32_t i = random.below(3); i > 0; --i) input.lights.push_back(sun);
    input.viewportXPx = random.below(24);
    input.settings.dropLightsFacedAway = random.chance(0.5);
    return input;
}

TEST_P(PropertyTest, NoLightIsEverLost) {
    ViewDesc desc;
    desc.maxWidthPx = kWidth;
    desc.maxHeightPx = kHeight;
    desc.listEntries = 15 * 66;
    desc.visibilitySlots = 15 * 64;
    desc.maxShadowViews = 6;
    const std::uint64_t seeds = fullRun() ? 10000 : 300;
    std::uint64_t done = 0;
    std::size_t must = 0, may = 0, bytes = 0;
    const auto start = std::chrono::steady_clock::now();
    Rig approximate(device(), {}, desc), accurate(device(), {}, desc);
    ASSERT_TRUE(approximate.ok() && accurate.ok());
    for (std::uint64_t seed = 1; seed <= seeds && !HasFailure(); ++seed, ++done) {
        // Lavapipe compiles two shaders anew for most cameras, half a second each time unless Mesa's cache on disk
        // has them.
        if (!fullRun() && done >= kLeastSeeds && std::chrono::steady_clock::now() - start > kLongEnough) break;
        SCOPED_TRACE("seed " + std::to_string(seed));
        FrameInput input = randomFrame(seed);
        constexpr Filter kFilters[] = {Filter::PcssShared, Filter::Hard, Filter::Pcss};
        useFilter(input, kFilters[seed % 3]);
        input.settings.lightLists = seed % 5 < 3 ? LightLists::Froxel : LightLists::Pixel;
        input.settings.pcssPresets[0] = kPcssLow;
        input.settings.listReservation = seed % 2 == 0 ? ListReservation::Approximate : ListReservation::Accurate;
        Rig& rig = seed % 2 == 0 ? approximate : accurate;
        const FrameResult result = rig.run(input);
        const Checked checked = checkFrame(input, result, {.bytes = seed % 4 < 2});
        must += checked.early.must;
        may += checked.early.may;
        bytes += checked.shadows.bytes;
    }
    EXPECT_GT(must, done * 20);
    EXPECT_LT(double(may), 0.05 * double(must));
    std::printf("  %llu seeds: must %zu, may %zu, bytes %zu\n", static_cast<unsigned long long>(done), must, may,
                bytes);
}

// Pools of random, too small sizes under random views: lists stay sound.
TEST_P(PropertyTest, RandomOverflow) {
    const std::uint64_t seeds = fullRun() ? 200 : 2;
    for (std::uint64_t seed = 1; seed <= seeds && !HasFailure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        reference::Random random(seed + 5000);
        ViewDesc desc;
        desc.maxWidthPx = kWidth;
        desc.maxHeightPx = kHeight;
        desc.listEntries = 1 + random.below(150);
        desc.visibilitySlots = 1 + random.below(40);
        desc.maxShadowViews = 6;
        const auto reservation = static_cast<ListReservation>(random.below(3));
        const std::uint32_t bits = random.chance(0.5) ? 4 : 8;
        const Filter filter = seed % 2 != 0 ? Filter::PcssShared : Filter::Pcf;
        const LightLists lists = random.chance(0.5) ? LightLists::Froxel : LightLists::Pixel;
        desc.visibilityBits = bits;
        Rig rig(device(), {}, desc);
        ASSERT_TRUE(rig.ok());
        for (std::uint64_t i = 0; i < 3; ++i) {
            FrameInput input = randomFrame(seed * 100 + i);
            useFilter(input, filter);
            input.settings.lightLists = lists;
            input.settings.visibilityBits = bits;
            input.settings.listReservation = reservation;
            input.settings.fixedListEntriesPerTile = 10;
            checkFrame(input, rig.run(input), {.bytes = false, .listOverflow = true, .slotOverflow = true});
        }
    }
}

}  // namespace
}  // namespace gnomon::test
