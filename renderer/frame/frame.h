#pragma once
// The recipe of a frame: what is recorded, in which order.

#include "gnomon/gnomon.h"
#include "renderer/frame/frame_settings.h"
#include "renderer/gbuffer/gbuffer.h"
#include "renderer/lighting/lighting.h"
#include "renderer/shadow_atlas/shadow_atlas.h"

namespace gnomon::renderer {

/// What a frame is made of.
struct FrameParts {
    const Device& device;
    const GpuScene& scene;
    GBuffer& gbuffer;
    ShadowAtlasImage& atlas;
    View& view;
    Lighting& lighting;
    Timeline& timeline;
};

/// What is drawn.
struct FrameInput {
    GBufferCamera camera;
    VkExtent2D extent{};
    ShadowMode mode = ShadowMode::Deferred;
    ShadowSettings shadows;  ///< as FrameDesc has them
    InlineVariant inlineVariant;
};

/// After View::beginFrame() and ShadowAtlasImage::prepare().
ShadowAtlasStatistics recordFrame(VkCommandBuffer commands, const FrameParts& parts, const FrameInput& frame);

}  // namespace gnomon::renderer
