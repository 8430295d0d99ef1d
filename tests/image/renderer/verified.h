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
Verified verified(const Device& device, const View3d& view, const RendererDesc& desc);

}  // namespace gnomon::renderer::image_test
