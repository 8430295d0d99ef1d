#include "hierarchical_depth/hierarchical_depth.h"

#include "gpu_interface/numbers.h"

namespace gnomon {
namespace {

using namespace gpu;

constexpr std::uint32_t kSpirv[] = {
#include "hierarchical_depth.spv.h"
};
constexpr PassResource kResources[] = {
    {kSetLists, kBindFrame, Access::Uniform},
    {kSetLists, kBindTileDepthRanges, Access::Write},
    {kSetReceivers, kBindDepth, Access::Sampled},
    {kSetWorking, kBindTileDepthSlices, Access::Write},
    {kSetReceivers, kBindHostDepthPyramid, Access::Sampled},
};
constexpr std::uint32_t kSpecialization[] = {kSpecSubgroupSize, kSpecHostDepthPyramid};
constexpr Pass kPass = {"hierarchical_depth", Phase::HierarchicalDepth, kSpirv, kResources, kSpecialization};

}  // namespace

const Pass& hierarchicalDepthPass() noexcept {
    return kPass;
}

}  // namespace gnomon
