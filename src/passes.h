#pragma once
// The passes of the technique, each declared once. Name, shader, descriptor sets, and the buffers it reads and writes;
// barrier, debug label, timestamp, pipeline and statistics row follow from that.

#include <cstdint>
#include <span>

#include "gpu_interface/numbers.h"

namespace gnomon {

enum PassId : std::uint32_t {
    kPassHierarchicalDepth,
    kPassFindLightsApproximate,
    kPassFindLightsAccurate,
    kPassShadowBounds,
    kPassGenerateShadows,
    kPassGatherStatistics,
    kPassCount,
};

// A set of buffers: bit = binding in the set of the lists.
using BufferBits = std::uint32_t;
constexpr BufferBits bufferBit(std::uint32_t binding) {
    return 1u << binding;
}

// The shadow bounds, which are in the set of the shadowmaps.
constexpr BufferBits kShadowBoundsBit = 1u << 31;

struct Pass {
    const char* name;  // the shader's file name, the label in a capture, the row in every table
    std::span<const std::uint32_t> spirv;
    bool receivers;   // binds the set of the receivers
    bool shadowmaps;  // binds the set of the shadowmaps
    BufferBits reads;
    BufferBits writes;  // written, or read and written
};

const Pass& passOf(PassId id) noexcept;

}  // namespace gnomon
