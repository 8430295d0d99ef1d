#pragma once
// Buffers and small images with a memory allocation each; freed by their owner through destroy().

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <span>

#include "gnomon/result.h"
#include "vulkan/functions.h"

namespace gnomon {

struct DeviceContext {
    Functions vk;
    VkDevice device = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkPhysicalDeviceMemoryProperties memory = {};
    VkPhysicalDeviceLimits limits = {};
    std::uint32_t queueFamilies[8] = {};
    std::uint32_t queueFamilyCount = 0;
    bool debugLabels = false;
};

enum class MemoryUse {
    Device,    // device-local
    Streamed,  // written by the host once a frame, read by the device; device-local too where possible
    Readback,  // written by the device, read by the host
};

struct DeviceBuffer {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize bytes = 0;
    void* mapped = nullptr;
};

Result createBuffer(const DeviceContext& context, const char* name, VkDeviceSize bytes, VkBufferUsageFlags usage,
                    MemoryUse use, DeviceBuffer& out) noexcept;
void destroyBuffer(const DeviceContext& context, DeviceBuffer& buffer) noexcept;

struct DeviceImage {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
};

// A 1x1 sampled image that stands in a descriptor for something the host does not have; never read.
Result createPlaceholder(const DeviceContext& context, VkFormat format, VkImageAspectFlags aspect,
                         VkImageViewType viewType, DeviceImage& out) noexcept;
void destroyImage(const DeviceContext& context, DeviceImage& image) noexcept;

// A sentence for a failing call.
Result vulkanFailure(VkResult result, const char* call) noexcept;

}  // namespace gnomon
