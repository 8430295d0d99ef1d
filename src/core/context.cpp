// Context: checks the device and makes layouts.
#include "core/context.h"

#include <algorithm>
#include <bit>
#include <new>
#include <utility>

#include "core/settings.h"
#include "gpu_interface/numbers.h"

namespace gnomon {
namespace {

using namespace gpu;

Result checkDesc(const ContextDesc& desc) {
    if (desc.instance == VK_NULL_HANDLE || desc.physicalDevice == VK_NULL_HANDLE || desc.device == VK_NULL_HANDLE) {
        return Result::failure(Status::BadArgument, "ContextDesc needs an instance, a physical device and a device.");
    }
    if (desc.queueFamilies.empty() || desc.queueFamilies.size() > 8) {
        return Result::failure(Status::BadArgument, "ContextDesc::queueFamilies must name 1 to 8 queue families.");
    }
    if (desc.maxShadowAtlases < 1 || desc.maxShadowAtlases > kMaxShadowAtlases) {
        return Result::failure(Status::BadArgument, "ContextDesc::maxShadowAtlases is %u; it must be 1 to %u.",
                               desc.maxShadowAtlases, kMaxShadowAtlases);
    }
    return {};
}

// Lists (all but the frame's uniform buffer), shadow views and shadow bounds, working buffers.
constexpr std::uint32_t kStorageBuffersNeeded = kListsBindingCount - 1 + 2 + kWorkingBindingCount;

// The subgroup size that pipelines will ask for, checked against what the device can do.
// `require` says whether they may ask for it: a device that cannot be asked always runs its own size.
Result chooseSubgroupSize(const ContextDesc& desc, const Functions& vk, std::uint32_t& out, bool& require) {
    VkPhysicalDeviceVulkan13Properties v13 = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES};
    VkPhysicalDeviceVulkan11Properties v11 = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES, &v13};
    VkPhysicalDeviceProperties2 properties = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &v11};
    vk.GetPhysicalDeviceProperties2(desc.physicalDevice, &properties);
    if (properties.properties.apiVersion < VK_API_VERSION_1_3) {
        return Result::failure(Status::UnsupportedDevice, "Gnomon needs Vulkan 1.3; '%s' has %u.%u.",
                               properties.properties.deviceName, VK_API_VERSION_MAJOR(properties.properties.apiVersion),
                               VK_API_VERSION_MINOR(properties.properties.apiVersion));
    }
    constexpr VkSubgroupFeatureFlags kNeeded = VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT;
    if ((v11.subgroupSupportedOperations & kNeeded) != kNeeded ||
        (v11.subgroupSupportedStages & VK_SHADER_STAGE_COMPUTE_BIT) == 0) {
        return Result::failure(Status::UnsupportedDevice,
                               "'%s' lacks basic or arithmetic subgroup operations in compute shaders.",
                               properties.properties.deviceName);
    }
    const std::uint32_t storageBuffers = properties.properties.limits.maxPerStageDescriptorStorageBuffers;
    if (storageBuffers < kStorageBuffersNeeded) {
        return Result::failure(Status::UnsupportedDevice,
                               "'%s' allows %u storage buffers per shader stage; %u are needed.",
                               properties.properties.deviceName, storageBuffers, kStorageBuffersNeeded);
    }
    out = desc.subgroupSize != 0 ? desc.subgroupSize : std::min(v11.subgroupSize, kWorkGroupSize);
    require = (v13.requiredSubgroupSizeStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0;
    const bool powerOfTwo = (out & (out - 1)) == 0;
    if (!powerOfTwo || (!require && out != v11.subgroupSize) || out < v13.minSubgroupSize ||
        out > v13.maxSubgroupSize || out > kWorkGroupSize || out < 4) {
        return Result::failure(Status::UnsupportedDevice, "'%s' cannot run subgroups of %u lanes: it has %u to %u.",
                               properties.properties.deviceName, out, v13.minSubgroupSize, v13.maxSubgroupSize);
    }
    return {};
}

constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

