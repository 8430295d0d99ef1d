#pragma once
// All passes of a view, in the order of the paper's figure 1. Each declares itself in its own room.

#include <cstdint>
#include <iterator>

#include "find_lights_accurate/find_lights_accurate.h"
#include "find_lights_approximate/find_lights_approximate.h"
#include "generate_shadows/classify_pairs.h"
#include "generate_shadows/filter_pairs.h"
#include "generate_shadows/filter_tiles.h"
#include "generate_shadows/search_pairs.h"
#include "hierarchical_depth/hierarchical_depth.h"
#include "shadow_bounds/shadow_bounds.h"
#include "statistics/gather_statistics.h"

namespace gnomon {

enum PassId : std::uint32_t {
    kPassHierarchicalDepth,
    kPassFindLightsApproximate,
    kPassFindLightsAccurate,
    kPassShadowBounds,
    kPassFilterTiles,
    kPassClassifyPairs,
    kPassSearchPairs,
    kPassFilterPairs,
    kPassGatherStatistics,
    kPassCount,
};

using PassDeclaration = const Pass& (*)() noexcept;
inline constexpr PassDeclaration kPasses[] = {
    hierarchicalDepthPass, findLightsApproximatePass, findLightsAccuratePass, shadowBoundsPass,     filterTilesPass,
    classifyPairsPass,     searchPairsPass,           filterPairsPass,        gatherStatisticsPass,
};
static_assert(std::size(kPasses) == kPassCount);

inline const Pass& passOf(PassId id) noexcept {
    return kPasses[id]();
}

}  // namespace gnomon
