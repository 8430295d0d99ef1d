#pragma once
// The lighting passes: deferred (with its second pipeline) and inline.

#include <span>
#include <vector>

#include "gnomon/view.h"
#include "renderer/gbuffer/gbuffer.h"
#include "renderer/gpu/resources.h"
#include "renderer/lighting/lighting_pipelines.h"
#include "scene/scene.h"

namespace gnomon::renderer {

/// Writes a linear picture of the G-buffer's extent: R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT. Not thread safe.
class Lighting {
public:
    /// Uploads the scene's light data. The pipelines must outlive this. Throws GpuError.
    Lighting(const Device& device, LightingPipelines& pipelines, const Scene& scene, const GBuffer& gbuffer,
             PictureFormat format = PictureFormat::Half);
    /// After the G-buffer was resized; the device must have finished with the old picture.
    void resize(const GBuffer& gbuffer);

    /// After View::recordGenerateShadows(): one dispatch over all tiles, and an indirect one for tiles to be evaluated.
    /// `settings`: the frame's. Throws GpuError.
    void recordDeferred(VkCommandBuffer commands, const View& view, const ShadowSettings& settings, Timeline* timeline);
    /// After View::recordFindLightsAccurate(). Inline or Unshadowed. Throws GpuError.
    void recordInline(VkCommandBuffer commands, const View& view, LightingKind kind, const ShadowSettings& settings,
                      const InlineVariant& variant, Timeline* timeline);

    /// In GENERAL between frames.
    [[nodiscard]] const GpuImage& picture() const { return picture_; }
    [[nodiscard]] PictureFormat format() const { return format_; }
    [[nodiscard]] std::vector<MemoryRow> memoryRows() const;

private:
    void writeSet(const GBuffer& gbuffer);
    void beginPicture(VkCommandBuffer commands);
    void bind(VkCommandBuffer commands, const View& view, LightingKind kind, VkPipeline pipeline);

    const Device& device_;
    LightingPipelines& pipelines_;
    PictureFormat format_;
    GpuImage picture_;
    Buffer hostLights_, sceneConstants_;
    DescriptorPool pool_;
    VkDescriptorSet ownSet_ = VK_NULL_HANDLE;
    bool pictureReady_ = false;
};

}  // namespace gnomon::renderer
