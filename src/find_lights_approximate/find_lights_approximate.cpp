#include "find_lights_approximate/find_lights_approximate.h"

#include "gpu_interface/numbers.h"

namespace gnomon {
namespace {

using namespace gpu;

constexpr std::uint32_t kSpirv[] = {
#include "find_lights_approximate.spv.h"
};
constexpr PassResource kResources[] = {
    {kSetLists, kBindFrame, Access::Uniform},
    {kSetLists, kBindLights, Access::Streamed},
    {kSetLists, kBindZBins, Access::Streamed},
    {kSetLists, kBindTileLightMasks, Access::Streamed},
    {kSetLists, kBindTileGroupLightMasks, Access::Write},
    {kSetLists, kBindTileDepthRanges, Access::Read},
    {kSetLists, kBindTileLightSlotIds, Access::Write},
    {kSetLists, kBindEarlyList, Access::Write},
    {kSetLists, kBindEarlyCounts, Access::Write},
    {kSetLists, kBindFinalCounts, Access::Write},
    {kSetLists, kBindEvaluateTiles, Access::Write},
    {kSetWorking, kBindCounters, Access::Write},
    {kSetWorking, kBindTileDepthSlices, Access::Read},
    {kSetWorking, kBindApproximateCounts, Access::Write},
    {kSetWorking, kBindListTiles, Access::Write},
    {kSetWorking, kBindPairQueues, Access::Write},
};
constexpr std::uint32_t kSpecialization[] = {kSpecSubgroupSize, kSpecListReservation, kSpecLightLists};
constexpr Pass kPass = {"find_lights_approximate", Phase::FindLightsApproximate, kSpirv, kResources, kSpecialization};

}  // namespace

const Pass& findLightsApproximatePass() noexcept {
    return kPass;
}

}  // namespace gnomon
