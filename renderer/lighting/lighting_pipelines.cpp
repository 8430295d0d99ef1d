#include "renderer/lighting/lighting_pipelines.h"

#include <algorithm>
#include <vector>

#include "gpu_interface/numbers.h"

namespace gnomon::renderer {
namespace {

constexpr std::uint32_t kDeferredSpirv[] = {
#include "lighting_deferred.spv.h"
};
constexpr std::uint32_t kEvaluateSpirv[] = {
#include "lighting_evaluate.spv.h"
};
constexpr std::uint32_t kInlineSpirv[] = {
#include "lighting_inline.spv.h"
};

}  // namespace

LightingPipelines::LightingPipelines(const Device& device, const Context& context, const InlineVariant& inlineVariant)
    : ownSet(makeSetLayout(device, kLightingSetTypes, VK_SHADER_STAGE_COMPUTE_BIT)),
      emptySet(makeSetLayout(device, {}, VK_SHADER_STAGE_COMPUTE_BIT)) {
    const VkDescriptorSetLayout main[] = {context.listsSetLayout(), context.receiversSetLayout(), emptySet, ownSet};
    const VkDescriptorSetLayout withShadowmaps[] = {context.listsSetLayout(), context.receiversSetLayout(),
                                                    context.shadowmapsSetLayout(), ownSet};
    mainLayout = makePipelineLayout(device, main);
    evaluateLayout = makePipelineLayout(device, withShadowmaps);
    std::vector<std::uint32_t> constants(gpu::kSpecFirstFree + 2, 0u);
    std::ranges::copy(context.specializationValues(), constants.begin());
    constants[gpu::kSpecFirstFree] = inlineVariant.quantises ? 1u : 0u;
    constants[gpu::kSpecFirstFree + 1] = inlineVariant.walksMasks ? 1u : 0u;
    // A device with one size need not, and perhaps cannot, be asked for it.
    const bool oneSize = device.info().minSubgroupSize == device.info().maxSubgroupSize;
    const std::uint32_t lanes = oneSize ? 0 : context.subgroupSize();
    deferred = makeComputePipeline(device, kDeferredSpirv, mainLayout, constants, lanes);
    evaluate = makeComputePipeline(device, kEvaluateSpirv, evaluateLayout, constants, lanes);
    inlined = makeComputePipeline(device, kInlineSpirv, evaluateLayout, constants, lanes);
    constants[gpu::kSpecProvider] = gpu::kProviderOff;
    unshadowed = makeComputePipeline(device, kInlineSpirv, evaluateLayout, constants, lanes);
}

}  // namespace gnomon::renderer
