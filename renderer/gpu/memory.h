#pragma once
// A small sub-allocator: devices allow as few as 4096 allocations, and a scene has more resources than that.
//
// Blocks have 64 MiB, per memory type and kind. Buffers and images are apart, so bufferImageGranularity never matters.
// Free ranges stand in a sorted list, and the first that fits is taken. What is larger than half a block gets an
// allocation of its own.

#include <cstdint>
#include <memory>
#include <vector>

#include "renderer/gpu/error.h"

namespace gnomon::renderer {

enum class MemoryUse : std::uint8_t {
    DeviceLocal,  ///< read and written by the device
    Upload,       ///< mapped, written by the host in order
    Readback,     ///< mapped, read by the host (cached where there is such memory)
};

class MemoryPool;

/// A range of device memory, given back on destruction. Movable.
class Allocation {
public:
    Allocation() = default;
    Allocation(Allocation&& other) noexcept { *this = std::move(other); }
    Allocation& operator=(Allocation&& other) noexcept;
    ~Allocation() { release(); }

    [[nodiscard]] VkDeviceMemory memory() const;
    [[nodiscard]] VkDeviceSize offset() const { return offset_; }
    [[nodiscard]] VkDeviceSize size() const { return size_; }
    [[nodiscard]] void* mapped() const;  ///< null unless Upload or Readback

private:
    friend class MemoryPool;
    void release();
    MemoryPool* pool_ = nullptr;
    struct MemoryBlock* block_ = nullptr;
    VkDeviceSize offset_ = 0, size_ = 0;
};

/// Not thread safe. Outlives its allocations.
class MemoryPool {
public:
    MemoryPool(VkPhysicalDevice physical, VkDevice device);
    ~MemoryPool();
    MemoryPool(const MemoryPool&) = delete;
    MemoryPool& operator=(const MemoryPool&) = delete;

    /// Throws GpuError if the device is out of memory or has no memory of that kind.
    Allocation allocate(const VkMemoryRequirements& requirements, MemoryUse use, bool forImage);

private:
    friend class Allocation;
    void free(MemoryBlock& block, VkDeviceSize offset, VkDeviceSize size);
    [[nodiscard]] std::uint32_t memoryType(std::uint32_t allowed, MemoryUse use) const;
    MemoryBlock& addBlock(std::uint32_t type, VkDeviceSize size, MemoryUse use, bool forImage, bool dedicated);

    VkDevice device_;
    VkPhysicalDeviceMemoryProperties properties_{};
    std::vector<std::unique_ptr<MemoryBlock>> blocks_;
};

}  // namespace gnomon::renderer
