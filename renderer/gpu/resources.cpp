#include "renderer/gpu/resources.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

namespace gnomon::renderer {

Buffer::Buffer(const Device& device, const std::string& name, VkDeviceSize bytes, VkBufferUsageFlags usage,
               MemoryUse use)
    : device_(&device), bytes_(std::max<VkDeviceSize>(bytes, 16)) {
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = bytes_;
    info.usage = usage;
    check(vkCreateBuffer(device.handle(), &info, nullptr, &buffer_), "creating a buffer");
    try {
        VkMemoryRequirements requirements{};
        vkGetBufferMemoryRequirements(device.handle(), buffer_, &requirements);
        allocation_ = device.memory().allocate(requirements, use, false);
        check(vkBindBufferMemory(device.handle(), buffer_, allocation_.memory(), allocation_.offset()),
              "binding a buffer");
    } catch (...) {
        destroy();
        throw;
    }
    device.name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(buffer_), name);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    if (this != &other) {
        destroy();
        device_ = other.device_;
        buffer_ = std::exchange(other.buffer_, VK_NULL_HANDLE);
        bytes_ = std::exchange(other.bytes_, 0);
        allocation_ = std::move(other.allocation_);
    }
    return *this;
}

void Buffer::destroy() {
    if (buffer_ != VK_NULL_HANDLE) vkDestroyBuffer(device_->handle(), buffer_, nullptr);
    buffer_ = VK_NULL_HANDLE;
}

VkImageAspectFlags aspectOf(VkFormat format) {
    switch (format) {
        case VK_FORMAT_D32_SFLOAT:
        case VK_FORMAT_D16_UNORM:
        case VK_FORMAT_X8_D24_UNORM_PACK32:
            return VK_IMAGE_ASPECT_DEPTH_BIT;
        default:
            return VK_IMAGE_ASPECT_COLOR_BIT;
    }
}

std::uint32_t mipCountOf(std::uint32_t width, std::uint32_t height) {
    return static_cast<std::uint32_t>(std::bit_width(std::max({width, height, 1u})));
}

std::uint32_t bytesPerTexel(VkFormat format) {
    switch (format) {
        case VK_FORMAT_R8_UNORM:
            return 1;
        case VK_FORMAT_R8G8_UINT:
        case VK_FORMAT_D16_UNORM:
            return 2;
        case VK_FORMAT_R8G8B8A8_UNORM:
        case VK_FORMAT_R8G8B8A8_SRGB:
        case VK_FORMAT_B8G8R8A8_UNORM:
        case VK_FORMAT_B8G8R8A8_SRGB:
        case VK_FORMAT_B10G11R11_UFLOAT_PACK32:
        case VK_FORMAT_R16G16_UINT:
        case VK_FORMAT_R32_UINT:
        case VK_FORMAT_R32_SFLOAT:
        case VK_FORMAT_D32_SFLOAT:
            return 4;
        case VK_FORMAT_R16G16B16A16_SFLOAT:
        case VK_FORMAT_R32G32_SFLOAT:
            return 8;
        case VK_FORMAT_R32G32B32A32_SFLOAT:
            return 16;
        default:
            throw GpuError("The renderer does not know the size of a texel of format " + std::to_string(format) + ".");
    }
}

