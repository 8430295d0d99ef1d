#pragma once
// All that may change from one frame of a Renderer to the next, as one value.

#include <cstdint>
#include <vector>

#include "gnomon/scene.h"
#include "gnomon/settings.h"
#include "renderer/lighting/lighting_pipelines.h"
#include "renderer/shadow_atlas/drawing.h"

namespace gnomon::renderer {

enum class ShadowMode : std::uint8_t { Deferred, Inline, Off };

struct FrameSettings {
    std::uint32_t widthPx = 1280, heightPx = 720;
    /// The library's own. Its `filters` and `subsurfaceBiasMetres` follow from what stands below.
    ShadowSettings shadows = {.shadowBounds = true};
    /// Filters of the scene's lights that name none: they take turns, light i has filters[i % size].
    std::vector<Filter> filters = {Filter::Pcss};
    float biasMetres = 0.002f;           ///< of lights that state none
    float subsurfaceBiasMetres = 0.02f;  ///< with drawing.subsurfaceFronts
    ShadowDrawing drawing;
    bool readFaceNormals = true;  ///< off: they are derived from the depth buffer
    DeviceDepth deviceDepth = DeviceDepth::ReversedZ;
    InlineVariant inlineVariant;

    bool operator==(const FrameSettings&) const = default;
};

}  // namespace gnomon::renderer
