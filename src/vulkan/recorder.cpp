#include "vulkan/recorder.h"

#include <algorithm>
#include <cassert>

namespace gnomon {

bool BarrierTracker::conflicts(const Use& use, Access access) const noexcept {
    switch (access) {
        case Access::Uniform:
        case Access::Streamed:
        case Access::Sampled:
            return false;  // the host's own; the library never writes them on the device
        case Access::Read:
        case Access::Indirect:
            return use.written == barriers_;
        case Access::Write:
            return use.written == barriers_ || use.read == barriers_;
    }
    return true;
}

void BarrierTracker::note(Use& use, Access access) const noexcept {
    if (access == Access::Write) use.written = barriers_;
    if (access == Access::Read || access == Access::Indirect) use.read = barriers_;
}

void Recorder::barrier(VkPipelineStageFlags2 fromStage, VkAccessFlags2 fromAccess, VkPipelineStageFlags2 toStage,
                       VkAccessFlags2 toAccess) noexcept {
    VkMemoryBarrier2 barrier = {VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = fromStage;
    barrier.srcAccessMask = fromAccess;
    barrier.dstStageMask = toStage;
    barrier.dstAccessMask = toAccess;
    VkDependencyInfo info = {VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &barrier;
    device_.vk.CmdPipelineBarrier2(commands_, &info);
    tracker_.barrier();
}

// Orders the pass after the earlier ones whose buffers it shares. The barrier covers indirect commands whether or not
// this pass has one: the tracker counts barriers, and so each of them must cover all that a pass may do.
void Recorder::order(const Pass& pass, const std::array<BoundSet, gpu::kSetCount>& sets) noexcept {
    bool needed = false;
    for (const PassResource& resource : pass.resources)
        needed = needed || tracker_.conflicts(sets[resource.set].uses[resource.binding], resource.access);
    if (needed) {
        const VkPipelineStageFlags2 stages = kCompute | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT;
        barrier(stages, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, stages, kStorage | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
    }
    for (const PassResource& resource : pass.resources)
        tracker_.note(sets[resource.set].uses[resource.binding], resource.access);
}

void Recorder::dispatch(const Pass& pass, VkPipelineLayout layout, const std::array<BoundSet, gpu::kSetCount>& sets,
                        std::span<const Dispatch> dispatches) noexcept {
    const Functions& vk = device_.vk;
    if (device_.debugLabels) {
        VkDebugUtilsLabelEXT label = {VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
        label.pLabelName = pass.name;
        vk.CmdBeginDebugUtilsLabelEXT(commands_, &label);
    }
    order(pass, sets);
    const Timeline::Row row =
        timeline_ != nullptr ? timeline_->begin(commands_, pass.name, pass.phase, RowKind::Compute) : Timeline::kNone;
    for (std::uint32_t set = 0; set < gpu::kSetCount; ++set) {
        bool used = false;
        for (const PassResource& resource : pass.resources) used = used || resource.set == set;
        if (!used) continue;
        vk.CmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, layout, set, 1, &sets[set].handle, 0,
                                 nullptr);
    }
    for (const Dispatch& dispatch : dispatches) {
        assert(std::ranges::any_of(pass.resources, [](const PassResource& r) {
                   return r.access == Access::Indirect;
               }) == (dispatch.indirect != VK_NULL_HANDLE));
        vk.CmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, dispatch.pipeline);
        if (dispatch.indirect != VK_NULL_HANDLE) {
            vk.CmdDispatchIndirect(commands_, dispatch.indirect, dispatch.offset);
        } else {
            vk.CmdDispatch(commands_, dispatch.x, dispatch.y, 1);
        }
    }
    if (timeline_ != nullptr) timeline_->end(commands_, row);
    if (device_.debugLabels) vk.CmdEndDebugUtilsLabelEXT(commands_);
}

void Recorder::publish() noexcept {
    barrier(kCompute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
            kStorage | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
}

}  // namespace gnomon
