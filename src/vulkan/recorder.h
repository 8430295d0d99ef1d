#pragma once
// Records passes into the host's command buffer: label, barrier, bindings, timeline row, dispatch.

#include <array>
#include <cstdint>
#include <span>

#include "gpu_interface/numbers.h"
#include "vulkan/pass.h"
#include "vulkan/resources.h"

namespace gnomon {

// Orders passes that share buffers. Barriers are global memory barriers: one orders everything recorded before it. So
// it is enough to number them: a use is pending as long as no barrier has come after it.
class BarrierTracker {
public:
    struct Use {
        std::uint32_t written = 0, read = 0;  // after which barrier
    };
    // Whether an access of this kind needs a barrier first.
    [[nodiscard]] bool conflicts(const Use& use, Access access) const noexcept;
    void note(Use& use, Access access) const noexcept;
    void barrier() noexcept { ++barriers_; }

private:
    std::uint32_t barriers_ = 1;
};

// A descriptor set of a frame, and how its bindings were used last.
struct BoundSet {
    VkDescriptorSet handle = VK_NULL_HANDLE;
    std::span<BarrierTracker::Use> uses;  // by binding
};

struct Dispatch {
    VkPipeline pipeline = VK_NULL_HANDLE;
    std::uint32_t x = 1, y = 1;
    VkBuffer indirect = VK_NULL_HANDLE;  // in place of x and y: a VkDispatchIndirectCommand at this offset
    VkDeviceSize offset = 0;
};

class Recorder {
public:
    Recorder(const DeviceContext& device, VkCommandBuffer commands, BarrierTracker& tracker,
             Timeline* timeline) noexcept
        : device_(device), commands_(commands), tracker_(tracker), timeline_(timeline) {}

    // `sets` by set number; those that the pass does not use may be empty. Several dispatches of a pass stand in no
    // order among themselves.
    void dispatch(const Pass& pass, VkPipelineLayout layout, const std::array<BoundSet, gpu::kSetCount>& sets,
                  std::span<const Dispatch> dispatches) noexcept;
    // Makes everything written so far visible to the host's shaders and to indirect dispatch.
    void publish() noexcept;
    void barrier(VkPipelineStageFlags2 fromStage, VkAccessFlags2 fromAccess, VkPipelineStageFlags2 toStage,
                 VkAccessFlags2 toAccess) noexcept;

    [[nodiscard]] VkCommandBuffer commands() const noexcept { return commands_; }

    static constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    static constexpr VkAccessFlags2 kStorage =
        VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;

private:
    void order(const Pass& pass, const std::array<BoundSet, gpu::kSetCount>& sets) noexcept;

    const DeviceContext& device_;
    VkCommandBuffer commands_;
    BarrierTracker& tracker_;
    Timeline* timeline_;
};

}  // namespace gnomon
