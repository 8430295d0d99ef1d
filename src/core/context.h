#pragma once
// What a Context holds.

#include "core/pipelines.h"
#include "gnomon/context.h"
#include "vulkan/resources.h"

namespace gnomon {

struct GNOMON_HIDDEN Context::State {
    DeviceContext device;
    std::uint32_t subgroupSize = 0;
    bool requireSubgroupSize = false;  // pipelines ask for it; else the device has no other
    std::uint32_t maxShadowAtlases = 0;
    bool hostProvider = false;                              // the host has a filter of its own
    float timestampPeriodNs = 0.0f;                         // 0: no timestamps
    std::uint64_t timestampMask = ~std::uint64_t{0};        // the bits that count, in every family
    VkDescriptorSetLayout setLayouts[gpu::kSetCount] = {};  // by set number
    VkPipelineLayout pipelineLayout = VK_NULL_HANDLE;
    VkSampler shadowSampler = VK_NULL_HANDLE;
    Pipelines pipelines;

    ~State();
    // Checks the settings and finds or makes their pipelines, for these queues. Throws std::bad_alloc.
    Result pipelinesFor(const ShadowSettings& settings, QueueSet queues, PassPipelines& out);
    [[nodiscard]] gpu::Specialization specializationOf(const ShadowSettings& settings) const noexcept;
};

// The queues of all lights that may have these filters; some filters need none.
QueueSet queuesOf(FilterSet filters) noexcept;

}  // namespace gnomon
