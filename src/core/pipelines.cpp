#include "core/pipelines.h"

#include <bit>
#include <utility>

#include "core/settings.h"

namespace gnomon {
namespace {

using namespace gpu;

// Whether a frame of these settings records a pass that is made once.
bool isRecorded(PassId pass, const Specialization& settings) {
    switch (pass) {
        case kPassFindLightsAccurate:
            return settings.lightLists == kListsByPixel;
        // Lights without shadows belong to the tiles if anything does: see filters.glsl.
        case kPassFilterTiles:
            return settings.filters == 0 || (settings.filters & kFiltersByTile) != 0;
        case kPassClassifyPairs:
            return (settings.filters & ~kFiltersByTile) != 0;
        case kPassSearchPairs:
        case kPassFilterPairs:
            return false;  // made once per queue
        default:
            return true;
    }
}

// What a pass with these filters alone is told. What none of them asks is the same for all settings. So it tells no
// pipelines apart.
Specialization withFilters(Specialization values, FilterSet filters) {
    values.filters = filters;
    const bool host = (filters & 1u << kFilterHost) != 0;  // whose code may ask anything
    if (!host && (filters & 1u << kFilterPcf) == 0) values.pcfRadius = 1;
    if (!host && (filters & (1u << kFilterPcss | 1u << kFilterPcssShared)) == 0) values.pcssPresets = 1;
    return values;
}

}  // namespace

void Pipelines::create(const DeviceContext& device, Desc desc) {
    device_ = &device;
    desc_ = std::move(desc);
}

void Pipelines::destroy() noexcept {
    for (const Entry& entry : entries_) device_->vk.DestroyPipeline(device_->device, entry.pipeline, nullptr);
    entries_.clear();
}

std::uint32_t Pipelines::count() const noexcept {
    const std::scoped_lock lock(mutex_);
    return static_cast<std::uint32_t>(entries_.size());
}

VkPipeline Pipelines::find(PassId pass, const Values& values) const noexcept {
    const std::scoped_lock lock(mutex_);
    for (const Entry& entry : entries_)
        if (entry.pass == pass && entry.values == values) return entry.pipeline;
    return VK_NULL_HANDLE;
}

// `all`: values of all constants, of which the pass may not have some.
Result Pipelines::getOne(PassId pass, const Values& all, VkPipeline& out) {
    Values values = {};
    for (const std::uint32_t id : passOf(pass).specialization) values[id] = all[id];
    out = find(pass, values);
    if (out != VK_NULL_HANDLE) return {};
    VkPipeline made = VK_NULL_HANDLE;
    if (Result result = make(pass, values, made); !result) return result;
    // Another thread may have made the same one meanwhile: the first one stays.
    const std::scoped_lock lock(mutex_);
    for (const Entry& entry : entries_)
        if (entry.pass == pass && entry.values == values) out = entry.pipeline;
    if (out != VK_NULL_HANDLE) {
        device_->vk.DestroyPipeline(device_->device, made, nullptr);
        return {};
    }
    try {
        entries_.push_back({pass, values, made});
    } catch (...) {
        device_->vk.DestroyPipeline(device_->device, made, nullptr);
        throw;
    }
    out = made;
    return {};
}

Result Pipelines::get(const Specialization& settings, QueueSet queues, PassPipelines& out) {
    out = {};
    for (std::uint32_t i = 0; i < kPassCount; ++i) {
        const auto pass = static_cast<PassId>(i);
        if (!isRecorded(pass, settings)) continue;
        const FilterSet filters = pass == kPassFilterTiles ? settings.filters & kFiltersByTile : settings.filters;
        const auto values = std::bit_cast<Values>(withFilters(settings, filters));
        if (Result got = getOne(pass, values, out.once[i]); !got) return got;
    }
    for (std::uint32_t queue = 0; queue < kPairQueueCount; ++queue) {
        if ((queues >> queue & 1u) == 0) continue;
        Specialization own = withFilters(settings, 1u << queue / kShadowViewsKinds);
        own.shadowViews = queue % kShadowViewsKinds + 1;
        const auto values = std::bit_cast<Values>(own);
        if (Result got = getOne(kPassFilterPairs, values, out.filterPairs[queue]); !got) return got;
        if (queue / kShadowViewsKinds != kFilterPcssShared) continue;
        if (Result got = getOne(kPassSearchPairs, values, out.searchPairs[queue]); !got) return got;
    }
    return {};
}

Result Pipelines::make(PassId id, const Values& values, VkPipeline& out) const {
    const Functions& vk = device_->vk;
    const Pass& pass = passOf(id);
    std::span<const std::uint32_t> spirv = pass.spirv;
    if (id == kPassFilterPairs && values[gpu::kSpecFilters] == 1u << gpu::kFilterHost) spirv = desc_.filterPairsSpirv;
    VkShaderModuleCreateInfo module = {VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    module.codeSize = spirv.size_bytes();
    module.pCode = spirv.data();
    VkShaderModule shader = VK_NULL_HANDLE;
    VkResult result = vk.CreateShaderModule(device_->device, &module, nullptr, &shader);
    if (result != VK_SUCCESS) return vulkanFailure(result, "vkCreateShaderModule");

    VkSpecializationMapEntry entries[gpu::kSpecCount] = {};
    std::uint32_t count = 0;
    for (const std::uint32_t constant : pass.specialization) entries[count++] = {constant, constant * 4u, 4u};
    const VkSpecializationInfo specialization = {count, entries, sizeof(values), values.data()};
    VkPipelineShaderStageRequiredSubgroupSizeCreateInfo required = {
        VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO};
    required.requiredSubgroupSize = desc_.subgroupSize;
    VkComputePipelineCreateInfo info = {VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  desc_.requireSubgroupSize ? &required : nullptr,
                  VK_PIPELINE_SHADER_STAGE_CREATE_REQUIRE_FULL_SUBGROUPS_BIT,
                  VK_SHADER_STAGE_COMPUTE_BIT,
                  shader,
                  "main",
                  &specialization};
    info.layout = desc_.layout;
    result = vk.CreateComputePipelines(device_->device, desc_.cache, 1, &info, nullptr, &out);
    vk.DestroyShaderModule(device_->device, shader, nullptr);
    return result == VK_SUCCESS ? Result() : vulkanFailure(result, pass.name);
}

}  // namespace gnomon
