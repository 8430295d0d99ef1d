#include "generate_shadows/filter_pairs.h"

#include "generate_shadows/evaluation_resources.h"
#include "gpu_interface/numbers.h"

namespace gnomon {
namespace {

using namespace gpu;

constexpr std::uint32_t kSpirv[] = {
#include "filter_pairs.spv.h"
};
constexpr auto kResources = withEvaluationResources({
    {kSetWorking, kBindListTiles, Access::Read},
    {kSetWorking, kBindPairQueues, Access::Read},
    {kSetWorking, kBindPairQueues, Access::Indirect},
    {kSetWorking, kBindQueuedPairs, Access::Read},
});
constexpr std::uint32_t kSpecialization[] = {kSpecSubgroupSize, kSpecFilters,         kSpecPcfRadius,
                                             kSpecPcssPresets,  kSpecVisibilityBits,  kSpecShadowAtlases,
                                             kSpecDepthBias,    kSpecFacedAwayIsDark, kSpecShadowViews};
constexpr Pass kPass = {"filter_pairs", Phase::GenerateShadows, kSpirv, kResources, kSpecialization};

}  // namespace

const Pass& filterPairsPass() noexcept {
    return kPass;
}

}  // namespace gnomon
