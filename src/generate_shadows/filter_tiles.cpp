#include "generate_shadows/filter_tiles.h"

#include "generate_shadows/evaluation_resources.h"
#include "gpu_interface/numbers.h"

namespace gnomon {
namespace {

using namespace gpu;

constexpr std::uint32_t kSpirv[] = {
#include "filter_tiles.spv.h"
};
constexpr auto kResources = withEvaluationResources({
    {kSetLists, kBindTileLightSlotIds, Access::Read},
    {kSetLists, kBindEarlyCounts, Access::Read},
});
constexpr std::uint32_t kSpecialization[] = {kSpecSubgroupSize, kSpecFilters,         kSpecPcfRadius,
                                             kSpecPcssPresets,  kSpecVisibilityBits,  kSpecShadowAtlases,
                                             kSpecDepthBias,    kSpecFacedAwayIsDark, kSpecShadowViews};
constexpr Pass kPass = {"filter_tiles", Phase::GenerateShadows, kSpirv, kResources, kSpecialization};

}  // namespace

const Pass& filterTilesPass() noexcept {
    return kPass;
}

}  // namespace gnomon
