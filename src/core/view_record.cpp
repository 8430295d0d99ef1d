// View: records the passes. Barriers, labels and timeline rows follow from each pass's declaration.
#include <algorithm>
#include <cstddef>
#include <cstring>

#include "core/view.h"
#include "gpu_interface/packing.h"

namespace gnomon {
namespace {

using namespace gpu;

constexpr VkPipelineStageFlags2 kCompute = Recorder::kCompute;
constexpr VkAccessFlags2 kStorageAccess = Recorder::kStorage;

Recorder recorderOf(View::State& state, VkCommandBuffer commands) {
    return {state.context->device, commands, state.tracker, state.timeline};
}

std::array<BoundSet, kSetCount> setsOf(View::State& state) {
    std::array<BoundSet, kSetCount> sets;
    for (std::uint32_t set = 0; set < kSetCount; ++set)
        sets[set] = {state.frames[state.current].sets[set], state.uses[set]};
    return sets;
}

void recordPass(View::State& state, VkCommandBuffer commands, PassId id, std::span<const Dispatch> dispatches) {
    recorderOf(state, commands).dispatch(passOf(id), state.context->pipelineLayout, setsOf(state), dispatches);
}

void recordPass(View::State& state, VkCommandBuffer commands, PassId id, std::uint32_t x, std::uint32_t y) {
    const Dispatch dispatch = {.pipeline = state.pipelines.once[id], .x = x, .y = y};
    recordPass(state, commands, id, {&dispatch, 1});
}

// Where a member of GpuPairHead lies in its buffer.
VkDeviceSize pairHeadOffset(const View::State& state, std::size_t member) {
    return state.desc.guardBytes + member;
}

// One indirect dispatch for every queue that has a pipeline, with the command at `command` in GpuPairQueue. Queues
// share nothing but counters, so no barrier stands between them.
void recordQueues(View::State& state, VkCommandBuffer commands, PassId id,
                  const std::array<VkPipeline, kPairQueueCount>& pipelines, std::size_t command) {
    Dispatch dispatches[kPairQueueCount];
    std::size_t count = 0;
    for (std::uint32_t queue = 0; queue < kPairQueueCount; ++queue) {
        if (pipelines[queue] == VK_NULL_HANDLE) continue;
        Dispatch& dispatch = dispatches[count++];
        dispatch.pipeline = pipelines[queue];
        dispatch.indirect = state.buffers.device[kBufferPairQueues].buffer;
        dispatch.offset = pairHeadOffset(state, offsetof(GpuPairHead, queues) + queue * sizeof(GpuPairQueue) + command);
    }
    if (count != 0) recordPass(state, commands, id, {dispatches, count});
}

// Phase 4 of the filters that have queues.
void recordPairs(View::State& state, VkCommandBuffer commands) {
    Dispatch classify = {.pipeline = state.pipelines.once[kPassClassifyPairs]};
    classify.indirect = state.buffers.device[kBufferPairQueues].buffer;
    classify.offset = pairHeadOffset(state, offsetof(GpuPairHead, classifyGroupCountX));
    recordPass(state, commands, kPassClassifyPairs, {&classify, 1});
    recordQueues(state, commands, kPassSearchPairs, state.pipelines.searchPairs,
                 offsetof(GpuPairQueue, searchGroupCountX));
    recordQueues(state, commands, kPassFilterPairs, state.pipelines.filterPairs,
                 offsetof(GpuPairQueue, filterGroupCountX));
}

// Images that are bound but never read still need the layout that their descriptor names. This is recorded in every
// frame, since a host may drop a recorded frame without submitting it.
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

// Tells a frame's counters from those of others, and from memory that was never written.
std::uint32_t stampOf(std::uint64_t frameNumber) {
    return static_cast<std::uint32_t>(frameNumber) ^ 0x474E4F4Du;
}

// The frame's first commands: the last frame's reads end, counters and indirect commands start afresh.
void resetFrame(View::State& state, VkCommandBuffer commands) {
    const Functions& vk = state.context->device.vk;
    Recorder recorder = recorderOf(state, commands);
    preparePlaceholders(state, commands);
    // All commands, so that it may be recorded on a compute queue too; the host's lighting may read in any stage.
    recorder.barrier(VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                     kCompute | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, kStorageAccess | VK_ACCESS_2_TRANSFER_WRITE_BIT);
    GpuCounters counters = {};
    counters.frameStamp = stampOf(state.frames[state.current].frameNumber);
    GpuEvaluateHead head = {};
    head.groupCountZ = 1;
    GpuPairHead pairHead = {};
    pairHead.classifyGroupCountZ = 1;
    for (GpuPairQueue& queue : pairHead.queues) queue.searchGroupCountZ = queue.filterGroupCountZ = 1;
    const VkDeviceSize offset = state.desc.guardBytes;
    vk.CmdUpdateBuffer(commands, state.buffers.device[kBufferPairQueues].buffer, offset, sizeof(pairHead), &pairHead);
    vk.CmdUpdateBuffer(commands, state.buffers.device[kBufferCounters].buffer, offset, sizeof(counters), &counters);
    vk.CmdUpdateBuffer(commands, state.buffers.device[kBufferEvaluateTiles].buffer, offset, sizeof(head), &head);
    recorder.barrier(VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, kCompute, kStorageAccess);
}

// A frame without phase 4 has no final lists.
void clearFinalCounts(View::State& state, VkCommandBuffer commands) {
    const Functions& vk = state.context->device.vk;
    Recorder recorder = recorderOf(state, commands);
    recorder.barrier(VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, kStorageAccess, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                     VK_ACCESS_2_TRANSFER_WRITE_BIT);
    vk.CmdFillBuffer(commands, state.buffers.device[kBufferFinalCounts].buffer, state.desc.guardBytes,
                     state.sizes.bytes[kBufferFinalCounts], 0);
    GpuEvaluateHead head = {};
    head.groupCountZ = 1;
    vk.CmdUpdateBuffer(commands, state.buffers.device[kBufferEvaluateTiles].buffer, state.desc.guardBytes, sizeof(head),
                       &head);
    recorder.barrier(VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, kCompute, kStorageAccess);
}

// A pool that would have sufficed, with a tenth to spare: what a host may grow to between frames.
std::uint32_t recommend(std::uint32_t used) {
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(std::uint64_t(used) + used / 10 + 1, 0xFFFFFFFFu));
}

}  // namespace

