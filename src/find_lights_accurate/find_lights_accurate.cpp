#include "find_lights_accurate/find_lights_accurate.h"

#include "gpu_interface/numbers.h"

namespace gnomon {
namespace {

using namespace gpu;

constexpr std::uint32_t kSpirv[] = {
#include "find_lights_accurate.spv.h"
};
constexpr PassResource kResources[] = {
    {kSetLists, kBindFrame, Access::Uniform},
    {kSetLists, kBindLights, Access::Streamed},
    {kSetLists, kBindZBins, Access::Streamed},
    {kSetLists, kBindTileLightMasks, Access::Streamed},
    {kSetLists, kBindTileGroupLightMasks, Access::Read},
    {kSetLists, kBindTileDepthRanges, Access::Read},
    {kSetLists, kBindTileLightSlotIds, Access::Write},
    {kSetLists, kBindEarlyList, Access::Write},
    {kSetLists, kBindEarlyCounts, Access::Write},
    {kSetLists, kBindFinalCounts, Access::Write},
    {kSetLists, kBindEvaluateTiles, Access::Write},
    {kSetReceivers, kBindDepth, Access::Sampled},
    {kSetReceivers, kBindFaceNormals, Access::Sampled},
    {kSetReceivers, kBindReceiverFlags, Access::Sampled},
    {kSetWorking, kBindCounters, Access::Write},
    {kSetWorking, kBindApproximateCounts, Access::Read},
    {kSetWorking, kBindTileDepthSlices, Access::Read},
    {kSetWorking, kBindListTiles, Access::Write},
    {kSetWorking, kBindPairQueues, Access::Write},
};
constexpr std::uint32_t kSpecialization[] = {kSpecSubgroupSize, kSpecListReservation, kSpecDepthBias,
                                             kSpecFacedAwayIsDark};
constexpr Pass kPass = {"find_lights_accurate", Phase::FindLightsAccurate, kSpirv, kResources, kSpecialization};

}  // namespace

const Pass& findLightsAccuratePass() noexcept {
    return kPass;
}

}  // namespace gnomon
