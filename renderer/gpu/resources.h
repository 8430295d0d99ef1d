#pragma once
// Buffers, images, samplers, uploads and readback. All are movable and give their memory back on destruction; the
// device must outlive them and must have finished using them.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "renderer/gpu/device.h"

namespace gnomon::renderer {

class Buffer {
public:
    Buffer() = default;
    /// A size of zero becomes 16 bytes, so that it can be bound. Throws GpuError.
    Buffer(const Device& device, const std::string& name, VkDeviceSize bytes, VkBufferUsageFlags usage,
           MemoryUse use = MemoryUse::DeviceLocal);
    Buffer(Buffer&& other) noexcept { *this = std::move(other); }
    Buffer& operator=(Buffer&& other) noexcept;
    ~Buffer() { destroy(); }

    [[nodiscard]] VkBuffer handle() const { return buffer_; }
    [[nodiscard]] VkDeviceSize bytes() const { return bytes_; }
    template <typename T = void>
    [[nodiscard]] T* mapped() const {
        return static_cast<T*>(allocation_.mapped());
    }

private:
    void destroy();
    const Device* device_ = nullptr;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkDeviceSize bytes_ = 0;
    Allocation allocation_;
};

struct ImageDesc {
    std::string name;
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    std::uint32_t width = 1, height = 1, layers = 1, mips = 1;
    VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    bool arrayView = false;  ///< the whole view is 2D_ARRAY even with one layer
};

[[nodiscard]] VkImageAspectFlags aspectOf(VkFormat format);
[[nodiscard]] std::uint32_t mipCountOf(std::uint32_t width, std::uint32_t height);

class GpuImage {
public:
    GpuImage() = default;
    /// Throws GpuError if the device supports no such image or is out of memory. Starts in UNDEFINED.
    GpuImage(const Device& device, const ImageDesc& desc);
    GpuImage(GpuImage&& other) noexcept { *this = std::move(other); }
    GpuImage& operator=(GpuImage&& other) noexcept;
    ~GpuImage() { destroy(); }

    [[nodiscard]] VkImage handle() const { return image_; }
    [[nodiscard]] VkImageView view() const { return view_; }  ///< all mips and layers
    /// 2D view of one layer, all mips.
    [[nodiscard]] VkImageView layerView(std::uint32_t layer) const { return layerViews_.at(layer); }
    [[nodiscard]] const ImageDesc& desc() const { return desc_; }
    [[nodiscard]] VkDeviceSize bytes() const { return allocation_.size(); }

private:
    void destroy();
    VkImageView makeView(VkImageViewType type, std::uint32_t layer, std::uint32_t layers) const;
    const Device* device_ = nullptr;
    ImageDesc desc_;
    VkImage image_ = VK_NULL_HANDLE;
    VkImageView view_ = VK_NULL_HANDLE;
    std::vector<VkImageView> layerViews_;
    Allocation allocation_;
};

struct SamplerDesc {
    bool repeatU = true, repeatV = true, linear = true, mips = true;
    bool anisotropy = false;  ///< up to 8, where the device has it
};

class Sampler {
public:
    Sampler() = default;
    Sampler(const Device& device, const SamplerDesc& desc);
    Sampler(Sampler&& other) noexcept { *this = std::move(other); }
    Sampler& operator=(Sampler&& other) noexcept;
    ~Sampler();
    [[nodiscard]] VkSampler handle() const { return sampler_; }

private:
    const Device* device_ = nullptr;
    VkSampler sampler_ = VK_NULL_HANDLE;
};

/// One side of a barrier.
struct Access {
    VkPipelineStageFlags2 stage = VK_PIPELINE_STAGE_2_NONE;
    VkAccessFlags2 access = VK_ACCESS_2_NONE;
};

namespace access {
inline constexpr Access kNone{};
inline constexpr Access kTransferWrite{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
inline constexpr Access kTransferRead{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};
inline constexpr Access kColourWrite{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                     VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT};
inline constexpr Access kDepthWrite{
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT};
/// Sampled by compute or fragment shaders.
inline constexpr Access kSampled{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                                 VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
inline constexpr Access kComputeWrite{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                      VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT};
inline constexpr Access kStorageRead{VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT |
                                         VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                     VK_ACCESS_2_SHADER_STORAGE_READ_BIT};
}  // namespace access

/// All mips and layers of an image: a barrier with a layout change.
VkImageMemoryBarrier2 imageBarrier(const GpuImage& image, VkImageLayout from, Access before, VkImageLayout to,
                                   Access after);
VkBufferMemoryBarrier2 bufferBarrier(const Buffer& buffer, Access before, Access after);
void recordBarriers(VkCommandBuffer commands, std::span<const VkImageMemoryBarrier2> images,
                    std::span<const VkBufferMemoryBarrier2> buffers = {});

/// Copies to the device through staging memory; waits whenever 64 MiB are pending, and in finish().
class Uploader {
public:
    explicit Uploader(const Device& device) : device_(device) {}
    void buffer(const Buffer& target, std::span<const std::byte> data, VkDeviceSize offset = 0);
    /// Fills mip 0 from tightly packed rows and the other mips by blits; leaves SHADER_READ_ONLY_OPTIMAL.
    void image(const GpuImage& target, std::span<const std::uint8_t> texels);
    void finish();

private:
    VkCommandBuffer commands();
    Buffer& stage(std::span<const std::byte> data);
    const Device& device_;
    std::unique_ptr<Commands> commands_;
    std::vector<Buffer> staging_;
    VkDeviceSize pending_ = 0;
    VkCommandBuffer current_ = VK_NULL_HANDLE;
    bool recording_ = false;
};

/// Bytes of one mip and layer, rows from the top without padding. The image needs TRANSFER_SRC and is returned to
/// `layout`. Waits for the device.
std::vector<std::uint8_t> readImage(const Device& device, const GpuImage& image, VkImageLayout layout,
                                    std::uint32_t layer = 0, std::uint32_t mip = 0);
/// The buffer needs TRANSFER_SRC. Waits for the device.
std::vector<std::uint8_t> readBuffer(const Device& device, VkBuffer buffer, VkDeviceSize bytes,
                                     VkDeviceSize offset = 0);

/// Bytes of a texel, for the formats that the renderer uses; throws GpuError for others.
[[nodiscard]] std::uint32_t bytesPerTexel(VkFormat format);

}  // namespace gnomon::renderer
