#pragma once
// All that may change from one frame of a Renderer to the next, as one value.

#include <cstdint>
#include <optional>
#include <vector>

#include "gnomon/scene.h"
#include "gnomon/settings.h"
#include "renderer/lighting/lighting_pipelines.h"
#include "renderer/shadow_atlas/drawing.h"

namespace gnomon::renderer {

/// The paper's 2 mm.
inline constexpr float kBiasMetres = 0.002f;

enum class ShadowMode : std::uint8_t { Deferred, Inline, Off };

struct FrameSettings {
    std::uint32_t widthPx = 1280, heightPx = 720;
    /// The library's own. Its `filters` and `subsurfaceBiasMetres` follow from what stands below.
    ShadowSettings shadows = {.shadowBounds = true};
    /// Filters of the scene's lights that name none: they take turns, light i has filters[i % size].
    std::vector<Filter> filters = {Filter::Pcss};
    /// Depth bias of lights that state none, taken as it is. Empty: kBiasMetres, limited by what each shadow view sees.
    std::optional<float> biasMetres;
    float subsurfaceBiasMetres = 0.02f;  ///< with drawing.subsurfaceFronts
    ShadowDrawing drawing;
    bool readFaceNormals = true;  ///< off: they are derived from the depth buffer
    DeviceDepth deviceDepth = DeviceDepth::ReversedZ;
    InlineVariant inlineVariant;
    /// Shadow resolutions and places in the atlas may stay what they were in earlier frames where that is nearly right.
    /// Steadier and faster in motion. Off: a frame follows from scene, time and settings alone.
    bool history = false;
    /// Texels by which each of a light's six shadow views reaches farther, on every side, than PCF needs: at most an
    /// eighth of its size. Taps of soft shadows then look at the next view less often. The views' rectangles keep their
    /// size, so their texels get larger.
    std::uint32_t faceGuardTexels = 0;

    bool operator==(const FrameSettings&) const = default;
};

}  // namespace gnomon::renderer