void View::recordHierarchicalDepth(VkCommandBuffer commands) noexcept {
    State& state = *state_;
    resetFrame(state, commands);
    const GpuFrame& f = state.frame;
    // With the host's pyramid one lane per tile.
    uvec2 groups = {divideRoundingUp(f.tileCounts.x, kDepthTilesPerGroup), f.tileCounts.y};
    if (state.frames[state.current].settings.hostDepthPyramid) groups = f.tileGroupCounts;
    recordPass(state, commands, kPassHierarchicalDepth, groups.x, groups.y);
}

void View::recordFindLightsApproximate(VkCommandBuffer commands) noexcept {
    const GpuFrame& f = state_->frame;
    recordPass(*state_, commands, kPassFindLightsApproximate, f.tileGroupCounts.x, f.tileGroupCounts.y);
}

void View::recordFindLightsAccurate(VkCommandBuffer commands) noexcept {
    State& state = *state_;
    const GpuFrame& f = state.frame;
    if (state.pipelines.once[kPassFindLightsAccurate] != VK_NULL_HANDLE)
        recordPass(state, commands, kPassFindLightsAccurate, f.tileCounts.x, f.tileCounts.y);
    recorderOf(state, commands).publish();
}

void View::recordShadowBounds(VkCommandBuffer commands) noexcept {
    State& state = *state_;
    const std::uint32_t cells = state.frames[state.current].boundsCellCount;
    if (cells != 0) recordPass(state, commands, kPassShadowBounds, cells, 1);
    state.boundsCells.made();
    recorderOf(state, commands).publish();
}

