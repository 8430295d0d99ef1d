#pragma once
// The lighting pipelines and their layouts, apart from the images they work on: so they can also be made, and looked
// at, on a device that can only compile.

#include "gnomon/tiled_shadows.h"
#include "renderer/gpu/pipeline.h"

namespace gnomon::renderer {

/// The lighting passes' own set: see renderer/lighting/lighting_set.glsl.
inline constexpr VkDescriptorType kLightingSetTypes[] = {
    VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
    VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
    VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER};

/// How the inline pipeline is compiled.
struct InlineVariant {
    bool quantises = true;   ///< visibility has the bits of a slot
    bool walksMasks = true;  ///< tiles without list space are shaded too; costs registers
};

struct LightingPipelines {
    /// Throws GpuError.
    LightingPipelines(const Device& device, const Context& context, const InlineVariant& inlineVariant);

    SetLayout ownSet, emptySet;
    PipelineLayout mainLayout;      // without the set of the shadowmaps
    PipelineLayout evaluateLayout;  // with it
    Pipeline deferred;              // mainLayout; all others evaluateLayout
    Pipeline evaluate, inlined, unshadowed;
};

}  // namespace gnomon::renderer
