#include "passes.h"

namespace gnomon {
namespace {

using namespace gpu;

constexpr std::uint32_t kHierarchicalDepthSpirv[] = {
#include "hierarchical_depth.spv.h"
};
constexpr std::uint32_t kFindLightsApproximateSpirv[] = {
#include "find_lights_approximate.spv.h"
};
constexpr std::uint32_t kFindLightsAccurateSpirv[] = {
#include "find_lights_accurate.spv.h"
};
constexpr std::uint32_t kShadowBoundsSpirv[] = {
#include "shadow_bounds.spv.h"
};
constexpr std::uint32_t kGenerateShadowsSpirv[] = {
#include "generate_shadows.spv.h"
};
constexpr std::uint32_t kGatherStatisticsSpirv[] = {
#include "gather_statistics.spv.h"
};

// Buffers that the host writes (frame, lights, zBins, tile light masks) need no barrier: submission makes them visible.
constexpr Pass kPasses[kPassCount] = {
    {.name = "hierarchical_depth",
     .spirv = kHierarchicalDepthSpirv,
     .receivers = true,
     .shadowmaps = false,
     .reads = 0,
     .writes = bufferBit(kBindTileDepthRanges)},
    {.name = "find_lights_approximate",
     .spirv = kFindLightsApproximateSpirv,
     .receivers = false,
     .shadowmaps = false,
     .reads = bufferBit(kBindTileDepthRanges),
     .writes = bufferBit(kBindTileGroupLightMasks) | bufferBit(kBindTileLightSlotIds) |
               bufferBit(kBindApproximateCounts) | bufferBit(kBindCounters)},
    {.name = "find_lights_accurate",
     .spirv = kFindLightsAccurateSpirv,
     .receivers = true,
     .shadowmaps = false,
     .reads = bufferBit(kBindTileDepthRanges) | bufferBit(kBindTileGroupLightMasks) | bufferBit(kBindApproximateCounts),
     .writes = bufferBit(kBindTileLightSlotIds) | bufferBit(kBindEarlyList) | bufferBit(kBindEarlyCounts) |
               bufferBit(kBindCounters)},
    {.name = "shadow_bounds",
     .spirv = kShadowBoundsSpirv,
     .receivers = true,
     .shadowmaps = true,
     .reads = 0,
     .writes = kShadowBoundsBit},
    {.name = "generate_shadows",
     .spirv = kGenerateShadowsSpirv,
     .receivers = true,
     .shadowmaps = true,
     .reads =
         bufferBit(kBindTileLightSlotIds) | bufferBit(kBindEarlyList) | bufferBit(kBindEarlyCounts) | kShadowBoundsBit,
     .writes = bufferBit(kBindFinalList) | bufferBit(kBindFinalCounts) | bufferBit(kBindVisibility) |
               bufferBit(kBindEvaluateTiles) | bufferBit(kBindCounters)},
    {.name = "gather_statistics",
     .spirv = kGatherStatisticsSpirv,
     .receivers = false,
     .shadowmaps = false,
     .reads = bufferBit(kBindTileDepthRanges) | bufferBit(kBindApproximateCounts) | bufferBit(kBindEarlyCounts) |
              bufferBit(kBindFinalCounts) | bufferBit(kBindFinalList) | bufferBit(kBindTileLightSlotIds),
     .writes = bufferBit(kBindCounters)},
};

}  // namespace

const Pass& passOf(PassId id) noexcept {
    return kPasses[id];
}

}  // namespace gnomon
