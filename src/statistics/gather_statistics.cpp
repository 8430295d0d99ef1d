#include "statistics/gather_statistics.h"

#include "gpu_interface/numbers.h"

namespace gnomon {
namespace {

using namespace gpu;

constexpr std::uint32_t kSpirv[] = {
#include "gather_statistics.spv.h"
};
constexpr PassResource kResources[] = {
    {kSetLists, kBindFrame, Access::Uniform},         {kSetLists, kBindTileDepthRanges, Access::Read},
    {kSetLists, kBindTileLightSlotIds, Access::Read}, {kSetLists, kBindEarlyCounts, Access::Read},
    {kSetLists, kBindFinalList, Access::Read},        {kSetLists, kBindFinalCounts, Access::Read},
    {kSetWorking, kBindCounters, Access::Write},      {kSetWorking, kBindApproximateCounts, Access::Read},
};
constexpr std::uint32_t kSpecialization[] = {kSpecSubgroupSize};
constexpr Pass kPass = {"gather_statistics", Phase::Statistics, kSpirv, kResources, kSpecialization};

}  // namespace

const Pass& gatherStatisticsPass() noexcept {
    return kPass;
}

}  // namespace gnomon
