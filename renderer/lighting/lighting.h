#pragma once
// The lighting passes: deferred (with its second pipeline) and inline.

#include <span>
#include <vector>

#include "gnomon/tiled_shadows.h"
#include "renderer/gbuffer/gbuffer.h"
#include "renderer/gpu/resources.h"
#include "renderer/gpu/timer.h"
#include "renderer/lighting/lighting_pipelines.h"
#include "scene/scene.h"

namespace gnomon::renderer {

enum class LightingVariant : std::uint8_t {
    Inline,      ///< shadows evaluated in the lighting shader
    Unshadowed,  ///< every light lit
};

/// Writes a linear R16G16B16A16_SFLOAT picture of the G-buffer's extent. Not thread safe.
class Lighting {
public:
    /// Uploads the scene's light data.
    Lighting(const Device& device, const Context& context, const Scene& scene, const GBuffer& gbuffer,
             const InlineVariant& inlineVariant);

    /// After View::recordGenerateShadows(): one dispatch over all tiles, and an indirect one for tiles to be evaluated.
    void recordDeferred(VkCommandBuffer commands, const View& view, GpuTimer* timer);
    /// After View::recordFindLightsAccurate().
    void recordInline(VkCommandBuffer commands, const View& view, LightingVariant variant, GpuTimer* timer);

    /// In GENERAL between frames.
    [[nodiscard]] const GpuImage& picture() const { return picture_; }
    [[nodiscard]] std::vector<MemoryRow> memoryRows() const;

private:
    void createSet(const GBuffer& gbuffer);
    void beginPicture(VkCommandBuffer commands);
    void bind(VkCommandBuffer commands, const View& view, VkPipeline pipeline, VkPipelineLayout layout,
              bool shadowmaps);

    const Device& device_;
    LightingPipelines pipelines_;
    GpuImage picture_;
    Buffer hostLights_, sceneConstants_;
    DescriptorPool pool_;
    VkDescriptorSet ownSet_ = VK_NULL_HANDLE;
    bool pictureReady_ = false;
};

}  // namespace gnomon::renderer
