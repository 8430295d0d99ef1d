#pragma once
// Inputs for the tests: the oracle's room, its lights and atlases, as a host would hand them over.

#include "reference/test_scene.h"
#include "rig.h"

namespace gnomon::test {

struct RoomSetup {
    std::uint64_t seed = 1;
    std::uint32_t widthPx = 72, heightPx = 40;
    reference::CameraSetup camera{.eye = {1.5, 2.2, 5}, .target = {-0.5, 0.8, -2}};
    reference::LightSetup lights{.count = 40, .maxRangeMetres = 8, .spreadMetres = 6};
    reference::ShadowSetup shadows{.viewSizePx = 24, .mixDepthKinds = true};
    std::uint32_t objects = 12;
};

/// All lights have this filter, and the frame's pipelines the code of no other.
void useFilter(FrameInput& input, Filter filter);

/// A room with furniture, lights and real atlases. The frame's settings have the filters and presets of the lights.
[[nodiscard]] FrameInput makeRoomFrame(const RoomSetup& setup);

/// The same without atlas content worth looking at: every caster shares six small views. Quick to make.
[[nodiscard]] FrameInput makeQuickFrame(const RoomSetup& setup);
[[nodiscard]] std::shared_ptr<const reference::TestShadows> sharedPlainShadows();
/// The shared views for every point and spot that casts.
[[nodiscard]] std::vector<LightShadowViews> sharedViews(const std::vector<Light>& lights);

/// Renders the room anew for the frame's camera and extent, as after a change of either.
void renderRoom(FrameInput& input, const RoomSetup& setup);

/// Pools that hold the frame; slots are counted in the frame's bits.
[[nodiscard]] ViewDesc viewDescFor(const FrameInput& input);

}  // namespace gnomon::test
