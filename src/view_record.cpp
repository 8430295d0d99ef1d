// View: records the passes, each with the barriers, debug label and timestamps that follow from its declaration.
#include <algorithm>
#include <cstddef>
#include <cstring>

#include "gpu_interface/packing.h"
#include "view.h"

namespace gnomon {
namespace {

using namespace gpu;

void globalBarrier(const Functions& vk, VkCommandBuffer commands, VkPipelineStageFlags2 fromStage,
                   VkAccessFlags2 fromAccess, VkPipelineStageFlags2 toStage, VkAccessFlags2 toAccess) {
    VkMemoryBarrier2 barrier = {VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = fromStage;
    barrier.srcAccessMask = fromAccess;
    barrier.dstStageMask = toStage;
    barrier.dstAccessMask = toAccess;
    VkDependencyInfo info = {VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &barrier;
    vk.CmdPipelineBarrier2(commands, &info);
}

constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkAccessFlags2 kStorageAccess = VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;

// Orders this pass after the earlier ones whose buffers it shares; one global barrier, since they all work on buffers.
void barrierBefore(View::State& state, VkCommandBuffer commands, const Pass& pass) {
    const BufferBits touched = pass.reads | pass.writes;
    if ((touched & state.pendingWrites) != 0 || (pass.writes & state.pendingReads) != 0) {
        globalBarrier(state.context->device.vk, commands, kCompute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, kCompute,
                      kStorageAccess);
        state.pendingWrites = 0;
        state.pendingReads = 0;
    }
    state.pendingReads |= pass.reads;
    state.pendingWrites |= pass.writes;
}

void recordPass(View::State& state, VkCommandBuffer commands, PassId id, std::uint32_t x, std::uint32_t y) {
    const Context::State& context = *state.context;
    const Functions& vk = context.device.vk;
    const Pass& pass = passOf(id);
    FrameSlot& slot = state.slots[state.current];
    if (context.device.debugLabels) {
        VkDebugUtilsLabelEXT label = {VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
        label.pLabelName = pass.name;
        vk.CmdBeginDebugUtilsLabelEXT(commands, &label);
    }
    barrierBefore(state, commands, pass);
    const std::uint32_t query = (state.current * kPassCount + id) * 2;
    if (state.queries != VK_NULL_HANDLE) {
        vk.CmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, state.queries, query);
    }
    const VkDescriptorSet sets[] = {slot.lists, slot.receivers, slot.shadowmaps};
    const std::uint32_t setCount = pass.shadowmaps ? 3u : pass.receivers ? 2u : 1u;
    vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, context.pipelines[id]);
    vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, context.pipelineLayout, 0, setCount, sets, 0,
                             nullptr);
    vk.CmdDispatch(commands, x, y, 1);
    if (state.queries != VK_NULL_HANDLE) {
        vk.CmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, state.queries, query + 1);
    }
    slot.passBits |= 1u << id;
    if (context.device.debugLabels) vk.CmdEndDebugUtilsLabelEXT(commands);
}

// Makes everything written so far visible to the host's shaders and to indirect dispatch.
void publish(View::State& state, VkCommandBuffer commands) {
    globalBarrier(state.context->device.vk, commands, kCompute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, kStorageAccess | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
    state.pendingReads = state.pendingWrites = 0;
}

// Images that are bound but never read still need the layout that their descriptor names. Every frame, since a host may
// drop a recorded frame without submitting it.
void preparePlaceholders(View::State& state, VkCommandBuffer commands) {
    VkImageMemoryBarrier2 barriers[2] = {};
    const VkImage images[2] = {state.noFaceNormals.image, state.noAtlas.image};
    const VkImageAspectFlags aspects[2] = {VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_ASPECT_DEPTH_BIT};
    for (int i = 0; i < 2; ++i) {
        barriers[i].sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
        barriers[i].srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        barriers[i].dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        barriers[i].dstAccessMask = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
        barriers[i].oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
        barriers[i].newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        barriers[i].srcQueueFamilyIndex = barriers[i].dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barriers[i].image = images[i];
        barriers[i].subresourceRange = {aspects[i], 0, 1, 0, 1};
    }
    VkDependencyInfo info = {VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.imageMemoryBarrierCount = 2;
    info.pImageMemoryBarriers = barriers;
    state.context->device.vk.CmdPipelineBarrier2(commands, &info);
}

// The frame's first commands: the last frame's reads end, counters and the indirect command start afresh.
void resetFrame(View::State& state, VkCommandBuffer commands) {
    const Functions& vk = state.context->device.vk;
    preparePlaceholders(state, commands);
    if (state.queries != VK_NULL_HANDLE) {
        vk.CmdResetQueryPool(commands, state.queries, state.current * kPassCount * 2, kPassCount * 2);
    }
    // All commands, so that it may be recorded on a compute queue too; the host's lighting may read in any stage.
    globalBarrier(vk, commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                  kCompute | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, kStorageAccess | VK_ACCESS_2_TRANSFER_WRITE_BIT);
    const GpuCounters counters = {};
    GpuEvaluateHead head = {};
    head.groupCountX = kEvaluateRowTiles;
    head.groupCountZ = 1;
    const VkDeviceSize offset = state.desc.guardBytes;
    vk.CmdUpdateBuffer(commands, state.device[kBindCounters].buffer, offset, sizeof(counters), &counters);
    vk.CmdUpdateBuffer(commands, state.device[kBindEvaluateTiles].buffer, offset, sizeof(head), &head);
    globalBarrier(vk, commands, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, kCompute,
                  kStorageAccess);
    state.pendingReads = state.pendingWrites = 0;
}

// A frame without phase 4 has no final lists; what an earlier frame left must not be counted.
void clearFinalCounts(View::State& state, VkCommandBuffer commands) {
    const Functions& vk = state.context->device.vk;
    globalBarrier(vk, commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, kStorageAccess,
                  VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
    vk.CmdFillBuffer(commands, state.device[kBindFinalCounts].buffer, state.desc.guardBytes,
                     state.sizes.bytes[kBindFinalCounts], 0);
    globalBarrier(vk, commands, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, kCompute,
                  kStorageAccess);
}

// A pool that would have sufficed, with a tenth to spare: what a host may grow to between frames.
std::uint32_t recommend(std::uint32_t used) {
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(std::uint64_t(used) + used / 10 + 1, 0xFFFFFFFFu));
}

void readTimes(const View::State& state, const FrameSlot& slot, std::uint32_t slotIndex, FrameStatistics& out) {
    const Context::State& context = *state.context;
    if (state.queries == VK_NULL_HANDLE) return;
    for (std::uint32_t id = 0; id < kPassCount; ++id) {
        if ((slot.passBits >> id & 1u) == 0) continue;
        std::uint64_t ticks[2] = {};
        const VkResult result = context.device.vk.GetQueryPoolResults(
            context.device.device, state.queries, (slotIndex * kPassCount + id) * 2, 2, sizeof(ticks), ticks,
            sizeof(std::uint64_t), VK_QUERY_RESULT_64_BIT);
        if (result != VK_SUCCESS) continue;
        const double ns = static_cast<double>((ticks[1] - ticks[0]) & context.timestampMask) *
                          static_cast<double>(context.timestampPeriodNs);
        out.passes[out.passCount++] = {passOf(static_cast<PassId>(id)).name, ns * 1e-6};
    }
}

}  // namespace

void View::recordHierarchicalDepth(VkCommandBuffer commands) noexcept {
    State& state = *state_;
    resetFrame(state, commands);
    const GpuFrame& f = state.frame;
    const bool pyramid = state.context->desc.hostDepthPyramid;  // then one lane per tile instead of one per pixel
    recordPass(state, commands, kPassHierarchicalDepth, pyramid ? f.tileGroupCounts.x : f.tileCounts.x,
               pyramid ? f.tileGroupCounts.y : f.tileCounts.y);
}

void View::recordFindLightsApproximate(VkCommandBuffer commands) noexcept {
    recordPass(*state_, commands, kPassFindLightsApproximate, state_->frame.tileGroupCounts.x,
               state_->frame.tileGroupCounts.y);
}

void View::recordFindLightsAccurate(VkCommandBuffer commands) noexcept {
    recordPass(*state_, commands, kPassFindLightsAccurate, state_->frame.tileCounts.x, state_->frame.tileCounts.y);
    publish(*state_, commands);
}

void View::recordShadowBounds(VkCommandBuffer commands) noexcept {
    State& state = *state_;
    const std::uint32_t cells = state.slots[state.current].boundsCellCount;
    if (cells != 0) recordPass(state, commands, kPassShadowBounds, cells, 1);
    state.boundsCells.made();
    publish(state, commands);
}

void View::recordGenerateShadows(VkCommandBuffer commands) noexcept {
    recordPass(*state_, commands, kPassGenerateShadows, state_->frame.tileCounts.x, state_->frame.tileCounts.y);
    publish(*state_, commands);
}

void View::recordEndFrame(VkCommandBuffer commands) noexcept {
    State& state = *state_;
    const Functions& vk = state.context->device.vk;
    if ((state.slots[state.current].passBits >> kPassGenerateShadows & 1u) == 0) clearFinalCounts(state, commands);
    if (state.desc.statistics) {
        const std::uint32_t tiles = state.frame.tileCounts.x * state.frame.tileCounts.y;
        recordPass(state, commands, kPassGatherStatistics, divideRoundingUp(tiles, kWorkGroupSize), 1);
    }
    globalBarrier(vk, commands, kCompute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                  VK_ACCESS_2_TRANSFER_READ_BIT);
    FrameSlot& slot = state.slots[state.current];
    const VkDeviceSize from = state.desc.guardBytes;
    const VkBufferCopy counters = {from, 0, sizeof(GpuCounters)};
    const VkBufferCopy head = {from, sizeof(GpuCounters), sizeof(GpuEvaluateHead)};
    vk.CmdCopyBuffer(commands, state.device[kBindCounters].buffer, slot.readback.buffer, 1, &counters);
    vk.CmdCopyBuffer(commands, state.device[kBindEvaluateTiles].buffer, slot.readback.buffer, 1, &head);
    globalBarrier(vk, commands, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
    state.pendingReads = state.pendingWrites = 0;
    slot.ended = true;
}

bool View::statistics(std::uint64_t frameNumber, FrameStatistics& out) const noexcept {
    const State& state = *state_;
    const auto index = static_cast<std::uint32_t>(frameNumber % state.desc.framesInFlight);
    const FrameSlot& slot = state.slots[index];
    if (slot.frameNumber != frameNumber || !slot.ended) return false;
    GpuCounters c;
    GpuEvaluateHead head;
    std::memcpy(&c, slot.readback.mapped, sizeof(c));
    std::memcpy(&head, static_cast<const std::byte*>(slot.readback.mapped) + sizeof(c), sizeof(head));
    out = {};
    out.frameNumber = frameNumber;
    out.lights = slot.lights;
    out.listEntries = c.listEntries;
    out.visibilitySlots = c.visibilitySlots;
    out.listOverflowTiles = c.listOverflowTiles;
    out.slotOverflowEntries = c.slotOverflowEntries;
    out.accurateExceedsApproximate = c.accurateExceedsApproximate;
    out.evaluateTiles = head.tileCount;
    out.recommendedListEntries = recommend(c.listEntries);
    if (state.context->desc.listReservation == ListReservation::Fixed) {
        out.listEntries = slot.tiles * roundUpToEarlyWord(state.context->desc.fixedListEntriesPerTile);
        out.recommendedListEntries = out.listEntries;
    }
    // Tiles without list space asked for no slot; their casting lights may need one each.
    const bool asked = c.listOverflowTiles == 0 || !state.desc.statistics;
    out.recommendedVisibilitySlots = recommend(asked ? c.visibilitySlots : c.earlyCastingEntries);
    out.tilesWithGeometry = c.tilesWithGeometry;
    out.approximateEntries = c.approximateEntries;
    out.earlyEntries = c.earlyEntries;
    out.earlyCastingEntries = c.earlyCastingEntries;
    out.finalEntries = c.finalEntries;
    out.finalSlotEntries = c.finalSlotEntries;
    out.maxLightsInTile = c.maxLightsInTile;
    out.prepareMilliseconds = slot.prepareMilliseconds;
    readTimes(state, slot, index, out);
    return true;
}

}  // namespace gnomon