GpuImage::GpuImage(const Device& device, const ImageDesc& desc) : device_(&device), desc_(desc) {
    const std::uint32_t largest = device.limits().maxImageDimension2D;
    if (desc.width == 0 || desc.height == 0 || desc.width > largest || desc.height > largest) {
        throw GpuError("The image '" + desc.name + "' of " + std::to_string(desc.width) + "x" +
                       std::to_string(desc.height) + " is beyond the device's limit of " + std::to_string(largest) +
                       "; choose a smaller size.");
    }
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = desc.format;
    info.extent = {desc.width, desc.height, 1};
    info.mipLevels = desc.mips;
    info.arrayLayers = desc.layers;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = desc.usage;
    VkImageFormatProperties properties{};
    if (vkGetPhysicalDeviceImageFormatProperties(device.physical(), info.format, info.imageType, info.tiling,
                                                 info.usage, 0, &properties) != VK_SUCCESS) {
        throw GpuError("The device does not support the format of the image '" + desc.name + "'.");
    }
    check(vkCreateImage(device.handle(), &info, nullptr, &image_), "creating an image");
    try {
        VkMemoryRequirements requirements{};
        vkGetImageMemoryRequirements(device.handle(), image_, &requirements);
        allocation_ = device.memory().allocate(requirements, MemoryUse::DeviceLocal, true);
        check(vkBindImageMemory(device.handle(), image_, allocation_.memory(), allocation_.offset()),
              "binding an image");
        const bool isArray = desc.arrayView || desc.layers > 1;
        view_ = makeView(isArray ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D, 0, desc.layers);
        if (isArray) {
            for (std::uint32_t l = 0; l < desc.layers; ++l)
                layerViews_.push_back(makeView(VK_IMAGE_VIEW_TYPE_2D, l, 1));
        }
    } catch (...) {
        destroy();
        throw;
    }
    device.name(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<std::uint64_t>(image_), desc.name);
}

VkImageView GpuImage::makeView(VkImageViewType type, std::uint32_t layer, std::uint32_t layers) const {
    VkImageViewCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    info.image = image_;
    info.viewType = type;
    info.format = desc_.format;
    info.subresourceRange = {aspectOf(desc_.format), 0, desc_.mips, layer, layers};
    VkImageView view = VK_NULL_HANDLE;
    check(vkCreateImageView(device_->handle(), &info, nullptr, &view), "creating an image view");
    return view;
}

GpuImage& GpuImage::operator=(GpuImage&& other) noexcept {
    if (this != &other) {
        destroy();
        device_ = other.device_;
        desc_ = std::move(other.desc_);
        image_ = std::exchange(other.image_, VK_NULL_HANDLE);
        view_ = std::exchange(other.view_, VK_NULL_HANDLE);
        layerViews_ = std::exchange(other.layerViews_, {});
        allocation_ = std::move(other.allocation_);
    }
    return *this;
}

void GpuImage::destroy() {
    if (device_ == nullptr) return;
    for (const VkImageView view : layerViews_) vkDestroyImageView(device_->handle(), view, nullptr);
    layerViews_.clear();
    vkDestroyImageView(device_->handle(), std::exchange(view_, VK_NULL_HANDLE), nullptr);
    vkDestroyImage(device_->handle(), std::exchange(image_, VK_NULL_HANDLE), nullptr);
}

Sampler::Sampler(const Device& device, const SamplerDesc& desc) : device_(&device) {
    VkSamplerCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    info.magFilter = info.minFilter = desc.linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
    info.mipmapMode = desc.linear ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
    info.addressModeU = desc.repeatU ? VK_SAMPLER_ADDRESS_MODE_REPEAT : VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.addressModeV = desc.repeatV ? VK_SAMPLER_ADDRESS_MODE_REPEAT : VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.maxLod = desc.mips ? VK_LOD_CLAMP_NONE : 0.0f;
    info.anisotropyEnable = desc.anisotropy && desc.linear && device.features().samplerAnisotropy;
    info.maxAnisotropy = info.anisotropyEnable ? std::min(8.0f, device.limits().maxSamplerAnisotropy) : 1.0f;
    check(vkCreateSampler(device.handle(), &info, nullptr, &sampler_), "creating a sampler");
}

Sampler& Sampler::operator=(Sampler&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(sampler_, other.sampler_);
    return *this;
}

Sampler::~Sampler() {
    if (sampler_ != VK_NULL_HANDLE) vkDestroySampler(device_->handle(), sampler_, nullptr);
}

}  // namespace gnomon::renderer
