#include "generate_shadows/filter_pairs.h"

#include "gpu_interface/numbers.h"

namespace gnomon {
namespace {

using namespace gpu;

constexpr std::uint32_t kSpirv[] = {
#include "filter_pairs.spv.h"
};
constexpr PassResource kResources[] = {
    {kSetLists, kBindFrame, Access::Uniform},
    {kSetLists, kBindLights, Access::Streamed},
    {kSetLists, kBindEarlyList, Access::Read},
    {kSetLists, kBindFinalList, Access::Write},
    {kSetLists, kBindFinalCounts, Access::Write},
    {kSetLists, kBindVisibility, Access::Write},
    {kSetLists, kBindEvaluateTiles, Access::Write},
    {kSetReceivers, kBindDepth, Access::Sampled},
    {kSetReceivers, kBindFaceNormals, Access::Sampled},
    {kSetReceivers, kBindReceiverFlags, Access::Sampled},
    {kSetShadowmaps, kBindShadowViews, Access::Streamed},
    {kSetShadowmaps, kBindShadowAtlas0, Access::Sampled},
    {kSetShadowmaps, kBindShadowAtlas0 + 1, Access::Sampled},
    {kSetShadowmaps, kBindShadowAtlas0 + 2, Access::Sampled},
    {kSetShadowmaps, kBindShadowAtlas0 + 3, Access::Sampled},
    {kSetShadowmaps, kBindShadowSampler, Access::Sampled},
    {kSetShadowmaps, kBindShadowBounds, Access::Read},
    {kSetWorking, kBindCounters, Access::Write},
    {kSetWorking, kBindListTiles, Access::Read},
    {kSetWorking, kBindPairQueues, Access::Read},
    {kSetWorking, kBindPairQueues, Access::Indirect},
    {kSetWorking, kBindQueuedPairs, Access::Read},
};
constexpr std::uint32_t kSpecialization[] = {kSpecSubgroupSize, kSpecFilters,         kSpecPcfRadius,
                                             kSpecPcssPresets,  kSpecVisibilityBits,  kSpecShadowAtlases,
                                             kSpecDepthBias,    kSpecFacedAwayIsDark, kSpecShadowViews};
constexpr Pass kPass = {"filter_pairs", Phase::GenerateShadows, kSpirv, kResources, kSpecialization};

}  // namespace

const Pass& filterPairsPass() noexcept {
    return kPass;
}

}  // namespace gnomon
