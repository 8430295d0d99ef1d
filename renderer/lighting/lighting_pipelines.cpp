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
constexpr std::uint32_t kDeferredFloatSpirv[] = {
#include "lighting_deferred_float.spv.h"
};
constexpr std::uint32_t kEvaluateFloatSpirv[] = {
#include "lighting_evaluate_float.spv.h"
};
constexpr std::uint32_t kInlineFloatSpirv[] = {
#include "lighting_inline_float.spv.h"
};

// What a kind's shader does not look at is the same for all settings.
SpecializationValues valuesOf(LightingKind kind, const Context& context, const ShadowSettings& settings) {
    SpecializationValues out = context.specialization(settings);
    if (kind == LightingKind::Deferred) {
        const SpecializationValues all = out;
        out = {};
        for (const std::uint32_t id :
             {gpu::kSpecSubgroupSize, gpu::kSpecVisibilityBits, gpu::kSpecDepthBias, gpu::kSpecFacedAwayIsDark})
            out.values[id] = all.values[id];
    }
    if (kind == LightingKind::Unshadowed) out.values[gpu::kSpecFilters] = 0;
    return out;
}

std::span<const std::uint32_t> spirvOf(LightingKind kind, PictureFormat format) {
    using Spirv = std::span<const std::uint32_t>;
    const bool floats = format == PictureFormat::Float;
    switch (kind) {
        case LightingKind::Deferred:
            return floats ? Spirv(kDeferredFloatSpirv) : Spirv(kDeferredSpirv);
        case LightingKind::Evaluate:
            return floats ? Spirv(kEvaluateFloatSpirv) : Spirv(kEvaluateSpirv);
        case LightingKind::Inline:
        case LightingKind::Unshadowed:
            break;
    }
    return floats ? Spirv(kInlineFloatSpirv) : Spirv(kInlineSpirv);
}

}  // namespace

std::uint32_t requiredSubgroupSize(const Device& device, const Context& context) {
    const bool oneSize = device.info().minSubgroupSize == device.info().maxSubgroupSize;
    return oneSize ? 0 : context.subgroupSize();
}

LightingPipelines::LightingPipelines(const Device& device, const Context& context)
    : device_(device),
      context_(context),
      ownSet_(makeSetLayout(device, kLightingSetTypes, VK_SHADER_STAGE_COMPUTE_BIT)),
      emptySet_(makeSetLayout(device, {}, VK_SHADER_STAGE_COMPUTE_BIT)) {
    const VkDescriptorSetLayout main[] = {context.listsSetLayout(), context.receiversSetLayout(), emptySet_, ownSet_};
    const VkDescriptorSetLayout withShadowmaps[] = {context.listsSetLayout(), context.receiversSetLayout(),
                                                    context.shadowmapsSetLayout(), ownSet_};
    mainLayout_ = makePipelineLayout(device, main);
    evaluateLayout_ = makePipelineLayout(device, withShadowmaps);
}

VkPipeline LightingPipelines::get(LightingKind kind, const ShadowSettings& settings, const InlineVariant& variant,
                                  PictureFormat format) {
    std::vector<std::uint32_t> constants(gpu::kSpecFirstFree + 2, 0u);
    std::ranges::copy(valuesOf(kind, context_, settings).values, constants.begin());
    const bool inlined = kind == LightingKind::Inline || kind == LightingKind::Unshadowed;
    constants[gpu::kSpecFirstFree] = inlined && variant.quantises ? 1u : 0u;
    constants[gpu::kSpecFirstFree + 1] = inlined && variant.walksMasks ? 1u : 0u;
    Pipeline& pipeline = pipelines_[{kind, format, constants}];
    if (pipeline == VK_NULL_HANDLE)
        pipeline = makeComputePipeline(device_, spirvOf(kind, format), layoutOf(kind), constants,
                                       requiredSubgroupSize(device_, context_));
    return pipeline;
}

}  // namespace gnomon::renderer
