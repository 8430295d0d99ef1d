#pragma once
// What a Context holds.

#include <vector>

#include "gnomon/tiled_shadows.h"
#include "passes.h"
#include "vulkan/resources.h"

namespace gnomon {

inline constexpr std::uint32_t kSpecializationCount = 11;

struct Context::State {
    DeviceContext device;
    ContextDesc desc;
    std::uint32_t subgroupSize = 0;
    bool requireSubgroupSize = false;  // pipelines ask for it; else the device has no other
    std::uint32_t specialization[kSpecializationCount] = {};
    float timestampPeriodNs = 0.0f;                   // 0: no timestamps
    std::uint64_t timestampMask = ~std::uint64_t{0};  // the bits that count, in every family
    VkDescriptorSetLayout listsLayout = VK_NULL_HANDLE;
    VkDescriptorSetLayout receiversLayout = VK_NULL_HANDLE;
    VkDescriptorSetLayout shadowmapsLayout = VK_NULL_HANDLE;
    VkPipelineLayout pipelineLayout = VK_NULL_HANDLE;
    VkPipeline pipelines[kPassCount] = {};
    VkSampler shadowSampler = VK_NULL_HANDLE;

    ~State();
};

}  // namespace gnomon
