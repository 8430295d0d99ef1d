#pragma once
// What every pass that evaluates shadows binds: the lists, the receivers and the shadowmaps. Each adds what it has of
// its own.

#include <array>
#include <cstddef>

#include "gpu_interface/numbers.h"
#include "vulkan/pass.h"

namespace gnomon {

inline constexpr std::array<PassResource, 18> kEvaluationResources = {{
    {gpu::kSetLists, gpu::kBindFrame, Access::Uniform},
    {gpu::kSetLists, gpu::kBindLights, Access::Streamed},
    {gpu::kSetLists, gpu::kBindEarlyList, Access::Read},
    {gpu::kSetLists, gpu::kBindFinalList, Access::Write},
    {gpu::kSetLists, gpu::kBindFinalCounts, Access::Write},
    {gpu::kSetLists, gpu::kBindVisibility, Access::Write},
    {gpu::kSetLists, gpu::kBindEvaluateTiles, Access::Write},
    {gpu::kSetReceivers, gpu::kBindDepth, Access::Sampled},
    {gpu::kSetReceivers, gpu::kBindFaceNormals, Access::Sampled},
    {gpu::kSetReceivers, gpu::kBindReceiverFlags, Access::Sampled},
    {gpu::kSetShadowmaps, gpu::kBindShadowViews, Access::Streamed},
    {gpu::kSetShadowmaps, gpu::kBindShadowAtlas0, Access::Sampled},
    {gpu::kSetShadowmaps, gpu::kBindShadowAtlas0 + 1, Access::Sampled},
    {gpu::kSetShadowmaps, gpu::kBindShadowAtlas0 + 2, Access::Sampled},
    {gpu::kSetShadowmaps, gpu::kBindShadowAtlas0 + 3, Access::Sampled},
    {gpu::kSetShadowmaps, gpu::kBindShadowSampler, Access::Sampled},
    {gpu::kSetShadowmaps, gpu::kBindShadowBounds, Access::Read},
    {gpu::kSetWorking, gpu::kBindCounters, Access::Write},
}};

template <std::size_t kMore>
constexpr auto withEvaluationResources(const PassResource (&more)[kMore]) {
    std::array<PassResource, kEvaluationResources.size() + kMore> all = {};
    std::size_t count = 0;
    for (const PassResource& resource : kEvaluationResources) all[count++] = resource;
    for (const PassResource& resource : more) all[count++] = resource;
    return all;
}

}  // namespace gnomon
