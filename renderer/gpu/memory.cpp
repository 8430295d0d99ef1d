#include "renderer/gpu/memory.h"

#include <algorithm>
#include <utility>

namespace gnomon::renderer {

namespace {
constexpr VkDeviceSize kBlockBytes = VkDeviceSize{64} << 20;
}

struct MemoryBlock {
    struct Range {
        VkDeviceSize offset, size;
    };
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize size = 0;
    std::uint32_t type = 0;
    MemoryUse use = MemoryUse::DeviceLocal;
    bool forImage = false, dedicated = false;
    void* mapped = nullptr;
    std::vector<Range> freeRanges;  // by offset, never touching each other
};

Allocation& Allocation::operator=(Allocation&& other) noexcept {
    if (this != &other) {
        release();
        pool_ = std::exchange(other.pool_, nullptr);
        block_ = std::exchange(other.block_, nullptr);
        offset_ = std::exchange(other.offset_, 0);
        size_ = std::exchange(other.size_, 0);
    }
    return *this;
}

void Allocation::release() {
    if (pool_ != nullptr) pool_->free(*block_, offset_, size_);
    pool_ = nullptr;
}

VkDeviceMemory Allocation::memory() const {
    return block_ != nullptr ? block_->memory : VK_NULL_HANDLE;
}

void* Allocation::mapped() const {
    return block_ != nullptr && block_->mapped != nullptr ? static_cast<char*>(block_->mapped) + offset_ : nullptr;
}

MemoryPool::MemoryPool(VkPhysicalDevice physical, VkDevice device) : device_(device) {
    vkGetPhysicalDeviceMemoryProperties(physical, &properties_);
}

MemoryPool::~MemoryPool() {
    for (const auto& block : blocks_) vkFreeMemory(device_, block->memory, nullptr);
}

std::uint32_t MemoryPool::memoryType(std::uint32_t allowed, MemoryUse use) const {
    constexpr VkMemoryPropertyFlags kMapped =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    // Best first; the last entry is what is needed at least.
    std::vector<VkMemoryPropertyFlags> wishes;
    if (use == MemoryUse::DeviceLocal) wishes = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
    if (use == MemoryUse::Upload) wishes = {kMapped};
    if (use == MemoryUse::Readback) wishes = {kMapped | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, kMapped};
    for (const VkMemoryPropertyFlags wish : wishes) {
        for (std::uint32_t t = 0; t < properties_.memoryTypeCount; ++t) {
            if ((allowed & (1u << t)) != 0 && (properties_.memoryTypes[t].propertyFlags & wish) == wish) return t;
        }
    }
    throw GpuError("The device has no memory of the kind that is needed.");
}

MemoryBlock& MemoryPool::addBlock(std::uint32_t type, VkDeviceSize size, MemoryUse use, bool forImage, bool dedicated) {
    auto block = std::make_unique<MemoryBlock>();
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, size, type};
    check(vkAllocateMemory(device_, &info, nullptr, &block->memory), "allocating memory");
    block->size = size;
    block->type = type;
    block->use = use;
    block->forImage = forImage;
    block->dedicated = dedicated;
    block->freeRanges = {{0, size}};
    if (use != MemoryUse::DeviceLocal) {
        const VkResult mapped = vkMapMemory(device_, block->memory, 0, VK_WHOLE_SIZE, 0, &block->mapped);
        if (mapped != VK_SUCCESS) vkFreeMemory(device_, block->memory, nullptr);
        check(mapped, "mapping memory");
    }
    blocks_.push_back(std::move(block));
    return *blocks_.back();
}

Allocation MemoryPool::allocate(const VkMemoryRequirements& requirements, MemoryUse use, bool forImage) {
    const std::uint32_t type = memoryType(requirements.memoryTypeBits, use);
    auto takeFrom = [&](MemoryBlock& block, Allocation& out) {
        for (std::size_t r = 0; r < block.freeRanges.size(); ++r) {
            const MemoryBlock::Range range = block.freeRanges[r];
            const VkDeviceSize begin =
                (range.offset + requirements.alignment - 1) / requirements.alignment * requirements.alignment;
            if (begin + requirements.size > range.offset + range.size) continue;
            const VkDeviceSize end = begin + requirements.size;
            block.freeRanges.erase(block.freeRanges.begin() + static_cast<std::ptrdiff_t>(r));
            auto at = block.freeRanges.begin() + static_cast<std::ptrdiff_t>(r);
            if (end < range.offset + range.size)
                at = block.freeRanges.insert(at, {end, range.offset + range.size - end});
            if (begin > range.offset) block.freeRanges.insert(at, {range.offset, begin - range.offset});
            out.pool_ = this;
            out.block_ = &block;
            out.offset_ = begin;
            out.size_ = requirements.size;
            return true;
        }
        return false;
    };
    Allocation out;
    const bool dedicated = requirements.size > kBlockBytes / 2;
    if (!dedicated) {
        for (const auto& block : blocks_) {
            const bool fits =
                block->type == type && block->use == use && block->forImage == forImage && !block->dedicated;
            if (fits && takeFrom(*block, out)) return out;
        }
    }
    takeFrom(addBlock(type, dedicated ? requirements.size : kBlockBytes, use, forImage, dedicated), out);
    return out;
}

void MemoryPool::free(MemoryBlock& block, VkDeviceSize offset, VkDeviceSize size) {
    if (block.dedicated) {
        vkFreeMemory(device_, block.memory, nullptr);
        std::erase_if(blocks_, [&](const auto& b) { return b.get() == &block; });
        return;
    }
    auto& ranges = block.freeRanges;
    auto next = std::lower_bound(ranges.begin(), ranges.end(), offset,
                                 [](const auto& r, VkDeviceSize o) { return r.offset < o; });
    next = ranges.insert(next, {offset, size});
    if (next + 1 != ranges.end() && next->offset + next->size == (next + 1)->offset) {
        next->size += (next + 1)->size;
        ranges.erase(next + 1);
    }
    if (next != ranges.begin() && (next - 1)->offset + (next - 1)->size == next->offset) {
        (next - 1)->size += next->size;
        ranges.erase(next);
    }
}

}  // namespace gnomon::renderer
