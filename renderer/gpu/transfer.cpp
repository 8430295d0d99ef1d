// Barriers, uploads and readback: the parts of resources.h that record commands.
#include <algorithm>
#include <cstring>

#include "renderer/gpu/resources.h"

namespace gnomon::renderer {

namespace {
constexpr VkDeviceSize kPendingLimitBytes = VkDeviceSize{64} << 20;
}

VkImageMemoryBarrier2 imageBarrier(const GpuImage& image, VkImageLayout from, Access before, VkImageLayout to,
                                   Access after) {
    VkImageMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    barrier.srcStageMask = before.stage;
    barrier.srcAccessMask = before.access;
    barrier.dstStageMask = after.stage;
    barrier.dstAccessMask = after.access;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image.handle();
    barrier.subresourceRange = {aspectOf(image.desc().format), 0, VK_REMAINING_MIP_LEVELS, 0,
                                VK_REMAINING_ARRAY_LAYERS};
    return barrier;
}

VkBufferMemoryBarrier2 bufferBarrier(const Buffer& buffer, Access before, Access after) {
    VkBufferMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2;
    barrier.srcStageMask = before.stage;
    barrier.srcAccessMask = before.access;
    barrier.dstStageMask = after.stage;
    barrier.dstAccessMask = after.access;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.buffer = buffer.handle();
    barrier.size = VK_WHOLE_SIZE;
    return barrier;
}

void recordBarriers(VkCommandBuffer commands, std::span<const VkImageMemoryBarrier2> images,
                    std::span<const VkBufferMemoryBarrier2> buffers) {
    VkDependencyInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    info.imageMemoryBarrierCount = static_cast<std::uint32_t>(images.size());
    info.pImageMemoryBarriers = images.data();
    info.bufferMemoryBarrierCount = static_cast<std::uint32_t>(buffers.size());
    info.pBufferMemoryBarriers = buffers.data();
    vkCmdPipelineBarrier2(commands, &info);
}

VkCommandBuffer Uploader::commands() {
    if (commands_ == nullptr) commands_ = std::make_unique<Commands>(device_);
    if (recording_) return current_;
    recording_ = true;
    return current_ = commands_->begin();
}

Buffer& Uploader::stage(std::span<const std::byte> data) {
    if (pending_ + data.size() > kPendingLimitBytes) finish();
    Buffer staging(device_, "staging", data.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Upload);
    std::memcpy(staging.mapped(), data.data(), data.size());
    pending_ += data.size();
    staging_.push_back(std::move(staging));
    return staging_.back();
}

void Uploader::buffer(const Buffer& target, std::span<const std::byte> data, VkDeviceSize offset) {
    // In pieces, so that a large buffer never needs as much staging memory again.
    for (std::size_t begin = 0; begin < data.size(); begin += kPendingLimitBytes / 4) {
        const std::size_t bytes = std::min<std::size_t>(data.size() - begin, kPendingLimitBytes / 4);
        const VkBuffer source = stage(data.subspan(begin, bytes)).handle();
        const VkBufferCopy copy{0, offset + begin, bytes};
        vkCmdCopyBuffer(commands(), source, target.handle(), 1, &copy);
    }
}

void Uploader::image(const GpuImage& target, std::span<const std::uint8_t> texels) {
    const ImageDesc& desc = target.desc();
    const VkBuffer source = stage(std::as_bytes(texels)).handle();
    const VkCommandBuffer cmd = commands();
    VkImageMemoryBarrier2 barrier = imageBarrier(target, VK_IMAGE_LAYOUT_UNDEFINED, access::kNone,
                                                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, access::kTransferWrite);
    recordBarriers(cmd, {&barrier, 1});
    VkBufferImageCopy copy{};
    copy.imageSubresource = {aspectOf(desc.format), 0, 0, 1};
    copy.imageExtent = {desc.width, desc.height, 1};
    vkCmdCopyBufferToImage(cmd, source, target.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    for (std::uint32_t mip = 0; mip < desc.mips; ++mip) {
        barrier = imageBarrier(target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, access::kTransferWrite,
                               VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, access::kTransferRead);
        barrier.subresourceRange.baseMipLevel = mip;
        barrier.subresourceRange.levelCount = 1;
        recordBarriers(cmd, {&barrier, 1});
        if (mip + 1 == desc.mips) break;
        VkImageBlit blit{};
        blit.srcSubresource = {aspectOf(desc.format), mip, 0, 1};
        blit.dstSubresource = {aspectOf(desc.format), mip + 1, 0, 1};
        blit.srcOffsets[1] = {static_cast<int>(std::max(desc.width >> mip, 1u)),
                              static_cast<int>(std::max(desc.height >> mip, 1u)), 1};
        blit.dstOffsets[1] = {static_cast<int>(std::max(desc.width >> (mip + 1), 1u)),
                              static_cast<int>(std::max(desc.height >> (mip + 1), 1u)), 1};
        vkCmdBlitImage(cmd, target.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target.handle(),
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_LINEAR);
    }
    barrier = imageBarrier(target, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, access::kTransferRead,
                           VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, access::kSampled);
    recordBarriers(cmd, {&barrier, 1});
}

void Uploader::finish() {
    if (recording_) {
        // Whatever reads the buffers next runs in another submission: everything written here is made available once.
        VkMemoryBarrier2 all{};
        all.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
        all.srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
        all.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
        all.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        all.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
        VkDependencyInfo info{};
        info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
        info.memoryBarrierCount = 1;
        info.pMemoryBarriers = &all;
        vkCmdPipelineBarrier2(current_, &info);
        commands_->submit();
        commands_->wait();
    }
    recording_ = false;
    staging_.clear();
    pending_ = 0;
}

std::vector<std::uint8_t> readImage(const Device& device, const GpuImage& image, VkImageLayout layout,
                                    std::uint32_t layer, std::uint32_t mip) {
    const ImageDesc& desc = image.desc();
    const std::uint32_t width = std::max(desc.width >> mip, 1u), height = std::max(desc.height >> mip, 1u);
    const VkDeviceSize bytes = VkDeviceSize{width} * height * bytesPerTexel(desc.format);
    Buffer target(device, "readback", bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::Readback);
    device.submitAndWait([&](VkCommandBuffer cmd) {
        constexpr Access kAny{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                              VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
        VkImageMemoryBarrier2 barrier =
            imageBarrier(image, layout, kAny, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, access::kTransferRead);
        recordBarriers(cmd, {&barrier, 1});
        VkBufferImageCopy copy{};
        copy.imageSubresource = {aspectOf(desc.format), mip, layer, 1};
        copy.imageExtent = {width, height, 1};
        vkCmdCopyImageToBuffer(cmd, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target.handle(), 1, &copy);
        barrier = imageBarrier(image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, access::kTransferRead, layout, kAny);
        constexpr Access kHost{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};
        const VkBufferMemoryBarrier2 host = bufferBarrier(target, access::kTransferWrite, kHost);
        recordBarriers(cmd, {&barrier, 1}, {&host, 1});
    });
    const auto* begin = target.mapped<std::uint8_t>();
    return {begin, begin + bytes};
}

std::vector<std::uint8_t> readBuffer(const Device& device, VkBuffer buffer, VkDeviceSize bytes, VkDeviceSize offset) {
    Buffer target(device, "readback", bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::Readback);
    device.submitAndWait([&](VkCommandBuffer cmd) {
        VkMemoryBarrier2 all{};
        all.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
        all.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        all.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
        all.dstStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
        all.dstAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT;
        VkDependencyInfo info{};
        info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
        info.memoryBarrierCount = 1;
        info.pMemoryBarriers = &all;
        vkCmdPipelineBarrier2(cmd, &info);
        const VkBufferCopy copy{offset, 0, bytes};
        vkCmdCopyBuffer(cmd, buffer, target.handle(), 1, &copy);
        constexpr Access kHost{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};
        const VkBufferMemoryBarrier2 host = bufferBarrier(target, access::kTransferWrite, kHost);
        recordBarriers(cmd, {}, {&host, 1});
    });
    const auto* begin = target.mapped<std::uint8_t>();
    return {begin, begin + bytes};
}

}  // namespace gnomon::renderer
