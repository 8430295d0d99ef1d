#pragma once
// What `gnomon verify` does, for tests: a frame's visibility, light by light, against ray-traced truth.

#include "image/renderer/harness.h"
#include "truth/figures.h"

namespace gnomon::renderer::image_test {

struct Verified {
    Figures figures, subsurface;
    std::vector<float> visibility;  // of the last light
    LightTruth truth;
    HdrPicture picture;
};
/// One deferred frame, and the figures of all lights. Soft truth is judged where the first filter is PCSS.
/// `drawn`: what the renderer has in place of the scene that the truth traces.
Verified verified(const Device& device, const View3d& view, const RendererDesc& desc, const Scene* drawn = nullptr);

/// Its depths are rough where scenes are large.
bool isSwiftShader(const Device& device);

/// smallDesc() with hard shadows.
RendererDesc hardDesc(std::uint32_t widthPx = 160, std::uint32_t heightPx = 90);
/// Figures of verified(), printed.
Figures figuresIn(const Device& device, const View3d& view, const RendererDesc& desc);

}  // namespace gnomon::renderer::image_test
