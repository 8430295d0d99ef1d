#pragma once
// The host's lighting: two pipelines that read what the library left, and the picture that they make.

#include <gnomon/context.h>
#include <gnomon/view.h>

#include "vulkan_setup.h"

namespace host {

class Lighting {
public:
    /// The pipelines are made for these settings. A host that changes settings from frame to frame keeps a pair of
    /// pipelines for each SpecializationValues that it meets: they have an operator==.
    Lighting(Device& device, const gnomon::Context& context, const gnomon::ShadowSettings& settings,
             std::uint32_t widthPx, std::uint32_t heightPx);

    void record(VkCommandBuffer commands, const gnomon::View& view, gnomon::Timeline& timeline);
    /// Copies the picture into a buffer that the host can read when the commands have finished: rows of rgba, 8 bits.
    void recordReadback(VkCommandBuffer commands);
    [[nodiscard]] const std::uint8_t* pixels() const { return static_cast<const std::uint8_t*>(readback_.mapped); }

private:
    void makeOwnSet();

    Device& device_;
    VkExtent2D extent_;
    Image picture_;
    Buffer intensities_, readback_;
    VkDescriptorSetLayout ownSetLayout_ = VK_NULL_HANDLE;
    VkDescriptorSet ownSet_ = VK_NULL_HANDLE;
    VkPipelineLayout allTilesLayout_ = VK_NULL_HANDLE, evaluateLayout_ = VK_NULL_HANDLE;
    VkPipeline allTiles_ = VK_NULL_HANDLE, evaluate_ = VK_NULL_HANDLE;
};

}  // namespace host
