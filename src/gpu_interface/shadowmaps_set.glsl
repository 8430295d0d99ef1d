// The set of the shadowmaps: the table of shadow views, the host's atlases, and their bounds. Only pipelines that
// evaluate shadows have it. The main lighting pipeline does not: that is where its registers are saved (paper, section
// 2).
#ifndef GNOMON_GPU_INTERFACE_SHADOWMAPS_SET_GLSL
#define GNOMON_GPU_INTERFACE_SHADOWMAPS_SET_GLSL

#extension GL_EXT_samplerless_texture_functions : require

#include "gpu_interface/numbers.h"
#include "gpu_interface/packing.h"
#include "gpu_interface/structs.h"

#ifndef GNOMON_SHADOWMAPS_SET
#define GNOMON_SHADOWMAPS_SET kSetShadowmaps
#endif

// Most hosts have one atlas: then nothing has to be chosen at every tap.
layout(constant_id = kSpecShadowAtlases) const uint kShadowAtlases = kMaxShadowAtlases;

layout(set = GNOMON_SHADOWMAPS_SET, binding = kBindShadowViews, std430) restrict readonly buffer ShadowViewsBlock {
    GpuShadowView shadowViews[];
};
// One binding each: arrays of images indexed at run time need features that software Vulkan lacks.
layout(set = GNOMON_SHADOWMAPS_SET, binding = kBindShadowAtlas0) uniform texture2DArray shadowAtlas0;
layout(set = GNOMON_SHADOWMAPS_SET, binding = kBindShadowAtlas0 + 1) uniform texture2DArray shadowAtlas1;
layout(set = GNOMON_SHADOWMAPS_SET, binding = kBindShadowAtlas0 + 2) uniform texture2DArray shadowAtlas2;
layout(set = GNOMON_SHADOWMAPS_SET, binding = kBindShadowAtlas0 + 3) uniform texture2DArray shadowAtlas3;
layout(set = GNOMON_SHADOWMAPS_SET, binding = kBindShadowSampler) uniform sampler shadowSampler;
// Least and greatest device depth of blocks of texels: see shadow_bounds/shadow_bounds.comp.
#ifdef GNOMON_SHADOW_BOUNDS_ACCESS
layout(set = GNOMON_SHADOWMAPS_SET, binding = kBindShadowBounds, std430) restrict writeonly buffer ShadowBoundsBlock {
    vec2 shadowBounds[];
};
#else
layout(set = GNOMON_SHADOWMAPS_SET, binding = kBindShadowBounds, std430) restrict readonly buffer ShadowBoundsBlock {
    vec2 shadowBounds[];
};
#endif

uint shadowBoundsIndex(uint first, uint row, uint blocks, uint level, uvec2 block) {
    return first + shadowBoundsLevelOffset(blocks, level) + block.y * (row >> level) + block.x;
}

#endif