void View::recordGenerateShadows(VkCommandBuffer commands) noexcept {
    State& state = *state_;
    if (state.pipelines.once[kPassFilterTiles] != VK_NULL_HANDLE)
        recordPass(state, commands, kPassFilterTiles, state.frame.tileCounts.x, state.frame.tileCounts.y);
    if (state.pipelines.once[kPassClassifyPairs] != VK_NULL_HANDLE) recordPairs(state, commands);
    state.frames[state.current].generated = true;
    recorderOf(state, commands).publish();
}
void View::recordEndFrame(VkCommandBuffer commands) noexcept {
    State& state = *state_;
    const Functions& vk = state.context->device.vk;
    FrameInFlight& inFlight = state.frames[state.current];
    if (!inFlight.generated) clearFinalCounts(state, commands);
    if (state.desc.statistics) {
        recordPass(state, commands, kPassGatherStatistics, divideRoundingUp(inFlight.tiles, kWorkGroupSize), 1);
    }
    Recorder recorder = recorderOf(state, commands);
    recorder.barrier(kCompute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                     VK_ACCESS_2_TRANSFER_READ_BIT);
    const VkDeviceSize from = state.desc.guardBytes;
    const VkBufferCopy counters = {from, 0, sizeof(GpuCounters)};
    const VkBufferCopy head = {from, sizeof(GpuCounters), sizeof(GpuEvaluateHead)};
    const VkBuffer readback = state.buffers.of(kBufferReadback, state.current).buffer;
    vk.CmdCopyBuffer(commands, state.buffers.device[kBufferCounters].buffer, readback, 1, &counters);
    vk.CmdCopyBuffer(commands, state.buffers.device[kBufferEvaluateTiles].buffer, readback, 1, &head);
    recorder.barrier(VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT,
                     VK_ACCESS_2_HOST_READ_BIT);
    inFlight.ended = true;
}

bool View::State::readCounters(std::uint64_t frameNumber, FrameStatistics& out) const noexcept {
    const auto index = static_cast<std::uint32_t>(frameNumber % desc.framesInFlight);
    const FrameInFlight& inFlight = frames[index];
    if (inFlight.frameNumber != frameNumber || !inFlight.ended) return false;
    const auto* mapped = static_cast<const std::byte*>(buffers.of(kBufferReadback, index).mapped);
    GpuCounters c;
    GpuEvaluateHead head;
    std::memcpy(&c, mapped, sizeof(c));
    std::memcpy(&head, mapped + sizeof(c), sizeof(head));
    if (c.frameStamp != stampOf(frameNumber)) return false;  // recorded, but never submitted
    out = {};
    out.frameNumber = frameNumber;
    out.lights = inFlight.lights;
    out.listCapacity = inFlight.listCapacity;
    out.slotCapacity = inFlight.slotCapacity;
    out.listEntries = c.listEntries;
    out.visibilitySlots = c.visibilitySlots;
    out.listOverflowTiles = c.listOverflowTiles;
    out.slotOverflowEntries = c.slotOverflowEntries;
    out.accurateExceedsApproximate = c.accurateExceedsApproximate;
    out.evaluateTiles = head.tileCount;
    out.recommendedListEntries = recommend(c.listEntries);
    if (inFlight.settings.listReservation == ListReservation::Fixed) {
        out.listEntries = inFlight.tiles * roundUpToEarlyWord(inFlight.settings.fixedListEntriesPerTile);
        out.recommendedListEntries = out.listEntries;
    }
    // Tiles without list space asked for no slot; their casting lights may need one each.
    const bool asked = c.listOverflowTiles == 0 || !desc.statistics;
    out.recommendedVisibilitySlots = recommend(asked ? c.visibilitySlots : c.earlyCastingEntries);
    out.tilesWithGeometry = c.tilesWithGeometry;
    out.approximateEntries = c.approximateEntries;
    out.earlyEntries = c.earlyEntries;
    out.earlyCastingEntries = c.earlyCastingEntries;
    out.finalEntries = c.finalEntries;
    out.finalSlotEntries = c.finalSlotEntries;
    out.maxLightsInTile = c.maxLightsInTile;
    out.prepareMilliseconds = inFlight.prepareMilliseconds;
    return true;
}

bool View::statistics(std::uint64_t frameNumber, FrameStatistics& out) const noexcept {
    return state_->readCounters(frameNumber, out);
}

}  // namespace gnomon
