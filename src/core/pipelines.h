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

// The pipelines of one frame, by PassId.
using PassPipelines = std::array<VkPipeline, kPassCount>;

// Thread safe. Destroyed by destroy().
class Pipelines {
public:
    struct Desc {
        VkPipelineCache cache = VK_NULL_HANDLE;
        VkPipelineLayout layout = VK_NULL_HANDLE;
        std::uint32_t subgroupSize = 0;
        bool requireSubgroupSize = false;                 // else the device has no other
        std::vector<std::uint32_t> generateShadowsSpirv;  // the host's own, in place of the pass's
    };
    void create(const DeviceContext& device, Desc desc);  // moves; no failure
    void destroy() noexcept;

    // Fills `out`; makes what is missing. Throws std::bad_alloc.
    Result get(const gpu::Specialization& values, PassPipelines& out);
    [[nodiscard]] std::uint32_t count() const noexcept;

private:
    using Values = std::array<std::uint32_t, gpu::kSpecCount>;
    struct Entry {
        PassId pass;
        Values values;  // 0 where the pass has no such constant
        VkPipeline pipeline;
    };
    [[nodiscard]] VkPipeline find(PassId pass, const Values& values) const noexcept;
    Result make(PassId pass, const Values& values, VkPipeline& out) const;

    const DeviceContext* device_ = nullptr;
    Desc desc_;
    mutable std::mutex mutex_;  // guards entries_; never held while a pipeline is compiled
    std::vector<Entry> entries_;
};

}  // namespace gnomon
