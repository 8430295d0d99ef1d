#pragma once
// What a View holds.

#include <vector>

#include "context.h"
#include "gpu_interface/numbers.h"
#include "gpu_interface/structs.h"
#include "shadow_bounds/cells.h"

namespace gnomon {

inline constexpr std::uint32_t kMaxFramesInFlight = 4;

// One buffer of the set of the lists, declared once: its row in the memory table, descriptor and allocation follow.
struct BufferDecl {
    const char* name;
    std::uint32_t binding;
    bool perFrame;  // written by the host: mapped, one copy per frame in flight
};

// Pool sizes after capping, and the bytes of every buffer.
struct ViewSizes {
    std::uint32_t tilesX = 0, tilesY = 0;
    std::uint32_t listEntries = 0, visibilitySlots = 0;
    bool poolsCapped = false;
    std::uint32_t boundsCells = 0;
    VkDeviceSize bytes[gpu::kListsBindingCount] = {};  // by binding
};

// Images and buffers of one frame in flight.
struct FrameSlot {
    std::uint64_t frameNumber = ~0ull;
    bool ended = false;                              // recordEndFrame() was called
    DeviceBuffer streamed[gpu::kListsBindingCount];  // those that are per frame, by binding
    DeviceBuffer shadowViews;
    DeviceBuffer boundsCells;
    std::uint32_t boundsCellCount = 0;  // to be made in this frame
    DeviceBuffer readback;              // GpuCounters, GpuEvaluateHead
    VkDescriptorSet lists = VK_NULL_HANDLE;
    VkDescriptorSet receivers = VK_NULL_HANDLE;
    VkDescriptorSet shadowmaps = VK_NULL_HANDLE;
    PrepareReport lights;
    double prepareMilliseconds = 0.0;
    std::uint32_t passBits = 0;  // passes recorded, by PassId
    std::uint32_t tiles = 0;
};

struct View::State {
    const Context::State* context = nullptr;
    ViewDesc desc;
    ViewSizes sizes;
    MemoryReport memory;
    std::unique_ptr<Prepare> prepare;
    DeviceBuffer device[gpu::kListsBindingCount];  // those that are not per frame, by binding
    DeviceBuffer shadowBounds;
    ShadowBoundsCells boundsCells;
    DeviceImage noFaceNormals;  // stand in for what the host does not have
    DeviceImage noAtlas;
    VkDescriptorPool descriptors = VK_NULL_HANDLE;
    VkQueryPool queries = VK_NULL_HANDLE;
    FrameSlot slots[kMaxFramesInFlight];
    std::uint32_t current = 0;
    gpu::GpuFrame frame = {};
    BufferBits pendingWrites = 0, pendingReads = 0;  // accesses since the last barrier

    ~State();
};

}  // namespace gnomon
