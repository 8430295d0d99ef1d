#pragma once
// The Vulkan functions the library calls, loaded through the host's vkGetInstanceProcAddr into a table per context: no
// global state, no link to a loader.

#include <vulkan/vulkan_core.h>

#include "gnomon/result.h"

namespace gnomon {

#define GNOMON_INSTANCE_FUNCTIONS(X)          \
    X(GetPhysicalDeviceProperties2)           \
    X(GetPhysicalDeviceMemoryProperties)      \
    X(GetPhysicalDeviceQueueFamilyProperties) \
    X(GetDeviceProcAddr)

#define GNOMON_DEVICE_FUNCTIONS(X) \
    X(AllocateDescriptorSets)      \
    X(AllocateMemory)              \
    X(BindBufferMemory)            \
    X(BindImageMemory)             \
    X(CmdBindDescriptorSets)       \
    X(CmdBindPipeline)             \
    X(CmdCopyBuffer)               \
    X(CmdDispatch)                 \
    X(CmdDispatchIndirect)         \
    X(CmdFillBuffer)               \
    X(CmdPipelineBarrier2)         \
    X(CmdResetQueryPool)           \
    X(CmdUpdateBuffer)             \
    X(CmdWriteTimestamp2)          \
    X(CreateBuffer)                \
    X(CreateComputePipelines)      \
    X(CreateDescriptorPool)        \
    X(CreateDescriptorSetLayout)   \
    X(CreateImage)                 \
    X(CreateImageView)             \
    X(CreatePipelineLayout)        \
    X(CreateQueryPool)             \
    X(CreateSampler)               \
    X(CreateShaderModule)          \
    X(DestroyBuffer)               \
    X(DestroyDescriptorPool)       \
    X(DestroyDescriptorSetLayout)  \
    X(DestroyImage)                \
    X(DestroyImageView)            \
    X(DestroyPipeline)             \
    X(DestroyPipelineLayout)       \
    X(DestroyQueryPool)            \
    X(DestroySampler)              \
    X(DestroyShaderModule)         \
    X(FreeMemory)                  \
    X(GetBufferMemoryRequirements) \
    X(GetImageMemoryRequirements)  \
    X(GetQueryPoolResults)         \
    X(MapMemory)                   \
    X(UpdateDescriptorSets)

// Present only where the host enabled VK_EXT_debug_utils.
#define GNOMON_DEBUG_FUNCTIONS(X) \
    X(CmdBeginDebugUtilsLabelEXT) \
    X(CmdEndDebugUtilsLabelEXT)   \
    X(SetDebugUtilsObjectNameEXT)

struct Functions {
#define GNOMON_DECLARE(name) PFN_vk##name name = nullptr;
    GNOMON_INSTANCE_FUNCTIONS(GNOMON_DECLARE)
    GNOMON_DEVICE_FUNCTIONS(GNOMON_DECLARE)
    GNOMON_DEBUG_FUNCTIONS(GNOMON_DECLARE)
#undef GNOMON_DECLARE
};

Result loadFunctions(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance, VkDevice device,
                     bool debugLabels, Functions& out) noexcept;

}  // namespace gnomon
