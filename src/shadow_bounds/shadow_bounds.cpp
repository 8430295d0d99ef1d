#include "shadow_bounds/shadow_bounds.h"

#include "gpu_interface/numbers.h"

namespace gnomon {
namespace {

using namespace gpu;

constexpr std::uint32_t kSpirv[] = {
#include "shadow_bounds.spv.h"
};
constexpr PassResource kResources[] = {
    {kSetShadowmaps, kBindShadowAtlas0, Access::Sampled},     {kSetShadowmaps, kBindShadowAtlas0 + 1, Access::Sampled},
    {kSetShadowmaps, kBindShadowAtlas0 + 2, Access::Sampled}, {kSetShadowmaps, kBindShadowAtlas0 + 3, Access::Sampled},
    {kSetShadowmaps, kBindShadowSampler, Access::Sampled},    {kSetShadowmaps, kBindShadowBounds, Access::Write},
    {kSetWorking, kBindShadowBoundsCells, Access::Streamed},
};
constexpr std::uint32_t kSpecialization[] = {kSpecSubgroupSize, kSpecShadowAtlases};
constexpr Pass kPass = {"shadow_bounds", Phase::ShadowBounds, kSpirv, kResources, kSpecialization};

}  // namespace

const Pass& shadowBoundsPass() noexcept {
    return kPass;
}

}  // namespace gnomon
