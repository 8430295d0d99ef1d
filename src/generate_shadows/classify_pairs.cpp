#include "generate_shadows/classify_pairs.h"

#include "gpu_interface/numbers.h"

namespace gnomon {
namespace {

using namespace gpu;

constexpr std::uint32_t kSpirv[] = {
#include "classify_pairs.spv.h"
};
constexpr PassResource kResources[] = {
    {kSetLists, kBindFrame, Access::Uniform},         {kSetLists, kBindLights, Access::Streamed},
    {kSetLists, kBindTileLightSlotIds, Access::Read}, {kSetLists, kBindEarlyList, Access::Read},
    {kSetLists, kBindEarlyCounts, Access::Read},      {kSetLists, kBindFinalList, Access::Write},
    {kSetLists, kBindFinalCounts, Access::Write},     {kSetLists, kBindEvaluateTiles, Access::Write},
    {kSetWorking, kBindCounters, Access::Write},      {kSetWorking, kBindListTiles, Access::Read},
    {kSetWorking, kBindPairQueues, Access::Write},    {kSetWorking, kBindPairQueues, Access::Indirect},
    {kSetWorking, kBindQueuedPairs, Access::Write},
};
constexpr std::uint32_t kSpecialization[] = {kSpecSubgroupSize, kSpecFilters};
constexpr Pass kPass = {"classify_pairs", Phase::GenerateShadows, kSpirv, kResources, kSpecialization};

}  // namespace

const Pass& classifyPairsPass() noexcept {
    return kPass;
}

}  // namespace gnomon
