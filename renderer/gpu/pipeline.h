#pragma once
// Descriptor set layouts, pipeline layouts, graphics and compute pipelines as owning handles.

#include <cstdint>
#include <initializer_list>
#include <span>
#include <utility>
#include <vector>

#include "renderer/gpu/device.h"

namespace gnomon::renderer {

/// Owns one Vulkan handle of a device. Movable.
template <typename Handle, void (*Destroy)(VkDevice, Handle)>
class Owned {
public:
    Owned() = default;
    Owned(VkDevice device, Handle handle) : device_(device), handle_(handle) {}
    Owned(Owned&& other) noexcept : device_(other.device_), handle_(std::exchange(other.handle_, Handle{})) {}
    Owned& operator=(Owned&& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~Owned() {
        if (handle_ != Handle{}) Destroy(device_, handle_);
    }
    [[nodiscard]] Handle get() const { return handle_; }
    operator Handle() const { return handle_; }  // NOLINT: meant to be used where the handle is

private:
    VkDevice device_ = VK_NULL_HANDLE;
    Handle handle_ = Handle{};
};

namespace detail {
inline void destroySetLayout(VkDevice d, VkDescriptorSetLayout h) {
    vkDestroyDescriptorSetLayout(d, h, nullptr);
}
inline void destroyPipelineLayout(VkDevice d, VkPipelineLayout h) {
    vkDestroyPipelineLayout(d, h, nullptr);
}
inline void destroyPipeline(VkDevice d, VkPipeline h) {
    vkDestroyPipeline(d, h, nullptr);
}
inline void destroyDescriptorPool(VkDevice d, VkDescriptorPool h) {
    vkDestroyDescriptorPool(d, h, nullptr);
}
}  // namespace detail
using SetLayout = Owned<VkDescriptorSetLayout, detail::destroySetLayout>;
using PipelineLayout = Owned<VkPipelineLayout, detail::destroyPipelineLayout>;
using Pipeline = Owned<VkPipeline, detail::destroyPipeline>;
using DescriptorPool = Owned<VkDescriptorPool, detail::destroyDescriptorPool>;

/// Bindings 0, 1, 2 ... with one descriptor each.
SetLayout makeSetLayout(const Device& device, std::span<const VkDescriptorType> types, VkShaderStageFlags stages);
PipelineLayout makePipelineLayout(const Device& device, std::span<const VkDescriptorSetLayout> sets,
                                  VkShaderStageFlags pushStages = 0, std::uint32_t pushBytes = 0);
/// Room for `sets` sets, each with the given descriptors.
DescriptorPool makeDescriptorPool(const Device& device, std::uint32_t sets,
                                  std::span<const VkDescriptorType> typesPerSet);
VkDescriptorSet allocateSet(const Device& device, VkDescriptorPool pool, VkDescriptorSetLayout layout);
void writeBuffer(const Device& device, VkDescriptorSet set, std::uint32_t binding, VkDescriptorType type,
                 VkBuffer buffer, VkDeviceSize offset = 0, VkDeviceSize bytes = VK_WHOLE_SIZE);
void writeImage(const Device& device, VkDescriptorSet set, std::uint32_t binding, VkDescriptorType type,
                VkImageView view, VkSampler sampler, VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);

struct GraphicsPipelineDesc {
    std::span<const std::uint32_t> vertexSpirv, fragmentSpirv;  ///< no fragment shader: depth only
    VkPipelineLayout layout = VK_NULL_HANDLE;
    std::vector<VkFormat> colourFormats;
    VkFormat depthFormat = VK_FORMAT_UNDEFINED;
    bool depthWrite = true;
    VkCompareOp depthCompare = VK_COMPARE_OP_GREATER;  ///< set by vkCmdSetDepthCompareOp instead if dynamicDepthCompare
    bool dynamicDepthCompare = false;
    VkCullModeFlags cull = VK_CULL_MODE_NONE;  ///< set by vkCmdSetCullMode and vkCmdSetFrontFace instead if dynamicCull
    bool dynamicCull = false;
    bool dynamicDepthBias = false;  ///< set by vkCmdSetDepthBiasEnable and vkCmdSetDepthBias; else none
};

/// Triangle lists without vertex attributes (the vertex shader pulls), dynamic viewport and scissor, no blending.
Pipeline makeGraphicsPipeline(const Device& device, const GraphicsPipelineDesc& desc);

/// `specialization`: values of constants 0, 1, 2 ... Subgroups are full; a required size of 0 leaves it to the device.
Pipeline makeComputePipeline(const Device& device, std::span<const std::uint32_t> spirv, VkPipelineLayout layout,
                             std::span<const std::uint32_t> specialization = {},
                             std::uint32_t requiredSubgroupSize = 0);

}  // namespace gnomon::renderer
