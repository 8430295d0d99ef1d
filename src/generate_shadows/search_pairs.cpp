#include "generate_shadows/search_pairs.h"

#include "generate_shadows/evaluation_resources.h"
#include "gpu_interface/numbers.h"

namespace gnomon {
namespace {

using namespace gpu;

constexpr std::uint32_t kSpirv[] = {
#include "search_pairs.spv.h"
};
constexpr auto kResources = withEvaluationResources({
    {kSetWorking, kBindListTiles, Access::Read},
    {kSetWorking, kBindPairQueues, Access::Write},
    {kSetWorking, kBindPairQueues, Access::Indirect},
    {kSetWorking, kBindQueuedPairs, Access::Write},
});
constexpr std::uint32_t kSpecialization[] = {kSpecSubgroupSize,    kSpecFilters,       kSpecPcssPresets,
                                             kSpecVisibilityBits,  kSpecShadowAtlases, kSpecDepthBias,
                                             kSpecFacedAwayIsDark, kSpecShadowViews};
constexpr Pass kPass = {"search_pairs", Phase::GenerateShadows, kSpirv, kResources, kSpecialization};

}  // namespace

const Pass& searchPairsPass() noexcept {
    return kPass;
}

}  // namespace gnomon
