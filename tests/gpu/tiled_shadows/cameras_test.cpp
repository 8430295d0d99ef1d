// Every kind of camera, extent and viewport.
#include <gtest/gtest.h>

#include <set>

#include "checks.h"
#include "scenes.h"

namespace gnomon::test {
namespace {

class CamerasTest : public GpuTest {};
GNOMON_ON_EVERY_DEVICE(CamerasTest);

TEST_P(CamerasTest, EveryKind) {
    for (reference::CameraSetup camera : reference::allCameraKinds()) {
        SCOPED_TRACE(camera.name);
        RoomSetup setup{.seed = 20, .widthPx = 88, .heightPx = 72};
        camera.eye = {1, 2.5, -6.5};  // some sky, for the background's depth
        camera.target = {0, 1.8, 0};
        setup.camera = camera;
        const FrameInput input = makeRoomFrame(setup);
        Rig rig(device(), {}, viewDescFor(input));
        ASSERT_TRUE(rig.ok());
        const Checked checked = checkFrame(input, rig.run(input));
        EXPECT_GT(checked.early.must, 50u);
        EXPECT_LT(checked.early.mayShare(), 0.02);
        EXPECT_LT(checked.shadows.ambiguousShare(), camera.reversed ? 0.03 : 0.1);  // standard depth is coarse far away
    }
}

constexpr std::pair<std::uint32_t, std::uint32_t> kExtents[] = {
    {1, 1}, {7, 5}, {8, 8}, {9, 9}, {1, 70}, {130, 3}, {63, 65}, {64, 64}, {65, 63}, {33, 31}, {97, 40}};

TEST_P(CamerasTest, Extents) {
    for (const auto& [width, height] : kExtents) {
        SCOPED_TRACE(std::to_string(width) + "x" + std::to_string(height));
        const FrameInput input =
            makeRoomFrame({.seed = 21, .widthPx = width, .heightPx = height, .shadows = {.viewSizePx = 16}});
        Rig rig(device(), {}, viewDescFor(input));
        ASSERT_TRUE(rig.ok());
        checkFrame(input, rig.run(input));
    }
}

// One view, extents and offsets that change from frame to frame, with what older frames left still in the buffers.
TEST_P(CamerasTest, DynamicResolutionAndViewportOffset) {
    RoomSetup setup{.seed = 22, .shadows = {.viewSizePx = 16}};
    FrameInput input = makeRoomFrame(setup);
    ViewDesc desc = viewDescFor(input);
    desc.maxWidthPx = 130;
    desc.maxHeightPx = 70;
    desc.listEntries = 17 * 9 * 90;
    desc.visibilitySlots = 17 * 9 * 40;
    for (const ListReservation reservation : {ListReservation::Approximate, ListReservation::Accurate}) {
        input.settings.listReservation = reservation;
        Rig rig(device(), {}, desc);
        ASSERT_TRUE(rig.ok());
        std::uint32_t frame = 0;
        for (const auto& [width, height] : kExtents) {
            SCOPED_TRACE(std::to_string(width) + "x" + std::to_string(height));
            setup.widthPx = width;
            setup.heightPx = height;
            renderRoom(input, setup);
            input.viewportXPx = (frame * 7) % 25;
            input.viewportYPx = (frame * 5) % 17;
            const bool fill = frame++ % 2 == 0;
            const FrameResult result = rig.run(input, {.fill = fill});
            EXPECT_EQ(rig.view().tileCounts().width, gpu::divideRoundingUp(width, 8));
            if (fill) {
                checkFrame(input, result);
            } else {
                const FrameResult again = rig.run(input);
                checkFrame(input, again);
                EXPECT_EQ(decodeFinalLists(result), decodeFinalLists(again));
                EXPECT_EQ(result.brokenGuards, 0u);
            }
        }
    }
}

TEST_P(CamerasTest, LargerExtent) {
    RoomSetup setup{.seed = 23, .widthPx = 480, .heightPx = 270};
    setup.lights.count = fullRun() ? 200 : 60;
    const FrameInput input = makeRoomFrame(setup);
    Rig rig(device(), {}, viewDescFor(input));
    ASSERT_TRUE(rig.ok());
    const Checked checked = checkFrame(input, rig.run(input), {.bytes = fullRun()});
    EXPECT_GT(checked.early.must, 5000u);
}

/// Background but for single pixels in the corners and around powers of two; two lights that reach everything.
void checkAddressing(TestDevice& device, std::uint32_t width, std::uint32_t height) {
    SCOPED_TRACE(std::to_string(width) + "x" + std::to_string(height));
    FrameInput input;
    input.widthPx = width;
    input.heightPx = height;
    reference::CameraSetup camera;
    camera.eye = {0, 0, 0};
    camera.target = {0, 0, -1};
    input.camera = reference::makeCamera(camera, width, height);
    input.shadows = sharedPlainShadows();
    input.receivers.depth.assign(std::size_t(width) * height, 0.0f);
    std::set<std::pair<std::uint32_t, std::uint32_t>> pixels;
    for (const std::uint32_t x : {0u, 4096u, width - 1})
        for (const std::uint32_t y : {0u, 2048u, height - 1})
            if (x < width && y < height) pixels.emplace(x, y);
    for (const auto& [x, y] : pixels) input.receivers.depth[std::size_t(y) * width + x] = 0.05f / 3;  // 3 m away
    input.lights.resize(2);
    input.lights[0].rangeMetres = input.lights[1].rangeMetres = 1e4f;
    useFilter(input, Filter::Pcf);
    input.lightViews = {{}, {0, gpu::kPointLightFaces}};
    ViewDesc desc = viewDescFor(input);
    desc.listEntries = 300;
    desc.visibilitySlots = 100;
    desc.framesInFlight = 1;
    Rig rig(device, {}, desc);
    ASSERT_TRUE(rig.ok());
    const FrameResult result = rig.run(input);
    checkCanaries(result, true);
    checkCounters(result, {});
    EXPECT_EQ(result.statistics.tilesWithGeometry, pixels.size());
    for (const auto& [x, y] : pixels) {
        const std::size_t tile = std::size_t(y / 8) * result.tilesX() + x / 8;
        EXPECT_NEAR(result.depthRanges[2 * tile], 3.0f, 1e-5f);
        EXPECT_EQ(reference::earlyLights(result.lists(), tile).size(), 2u) << x << ", " << y;
    }
}

// At 8K a software device needs a minute for nothing but empty work groups: strips there, unless a full run is asked
// for.
TEST_P(CamerasTest, AddressingAt8K) {
    checkAddressing(device(), 7680, 24);
    checkAddressing(device(), 24, 4320);
    const bool software = device().vulkan().info().properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    if (!software || fullRun()) checkAddressing(device(), 7680, 4320);
}

}  // namespace
}  // namespace gnomon::test
