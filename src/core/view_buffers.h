#pragma once
// The buffers of a view: one table, from which memory report, allocation and descriptors follow.

#include <span>
#include <vector>

#include "gnomon/view.h"
#include "gpu_interface/numbers.h"
#include "vulkan/resources.h"

namespace gnomon {

inline constexpr std::uint32_t kMaxFramesInFlight = 4;

enum class BufferKind : std::uint8_t {
    Device,    // one per view
    Streamed,  // written by the host, one per frame in flight
    Readback,  // read by the host, one per frame in flight; in no set
};

struct ViewBuffer {
    const char* name;
    BufferKind kind;
    std::uint32_t set, binding;
};

// By this index everywhere below.
enum ViewBufferId : std::uint32_t {
    kBufferFrame,
    kBufferLights,
    kBufferZBins,
    kBufferTileLightMasks,
    kBufferTileGroupLightMasks,
    kBufferTileDepthRanges,
    kBufferTileDepthSlices,
    kBufferTileLightSlotIds,
    kBufferApproximateCounts,
    kBufferEarlyList,
    kBufferEarlyCounts,
    kBufferFinalList,
    kBufferFinalCounts,
    kBufferVisibility,
    kBufferEvaluateTiles,
    kBufferCounters,
    kBufferListTiles,
    kBufferPairQueues,
    kBufferQueuedPairs,
    kBufferShadowViews,
    kBufferShadowBounds,
    kBufferShadowBoundsCells,
    kBufferReadback,
    kViewBufferCount,
};
std::span<const ViewBuffer, kViewBufferCount> viewBuffers() noexcept;

// Pool sizes after capping, and the bytes of every buffer.
struct ViewSizes {
    std::uint32_t listEntries = 0, visibilitySlots = 0;  // slots of ViewDesc::visibilityBits
    bool poolsCapped = false;
    std::uint32_t boundsCells = 0;
    VkDeviceSize bytes[kViewBufferCount] = {};
};

Result checkViewDesc(const ViewDesc& desc) noexcept;
ViewSizes viewSizesOf(const DeviceContext& device, const ViewDesc& desc) noexcept;
// Throws std::bad_alloc.
MemoryReport memoryReportOf(const ViewDesc& desc, const ViewSizes& sizes);

// The buffers themselves, and those that frames in flight may still use although larger ones have taken their place.
struct ViewBuffers {
    DeviceBuffer device[kViewBufferCount];                        // of kind Device
    DeviceBuffer perFrame[kMaxFramesInFlight][kViewBufferCount];  // of the other kinds
    std::uint32_t generation = 0;                                 // grows when a buffer is made

    // Makes those whose size is another than that of `before`. The old ones are kept until
    // release(lastFrame + framesInFlight). On failure the buffers are as they were. Throws std::bad_alloc.
    Result make(const DeviceContext& context, const ViewDesc& desc, const ViewSizes& before, const ViewSizes& sizes,
                std::uint64_t lastFrame);
    // Frees what no frame from `frame` - framesInFlight on can use.
    void release(const DeviceContext& context, std::uint64_t frame, std::uint32_t framesInFlight) noexcept;
    void destroy(const DeviceContext& context) noexcept;

    [[nodiscard]] const DeviceBuffer& of(ViewBufferId id, std::uint32_t copy) const noexcept {
        return viewBuffers()[id].kind == BufferKind::Device ? device[id] : perFrame[copy][id];
    }

private:
    struct Retired {
        DeviceBuffer buffer;
        std::uint64_t lastFrame;
    };
    std::vector<Retired> retired_;
};

}  // namespace gnomon
