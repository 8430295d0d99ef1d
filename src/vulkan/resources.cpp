#include "vulkan/resources.h"

namespace gnomon {
namespace {

// The first memory type that has all of `wanted`, or kNoType.
constexpr std::uint32_t kNoType = 0xFFFFFFFFu;
std::uint32_t findType(const VkPhysicalDeviceMemoryProperties& memory, std::uint32_t allowed,
                       VkMemoryPropertyFlags wanted) noexcept {
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
        if ((allowed >> i & 1u) != 0 && (memory.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    }
    return kNoType;
}

std::uint32_t chooseType(const VkPhysicalDeviceMemoryProperties& memory, std::uint32_t allowed,
                         MemoryUse use) noexcept {
    constexpr VkMemoryPropertyFlags kMapped =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    std::uint32_t type = kNoType;
    switch (use) {
        case MemoryUse::Device:
            type = findType(memory, allowed, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
            break;
        case MemoryUse::Streamed:
            type = findType(memory, allowed, kMapped | VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
            if (type == kNoType) type = findType(memory, allowed, kMapped);
            return type;
        case MemoryUse::Readback:
            type = findType(memory, allowed, kMapped | VK_MEMORY_PROPERTY_HOST_CACHED_BIT);
            if (type == kNoType) type = findType(memory, allowed, kMapped);
            return type;
    }
    return type == kNoType ? findType(memory, allowed, 0) : type;
}

Result allocate(const DeviceContext& context, const VkMemoryRequirements& needs, MemoryUse use,
                VkDeviceMemory& out) noexcept {
    VkMemoryAllocateInfo info = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    info.allocationSize = needs.size;
    info.memoryTypeIndex = chooseType(context.memory, needs.memoryTypeBits, use);
    if (info.memoryTypeIndex == kNoType) {
        return Result::failure(Status::UnsupportedDevice, "The device has no memory type that suits a buffer.");
    }
    const VkResult result = context.vk.AllocateMemory(context.device, &info, nullptr, &out);
    return result == VK_SUCCESS ? Result() : vulkanFailure(result, "vkAllocateMemory");
}

void setName(const DeviceContext& context, VkObjectType type, std::uint64_t handle, const char* name) noexcept {
    if (!context.debugLabels) return;
    VkDebugUtilsObjectNameInfoEXT info = {VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
    info.objectType = type;
    info.objectHandle = handle;
    info.pObjectName = name;
    (void)context.vk.SetDebugUtilsObjectNameEXT(context.device, &info);
}

}  // namespace

Result vulkanFailure(VkResult result, const char* call) noexcept {
    switch (result) {
        case VK_ERROR_OUT_OF_HOST_MEMORY:
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
            return Result::failure(Status::OutOfMemory, "%s ran out of memory.", call);
        default:
            return Result::failure(Status::VulkanError, "%s failed with VkResult %d.", call, static_cast<int>(result));
    }
}

Result createBuffer(const DeviceContext& context, const char* name, VkDeviceSize bytes, VkBufferUsageFlags usage,
                    MemoryUse use, DeviceBuffer& out) noexcept {
    VkBufferCreateInfo info = {VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = bytes;
    info.usage = usage;
    if (context.queueFamilyCount > 1) {
        info.sharingMode = VK_SHARING_MODE_CONCURRENT;
        info.queueFamilyIndexCount = context.queueFamilyCount;
        info.pQueueFamilyIndices = context.queueFamilies;
    }
    VkResult result = context.vk.CreateBuffer(context.device, &info, nullptr, &out.buffer);
    if (result != VK_SUCCESS) return vulkanFailure(result, "vkCreateBuffer");
    VkMemoryRequirements needs = {};
    context.vk.GetBufferMemoryRequirements(context.device, out.buffer, &needs);
    if (Result allocated = allocate(context, needs, use, out.memory); !allocated) return allocated;
    result = context.vk.BindBufferMemory(context.device, out.buffer, out.memory, 0);
    if (result != VK_SUCCESS) return vulkanFailure(result, "vkBindBufferMemory");
    if (use != MemoryUse::Device) {
        result = context.vk.MapMemory(context.device, out.memory, 0, VK_WHOLE_SIZE, 0, &out.mapped);
        if (result != VK_SUCCESS) return vulkanFailure(result, "vkMapMemory");
    }
    out.bytes = bytes;
    setName(context, VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(out.buffer), name);
    return {};
}

void destroyBuffer(const DeviceContext& context, DeviceBuffer& buffer) noexcept {
    context.vk.DestroyBuffer(context.device, buffer.buffer, nullptr);
    context.vk.FreeMemory(context.device, buffer.memory, nullptr);
    buffer = {};
}

Result createPlaceholder(const DeviceContext& context, VkFormat format, VkImageAspectFlags aspect,
                         VkImageViewType viewType, DeviceImage& out) noexcept {
    VkImageCreateInfo info = {VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {1, 1, 1};
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    if (context.queueFamilyCount > 1) {
        info.sharingMode = VK_SHARING_MODE_CONCURRENT;
        info.queueFamilyIndexCount = context.queueFamilyCount;
        info.pQueueFamilyIndices = context.queueFamilies;
    }
    VkResult result = context.vk.CreateImage(context.device, &info, nullptr, &out.image);
    if (result != VK_SUCCESS) return vulkanFailure(result, "vkCreateImage");
    VkMemoryRequirements needs = {};
    context.vk.GetImageMemoryRequirements(context.device, out.image, &needs);
    if (Result allocated = allocate(context, needs, MemoryUse::Device, out.memory); !allocated) return allocated;
    result = context.vk.BindImageMemory(context.device, out.image, out.memory, 0);
    if (result != VK_SUCCESS) return vulkanFailure(result, "vkBindImageMemory");
    VkImageViewCreateInfo view = {VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = out.image;
    view.viewType = viewType;
    view.format = format;
    view.subresourceRange = {aspect, 0, 1, 0, 1};
    result = context.vk.CreateImageView(context.device, &view, nullptr, &out.view);
    return result == VK_SUCCESS ? Result() : vulkanFailure(result, "vkCreateImageView");
}

void destroyImage(const DeviceContext& context, DeviceImage& image) noexcept {
    context.vk.DestroyImageView(context.device, image.view, nullptr);
    context.vk.DestroyImage(context.device, image.image, nullptr);
    context.vk.FreeMemory(context.device, image.memory, nullptr);
    image = {};
}

}  // namespace gnomon
