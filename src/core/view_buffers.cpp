#include "core/view_buffers.h"

#include <algorithm>

#include "gpu_interface/packing.h"
#include "shadow_bounds/cells.h"

namespace gnomon {
namespace {

using namespace gpu;

constexpr std::uint32_t kNoSet = 0xFFFFFFFFu;
constexpr ViewBuffer kBuffers[kViewBufferCount] = {
    {"frame_constants", BufferKind::Streamed, kSetLists, kBindFrame},
    {"lights", BufferKind::Streamed, kSetLists, kBindLights},
    {"z_bins", BufferKind::Streamed, kSetLists, kBindZBins},
    {"tile_light_masks", BufferKind::Streamed, kSetLists, kBindTileLightMasks},
    {"tile_group_light_masks", BufferKind::Device, kSetLists, kBindTileGroupLightMasks},
    {"tile_depth_ranges", BufferKind::Device, kSetLists, kBindTileDepthRanges},
    {"tile_depth_slices", BufferKind::Device, kSetWorking, kBindTileDepthSlices},
    {"tile_light_slot_ids", BufferKind::Device, kSetLists, kBindTileLightSlotIds},
    {"approximate_counts", BufferKind::Device, kSetWorking, kBindApproximateCounts},
    {"early_light_list", BufferKind::Device, kSetLists, kBindEarlyList},
    {"early_counts", BufferKind::Device, kSetLists, kBindEarlyCounts},
    {"final_light_list", BufferKind::Device, kSetLists, kBindFinalList},
    {"final_counts", BufferKind::Device, kSetLists, kBindFinalCounts},
    {"visibility", BufferKind::Device, kSetLists, kBindVisibility},
    {"evaluate_tiles", BufferKind::Device, kSetLists, kBindEvaluateTiles},
    {"counters", BufferKind::Device, kSetWorking, kBindCounters},
    {"list_tiles", BufferKind::Device, kSetWorking, kBindListTiles},
    {"pair_queues", BufferKind::Device, kSetWorking, kBindPairQueues},
    {"queued_pairs", BufferKind::Device, kSetWorking, kBindQueuedPairs},
    {"shadow_views", BufferKind::Streamed, kSetShadowmaps, kBindShadowViews},
    {"shadow_bounds", BufferKind::Device, kSetShadowmaps, kBindShadowBounds},
    {"shadow_bounds_cells", BufferKind::Streamed, kSetWorking, kBindShadowBoundsCells},
    {"statistics_readback", BufferKind::Readback, kNoSet, 0},
};

Result makeBuffer(const DeviceContext& context, const ViewDesc& desc, ViewBufferId id, VkDeviceSize bytes,
                  DeviceBuffer& out) noexcept {
    const ViewBuffer& decl = kBuffers[id];
    switch (decl.kind) {
        case BufferKind::Device: {
            VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                       VK_BUFFER_USAGE_TRANSFER_DST_BIT;
            if (id == kBufferEvaluateTiles || id == kBufferPairQueues) usage |= VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
            return createBuffer(context, decl.name, bytes + 2 * VkDeviceSize(desc.guardBytes), usage, MemoryUse::Device,
                                out);
        }
        case BufferKind::Streamed: {
            const VkBufferUsageFlags usage =
                id == kBufferFrame ? VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT : VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
            return createBuffer(context, decl.name, bytes, usage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                MemoryUse::Streamed, out);
        }
        case BufferKind::Readback:
            break;
    }
    return createBuffer(context, decl.name, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::Readback, out);
}

}  // namespace

std::span<const ViewBuffer, kViewBufferCount> viewBuffers() noexcept {
    return kBuffers;
}

Result checkViewDesc(const ViewDesc& desc) noexcept {
    if (desc.maxWidthPx == 0 || desc.maxHeightPx == 0 || desc.maxWidthPx > kMaxExtentPx ||
        desc.maxHeightPx > kMaxExtentPx) {
        return Result::failure(Status::BadArgument, "A view of %ux%u pixels was asked for; 1x1 to %ux%u are possible.",
                               desc.maxWidthPx, desc.maxHeightPx, kMaxExtentPx, kMaxExtentPx);
    }
    const std::uint64_t tiles = std::uint64_t(divideRoundingUp(desc.maxWidthPx, kShadowTileSizePx)) *
                                divideRoundingUp(desc.maxHeightPx, kShadowTileSizePx);
    const std::uint64_t mostTiles = 0xFFFFFFFFu / roundUpToEarlyWord(kMaxLightsPerView);
    if (tiles > mostTiles) {
        return Result::failure(Status::BadArgument,
                               "A view of %ux%u pixels has %llu tiles of 8x8; list space can be counted for %llu.",
                               desc.maxWidthPx, desc.maxHeightPx, static_cast<unsigned long long>(tiles),
                               static_cast<unsigned long long>(mostTiles));
    }
    if (desc.framesInFlight == 0 || desc.framesInFlight > kMaxFramesInFlight) {
        return Result::failure(Status::BadArgument, "ViewDesc::framesInFlight is %u; it must be 1 to %u.",
                               desc.framesInFlight, kMaxFramesInFlight);
    }
    if (desc.maxShadowViews == 0 || desc.maxShadowViews > kMaxLightsPerView * kPointLightFaces) {
        return Result::failure(Status::BadArgument, "ViewDesc::maxShadowViews is %u; it must be 1 to %u.",
                               desc.maxShadowViews, kMaxLightsPerView * kPointLightFaces);
    }
    if (desc.visibilityBits != kMaxVisibilityBits && desc.visibilityBits != kMinVisibilityBits) {
        return Result::failure(Status::BadArgument, "ViewDesc::visibilityBits is %u; it must be 8 or 4.",
                               desc.visibilityBits);
    }
    if (desc.guardBytes % 256 != 0) {
        return Result::failure(Status::BadArgument, "ViewDesc::guardBytes is %u; it must be a multiple of 256.",
                               desc.guardBytes);
    }
    return {};
}

ViewSizes viewSizesOf(const DeviceContext& device, const ViewDesc& desc) noexcept {
    const VkDeviceSize slotBytes = visibilitySlotWords(desc.visibilityBits) * 4;
    ViewSizes s;
    const std::uint32_t tilesX = divideRoundingUp(desc.maxWidthPx, kShadowTileSizePx);
    const std::uint32_t tilesY = divideRoundingUp(desc.maxHeightPx, kShadowTileSizePx);
    const std::uint64_t tiles = std::uint64_t(tilesX) * tilesY;
    const std::uint64_t groups =
        std::uint64_t(divideRoundingUp(tilesX, kTileGroupSizeTiles)) * divideRoundingUp(tilesY, kTileGroupSizeTiles);
    const std::uint64_t largest = device.limits.maxStorageBufferRange;

    const std::uint64_t wantedEntries = desc.listEntries != 0 ? desc.listEntries : tiles * kDefaultListEntriesPerTile;
    const std::uint64_t wantedSlots =
        desc.visibilitySlots != 0 ? desc.visibilitySlots : tiles * kDefaultVisibilitySlotsPerTile;
    const std::uint64_t entries = std::min<std::uint64_t>({wantedEntries, largest / 8, kMostListEntries});
    const std::uint64_t slots = std::min<std::uint64_t>({wantedSlots, largest / slotBytes, kMaxVisibilitySlots});
    s.poolsCapped = entries < wantedEntries || slots < wantedSlots;
    // Whole early-list words: what is left of a pool of one or two entries cannot hold a list.
    s.listEntries = static_cast<std::uint32_t>(entries / kEarlyIndicesPerWord * kEarlyIndicesPerWord);
    s.visibilitySlots = static_cast<std::uint32_t>(slots);

    const PrepareSizes prepared = prepareSizes(desc.maxWidthPx, desc.maxHeightPx);
    s.bytes[kBufferFrame] = prepared.frameConstants;
    s.bytes[kBufferLights] = prepared.lights;
    s.bytes[kBufferZBins] = prepared.zBins;
    s.bytes[kBufferTileLightMasks] = prepared.tileLightMasks;
    s.bytes[kBufferTileGroupLightMasks] = groups * kLightMaskEntryWords * 4;
    s.bytes[kBufferTileDepthRanges] = tiles * 8;
    s.bytes[kBufferTileDepthSlices] = tiles * 4;
    s.bytes[kBufferTileLightSlotIds] = tiles * 4;
    s.bytes[kBufferApproximateCounts] = tiles * 4;
    s.bytes[kBufferEarlyList] = std::max<VkDeviceSize>(s.listEntries / kEarlyIndicesPerWord, 1) * 4;
    s.bytes[kBufferEarlyCounts] = tiles * 4;
    s.bytes[kBufferFinalList] = std::max<VkDeviceSize>(s.listEntries, 1) * 4;
    s.bytes[kBufferFinalCounts] = tiles * 4;
    s.bytes[kBufferVisibility] = s.visibilitySlots * slotBytes;
    s.bytes[kBufferEvaluateTiles] = sizeof(GpuEvaluateHead) + tiles * 4;
    s.bytes[kBufferCounters] = sizeof(GpuCounters);
    s.bytes[kBufferListTiles] = s.bytes[kBufferEarlyList];
    s.bytes[kBufferPairQueues] = sizeof(GpuPairHead);
    s.bytes[kBufferQueuedPairs] = 2 * s.bytes[kBufferFinalList];
    s.bytes[kBufferShadowViews] = VkDeviceSize(desc.maxShadowViews) * sizeof(GpuShadowView);
    // At least one cell, so that there is a buffer to bind.
    const std::uint64_t mostCells = largest / shadowBoundsBytes(1);
    const std::uint64_t cells = std::min<std::uint64_t>(shadowBoundsCellsFor(desc.shadowBoundsTexels), mostCells);
    s.boundsCells = std::max(static_cast<std::uint32_t>(cells), 1u);
    s.bytes[kBufferShadowBounds] = shadowBoundsBytes(s.boundsCells);
    s.bytes[kBufferShadowBoundsCells] = VkDeviceSize(s.boundsCells) * sizeof(GpuShadowBoundsCell);
    s.bytes[kBufferReadback] = sizeof(GpuCounters) + sizeof(GpuEvaluateHead);
    return s;
}

void MemoryReport::add(const BufferMemory& buffer, std::uint32_t copies) {
    buffers_.push_back(buffer);
    totalBytes += buffer.bytes * copies;
}

MemoryReport memoryReportOf(const ViewDesc& desc, const ViewSizes& sizes) {
    MemoryReport r;
    for (std::uint32_t id = 0; id < kViewBufferCount; ++id) {
        const bool perFrame = kBuffers[id].kind != BufferKind::Device;
        r.add({kBuffers[id].name, sizes.bytes[id], perFrame, perFrame}, perFrame ? desc.framesInFlight : 1u);
    }
    r.listEntries = sizes.listEntries;
    r.visibilitySlots = sizes.visibilitySlots;
    r.poolsCapped = sizes.poolsCapped;
    return r;
}

Result ViewBuffers::make(const DeviceContext& context, const ViewDesc& desc, const ViewSizes& before,
                         const ViewSizes& sizes, std::uint64_t lastFrame) {
    struct Made {
        DeviceBuffer* place;
        DeviceBuffer buffer;
    };
    std::vector<Made> made;
    made.reserve(std::size_t{kViewBufferCount} * kMaxFramesInFlight);
    retired_.reserve(retired_.size() + made.capacity());
    Result result;
    for (std::uint32_t i = 0; i < kViewBufferCount && result; ++i) {
        if (before.bytes[i] == sizes.bytes[i]) continue;
        const auto id = static_cast<ViewBufferId>(i);
        const std::uint32_t copies = kBuffers[i].kind == BufferKind::Device ? 1u : desc.framesInFlight;
        for (std::uint32_t copy = 0; copy < copies && result; ++copy) {
            made.push_back({kBuffers[i].kind == BufferKind::Device ? &device[i] : &perFrame[copy][i], {}});
            result = makeBuffer(context, desc, id, sizes.bytes[i], made.back().buffer);
        }
    }
    for (Made& m : made) {
        if (!result) {
            destroyBuffer(context, m.buffer);
            continue;
        }
        if (m.place->buffer != VK_NULL_HANDLE) retired_.push_back({*m.place, lastFrame});
        *m.place = m.buffer;
    }
    if (result) ++generation;
    return result;
}

void ViewBuffers::release(const DeviceContext& context, std::uint64_t frame, std::uint32_t framesInFlight) noexcept {
    std::erase_if(retired_, [&](Retired& r) {
        if (frame < r.lastFrame + framesInFlight) return false;
        destroyBuffer(context, r.buffer);
        return true;
    });
}

void ViewBuffers::destroy(const DeviceContext& context) noexcept {
    for (DeviceBuffer& buffer : device) destroyBuffer(context, buffer);
    for (auto& copy : perFrame)
        for (DeviceBuffer& buffer : copy) destroyBuffer(context, buffer);
    for (Retired& r : retired_) destroyBuffer(context, r.buffer);
    retired_.clear();
}

}  // namespace gnomon
