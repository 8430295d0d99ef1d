#pragma once
// What holds as long as a Renderer lives.

#include <cstdint>

#include "renderer/frame/frame_settings.h"

namespace gnomon::renderer {

/// What a Renderer is made with. All but `frame` holds as long as it lives.
struct RendererDesc {
    FrameSettings frame;                                         ///< of the first frames
    std::uint32_t subgroupSize = 0;                              ///< 0: the device's own
    std::uint32_t listEntries = 0, visibilitySlots = 0;          ///< pools; 0: the library's defaults
    std::uint32_t mostListEntries = 0, mostVisibilitySlots = 0;  ///< to which pools may grow by themselves; 0: not
    /// Pixels across. 0: 4096 for frames up to 1920x1080, above 8192; at most what the device has.
    std::uint32_t atlasSizePx = 0;
    /// How many ways of drawing shadowmaps (FrameSettings::drawing) keep an atlas and a View of their own. A further
    /// way takes those that were unused for longest. More than one is for measurements that go to and fro.
    std::uint32_t keptDrawings = 1;
    /// The picture holds 32-bit floats. Off: halves, which end at 65504, in half the memory. Brighter light is cut.
    bool floatPicture = false;
};

}  // namespace gnomon::renderer