Result createLayouts(Context::State& state) {
    const DeviceContext& device = state.device;
    VkSamplerCreateInfo sampler = {VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    sampler.addressModeU = sampler.addressModeV = sampler.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    VkResult result = device.vk.CreateSampler(device.device, &sampler, nullptr, &state.shadowSampler);
    if (result != VK_SUCCESS) return vulkanFailure(result, "vkCreateSampler");

    constexpr std::uint32_t kCounts[kSetCount] = {kListsBindingCount, kReceiversBindingCount, kShadowmapsBindingCount,
                                                  kWorkingBindingCount};
    for (std::uint32_t set = 0; set < kSetCount; ++set) {
        VkDescriptorSetLayoutBinding bindings[kListsBindingCount] = {};
        static_assert(kListsBindingCount >= kShadowmapsBindingCount && kListsBindingCount >= kReceiversBindingCount &&
                      kListsBindingCount >= kWorkingBindingCount);
        const bool images = set == kSetReceivers || set == kSetShadowmaps;
        for (std::uint32_t i = 0; i < kCounts[set]; ++i) {
            bindings[i] = {i, images ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, kStages,
                           nullptr};
        }
        if (set == kSetLists) bindings[kBindFrame].descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
        if (set == kSetShadowmaps) {
            bindings[kBindShadowViews].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
            bindings[kBindShadowBounds].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
            bindings[kBindShadowSampler].descriptorType = VK_DESCRIPTOR_TYPE_SAMPLER;
            bindings[kBindShadowSampler].pImmutableSamplers = &state.shadowSampler;
        }
        VkDescriptorSetLayoutCreateInfo info = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
        info.bindingCount = kCounts[set];
        info.pBindings = bindings;
        result = device.vk.CreateDescriptorSetLayout(device.device, &info, nullptr, &state.setLayouts[set]);
        if (result != VK_SUCCESS) return vulkanFailure(result, "vkCreateDescriptorSetLayout");
    }
    VkPipelineLayoutCreateInfo info = {VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = kSetCount;
    info.pSetLayouts = state.setLayouts;
    result = device.vk.CreatePipelineLayout(device.device, &info, nullptr, &state.pipelineLayout);
    return result == VK_SUCCESS ? Result() : vulkanFailure(result, "vkCreatePipelineLayout");
}

void readDevice(Context::State& state, const ContextDesc& desc) {
    DeviceContext& device = state.device;
    device.device = desc.device;
    device.physicalDevice = desc.physicalDevice;
    device.debugLabels = desc.debugLabels;
    for (std::uint32_t family : desc.queueFamilies) {  // sharing wants each family once
        std::uint32_t* const end = device.queueFamilies + device.queueFamilyCount;
        if (std::find(device.queueFamilies, end, family) != end) continue;
        device.queueFamilies[device.queueFamilyCount++] = family;
    }
    device.vk.GetPhysicalDeviceMemoryProperties(desc.physicalDevice, &device.memory);
    VkPhysicalDeviceProperties2 properties = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    device.vk.GetPhysicalDeviceProperties2(desc.physicalDevice, &properties);
    device.limits = properties.properties.limits;
    std::uint32_t count = 16;
    VkQueueFamilyProperties families[16] = {};
    device.vk.GetPhysicalDeviceQueueFamilyProperties(desc.physicalDevice, &count, families);
    state.timestampPeriodNs = device.limits.timestampPeriod;
    for (std::uint32_t family : desc.queueFamilies) {
        const std::uint32_t bits = family < count ? families[family].timestampValidBits : 0;
        if (bits == 0) state.timestampPeriodNs = 0.0f;
        if (bits < 64) state.timestampMask &= (std::uint64_t{1} << bits) - 1;
    }
}

}  // namespace

Context::State::~State() {
    const Functions& vk = device.vk;
    if (device.device == VK_NULL_HANDLE) return;  // refused before anything was made
    pipelines.destroy();
    vk.DestroyPipelineLayout(device.device, pipelineLayout, nullptr);
    for (VkDescriptorSetLayout layout : setLayouts) vk.DestroyDescriptorSetLayout(device.device, layout, nullptr);
    vk.DestroySampler(device.device, shadowSampler, nullptr);
}

Specialization Context::State::specializationOf(const ShadowSettings& settings) const noexcept {
    Specialization values = gnomon::specializationOf(settings);
    values.subgroupSize = subgroupSize;
    values.shadowAtlases = maxShadowAtlases;
    return values;
}

QueueSet queuesOf(FilterSet filters) noexcept {
    QueueSet queues = 0;
    for (std::uint32_t queue = 0; queue < kPairQueueCount; ++queue)
        queues |= ((filters & ~kFiltersByTile) >> queue / kShadowViewsKinds & 1u) << queue;
    return queues;
}

Result Context::State::pipelinesFor(const ShadowSettings& settings, QueueSet queues, PassPipelines& out) {
    if (Result checked = checkSettings(settings); !checked) return checked;
    if ((settings.filters & only(Filter::Host)) != 0 && !hostProvider) {
        return Result::failure(Status::BadArgument,
                               "ShadowSettings::filters has Filter::Host: it needs ContextDesc::filterPairsSpirv.");
    }
    return pipelines.get(specializationOf(settings), queues, out);
}

Context::Context(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
Context::~Context() = default;

Result Context::create(const ContextDesc& desc, std::unique_ptr<Context>& out) noexcept {
    try {
        if (Result checked = checkDesc(desc); !checked) return checked;
        auto state = std::make_unique<State>();
        if (Result loaded =
                loadFunctions(desc.getInstanceProcAddr, desc.instance, desc.device, desc.debugLabels, state->device.vk);
            !loaded) {
            return loaded;
        }
        if (Result chosen = chooseSubgroupSize(desc, state->device.vk, state->subgroupSize, state->requireSubgroupSize);
            !chosen) {
            return chosen;
        }
        readDevice(*state, desc);
        state->maxShadowAtlases = desc.maxShadowAtlases;
        state->hostProvider = !desc.filterPairsSpirv.empty();
        if (Result made = createLayouts(*state); !made) return made;
        Pipelines::Desc pipelines;
        pipelines.cache = desc.pipelineCache;
        pipelines.layout = state->pipelineLayout;
        pipelines.subgroupSize = state->subgroupSize;
        pipelines.requireSubgroupSize = state->requireSubgroupSize;
        pipelines.filterPairsSpirv.assign(desc.filterPairsSpirv.begin(), desc.filterPairsSpirv.end());
        state->pipelines.create(state->device, std::move(pipelines));
        out.reset(new Context(std::move(state)));
        return {};
    } catch (const std::bad_alloc&) {
        return Result::failure(Status::OutOfMemory, "Out of memory while creating a context.");
    }
}

Result Context::prepare(const ShadowSettings& settings) const noexcept {
    try {
        PassPipelines unused = {};
        return state_->pipelinesFor(settings, queuesOf(settings.filters), unused);
    } catch (const std::bad_alloc&) {
        return Result::failure(Status::OutOfMemory, "Out of memory while making pipelines.");
    }
}

std::uint32_t Context::pipelineCount() const noexcept {
    return state_->pipelines.count();
}
VkDescriptorSetLayout Context::listsSetLayout() const noexcept {
    return state_->setLayouts[kSetLists];
}
VkDescriptorSetLayout Context::receiversSetLayout() const noexcept {
    return state_->setLayouts[kSetReceivers];
}
VkDescriptorSetLayout Context::shadowmapsSetLayout() const noexcept {
    return state_->setLayouts[kSetShadowmaps];
}
std::uint32_t Context::subgroupSize() const noexcept {
    return state_->subgroupSize;
}
SpecializationValues Context::specialization(const ShadowSettings& settings) const noexcept {
    static_assert(sizeof(SpecializationValues::values) == sizeof(Specialization));
    return {std::bit_cast<std::array<std::uint32_t, SpecializationValues::kCount>>(state_->specializationOf(settings))};
}

}  // namespace gnomon
