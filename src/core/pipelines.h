#pragma once
// Pipelines of all passes and settings, made when they are first needed and kept. Passes share a pipeline across
// settings that differ only in constants which their shader does not have.

#include <array>
#include <mutex>
#include <vector>

#include "core/passes.h"
#include "gpu_interface/structs.h"
#include "vulkan/resources.h"

namespace gnomon {

// A set of pair queues (gpu::pairQueueOf()), one bit each.
using QueueSet = std::uint32_t;
static_assert(gpu::kPairQueueCount <= 32);

// The pipelines of one frame.
struct PassPipelines {
    // By PassId, of passes that are made once; null for those that the settings do not record.
    std::array<VkPipeline, kPassCount> once = {};
    // By queue, of passes that are made once per queue; null for queues that were not asked for.
    std::array<VkPipeline, gpu::kPairQueueCount> searchPairs = {}, filterPairs = {};
};

// Thread safe. Destroyed by destroy().
class Pipelines {
public:
    struct Desc {
        VkPipelineCache cache = VK_NULL_HANDLE;
        VkPipelineLayout layout = VK_NULL_HANDLE;
        std::uint32_t subgroupSize = 0;
        bool requireSubgroupSize = false;             // else the device has no other
        std::vector<std::uint32_t> filterPairsSpirv;  // the host's own, for Filter::Host
    };
    void create(const DeviceContext& device, Desc desc);  // moves; no failure
    void destroy() noexcept;

    // Fills `out`, for these queues; makes what is missing. Throws std::bad_alloc.
    Result get(const gpu::Specialization& values, QueueSet queues, PassPipelines& out);
    [[nodiscard]] std::uint32_t count() const noexcept;

private:
    using Values = std::array<std::uint32_t, gpu::kSpecCount>;
    struct Entry {
        PassId pass;
        Values values;  // 0 where the pass has no such constant
        VkPipeline pipeline;
    };
    [[nodiscard]] VkPipeline find(PassId pass, const Values& values) const noexcept;
    Result getOne(PassId pass, const Values& all, VkPipeline& out);
    Result make(PassId pass, const Values& values, VkPipeline& out) const;

    const DeviceContext* device_ = nullptr;
    Desc desc_;
    mutable std::mutex mutex_;  // guards entries_; never held while a pipeline is compiled
    std::vector<Entry> entries_;
};

}  // namespace gnomon
