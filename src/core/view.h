#pragma once
// What a View holds.

#include "core/context.h"
#include "core/view_buffers.h"
#include "gnomon/view.h"
#include "gpu_interface/structs.h"
#include "shadow_bounds/cells.h"
#include "vulkan/recorder.h"

namespace gnomon {

// One frame in flight.
struct FrameInFlight {
    std::uint64_t frameNumber = ~0ull;
    bool ended = false;                 // recordEndFrame() was called
    std::uint32_t boundsCellCount = 0;  // to be made in this frame
    VkDescriptorSet sets[gpu::kSetCount] = {};
    std::uint32_t setsGeneration = ~0u;  // of the buffers that the sets name
    PrepareReport lights;
    double prepareMilliseconds = 0.0;
    bool generated = false;  // phase 4 was recorded
    std::uint32_t tiles = 0;
    ShadowSettings settings;
    std::uint32_t listCapacity = 0, slotCapacity = 0;
};

struct GNOMON_HIDDEN View::State {
    Context::State* context = nullptr;
    ViewDesc desc;   // as it is, with pools that have grown
    ViewDesc asked;  // as the host asked for it last
    ViewSizes sizes;
    MemoryReport memory;
    std::unique_ptr<Prepare> prepare;
    PreparedLights prepared;
    bool isPrepared = false;  // and not yet taken by a frame
    double prepareMilliseconds = 0.0;
    ViewBuffers buffers;
    ShadowBoundsCells boundsCells;
    DeviceImage noFaceNormals;  // stand in for what the host does not have
    DeviceImage noAtlas;
    VkDescriptorPool descriptors = VK_NULL_HANDLE;
    FrameInFlight frames[kMaxFramesInFlight];
    std::uint32_t current = 0;
    std::uint64_t lastFrame = 0;   // begun last
    bool anyFrame = false;         // was begun
    bool growthFailed = false;     // there was no memory for larger pools; not tried again before the next resize
    PassPipelines pipelines;       // of the frame begun last
    Timeline* timeline = nullptr;  // likewise
    gpu::GpuFrame frame = {};
    BarrierTracker tracker;
    BarrierTracker::Use uses[gpu::kSetCount][gpu::kListsBindingCount] = {};

    ~State();
    Result resize(const ViewDesc& to);  // throws std::bad_alloc
    [[nodiscard]] bool readCounters(std::uint64_t frameNumber, FrameStatistics& out) const noexcept;
};

}  // namespace gnomon
