// Context: checks the device, makes layouts and one pipeline per pass.
#include "context.h"

#include <algorithm>
#include <new>

#include "gpu_interface/numbers.h"

namespace gnomon {
namespace {

using namespace gpu;

std::uint32_t providerOf(Filter filter) {
    switch (filter) {
        case Filter::Hard:
            return kProviderHard;
        case Filter::Pcf:
            return kProviderPcf;
        case Filter::Off:
            return kProviderOff;
        case Filter::Pcss:
            return kProviderPcss;
    }
    return kProviderPcss;
}

std::uint32_t reservationOf(ListReservation reservation) {
    switch (reservation) {
        case ListReservation::Approximate:
            return kReserveApproximate;
        case ListReservation::Accurate:
            return kReserveAccurate;
        case ListReservation::Fixed:
            return kReserveFixed;
    }
    return kReserveApproximate;
}

std::uint32_t depthBiasOf(DepthBias bias) {
    switch (bias) {
        case DepthBias::Oriented:
            return kDepthBiasOriented;
        case DepthBias::OrientedConstant:
            return kDepthBiasOrientedConstant;
        case DepthBias::Unbiased:
            return kDepthBiasUnbiased;
    }
    return kDepthBiasOriented;
}

Result checkDesc(const ContextDesc& desc) {
    if (desc.instance == VK_NULL_HANDLE || desc.physicalDevice == VK_NULL_HANDLE || desc.device == VK_NULL_HANDLE) {
        return Result::failure(Status::BadArgument, "ContextDesc needs an instance, a physical device and a device.");
    }
    if (desc.queueFamilies.empty() || desc.queueFamilies.size() > 8) {
        return Result::failure(Status::BadArgument, "ContextDesc::queueFamilies must name 1 to 8 queue families.");
    }
    if (desc.pcfRadius < 1 || desc.pcfRadius > kMaxPcfRadius) {
        return Result::failure(Status::BadArgument, "ContextDesc::pcfRadius is %u; it must be 1 to %u texels.",
                               desc.pcfRadius, kMaxPcfRadius);
    }
    if (desc.pcss.searchTaps < 1 || desc.pcss.searchTaps > kMaxPcssTaps || desc.pcss.filterTaps < 1 ||
        desc.pcss.filterTaps > kMaxPcssTaps) {
        return Result::failure(Status::BadArgument, "ContextDesc::pcss has %u and %u taps; each must be 1 to %u.",
                               desc.pcss.searchTaps, desc.pcss.filterTaps, kMaxPcssTaps);
    }
    if (desc.maxShadowAtlases < 1 || desc.maxShadowAtlases > kMaxShadowAtlases) {
        return Result::failure(Status::BadArgument, "ContextDesc::maxShadowAtlases is %u; it must be 1 to %u.",
                               desc.maxShadowAtlases, kMaxShadowAtlases);
    }
    if (desc.visibilityBits != kMaxVisibilityBits && desc.visibilityBits != kMinVisibilityBits) {
        return Result::failure(Status::BadArgument, "ContextDesc::visibilityBits is %u; it must be 8 or 4.",
                               desc.visibilityBits);
    }
    if (desc.listReservation == ListReservation::Fixed &&
        (desc.fixedListEntriesPerTile < 1 || desc.fixedListEntriesPerTile > kMaxLightsPerView)) {
        return Result::failure(Status::BadArgument, "ContextDesc::fixedListEntriesPerTile is %u; it must be 1 to %u.",
                               desc.fixedListEntriesPerTile, kMaxLightsPerView);
    }
    return {};
}

// Of the set of the lists all but the frame's uniform buffer; the shadow views, the shadow bounds and their cells.
constexpr std::uint32_t kStorageBuffersNeeded = kListsBindingCount - 1 + 3;

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

VkResult createLayout(const DeviceContext& device, const VkDescriptorSetLayoutBinding* bindings, std::uint32_t count,
                      VkDescriptorSetLayout& out) {
    VkDescriptorSetLayoutCreateInfo info = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    info.bindingCount = count;
    info.pBindings = bindings;
    return device.vk.CreateDescriptorSetLayout(device.device, &info, nullptr, &out);
}

constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

Result createLayouts(Context::State& state) {
    VkDescriptorSetLayoutBinding lists[kListsBindingCount] = {};
    for (std::uint32_t i = 0; i < kListsBindingCount; ++i) {
        lists[i] = {i, i == kBindFrame ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1,
                    kStages, nullptr};
    }
    VkDescriptorSetLayoutBinding receivers[kReceiversBindingCount] = {};
    for (std::uint32_t i = 0; i < kReceiversBindingCount; ++i) {
        receivers[i] = {i, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1, kStages, nullptr};
    }
    VkDescriptorSetLayoutBinding shadowmaps[kShadowmapsBindingCount] = {};
    for (std::uint32_t i = 0; i < kShadowmapsBindingCount; ++i) {
        shadowmaps[i] = {i, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1, kStages, nullptr};
    }
    for (std::uint32_t binding : {kBindShadowViews, kBindShadowBounds, kBindShadowBoundsCells})
        shadowmaps[binding].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    shadowmaps[kBindShadowSampler].descriptorType = VK_DESCRIPTOR_TYPE_SAMPLER;
    shadowmaps[kBindShadowSampler].pImmutableSamplers = &state.shadowSampler;

    const DeviceContext& device = state.device;
    VkSamplerCreateInfo sampler = {VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    sampler.addressModeU = sampler.addressModeV = sampler.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    VkResult result = device.vk.CreateSampler(device.device, &sampler, nullptr, &state.shadowSampler);
    if (result == VK_SUCCESS) result = createLayout(device, lists, kListsBindingCount, state.listsLayout);
    if (result == VK_SUCCESS) result = createLayout(device, receivers, kReceiversBindingCount, state.receiversLayout);
    if (result == VK_SUCCESS)
        result = createLayout(device, shadowmaps, kShadowmapsBindingCount, state.shadowmapsLayout);
    if (result != VK_SUCCESS) return vulkanFailure(result, "Creating descriptor set layouts");

    const VkDescriptorSetLayout layouts[] = {state.listsLayout, state.receiversLayout, state.shadowmapsLayout};
    VkPipelineLayoutCreateInfo info = {VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = 3;
    info.pSetLayouts = layouts;
    result = device.vk.CreatePipelineLayout(device.device, &info, nullptr, &state.pipelineLayout);
    return result == VK_SUCCESS ? Result() : vulkanFailure(result, "vkCreatePipelineLayout");
}

Result createPipeline(Context::State& state, PassId id) {
    const DeviceContext& device = state.device;
    const Pass& pass = passOf(id);
    std::span<const std::uint32_t> spirv = pass.spirv;
    if (id == kPassGenerateShadows && !state.desc.generateShadowsSpirv.empty()) spirv = state.desc.generateShadowsSpirv;
    VkShaderModuleCreateInfo module = {VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    module.codeSize = spirv.size_bytes();
    module.pCode = spirv.data();
    VkShaderModule shader = VK_NULL_HANDLE;
    VkResult result = device.vk.CreateShaderModule(device.device, &module, nullptr, &shader);
    if (result != VK_SUCCESS) return vulkanFailure(result, "vkCreateShaderModule");

    VkSpecializationMapEntry entries[kSpecializationCount] = {};
    for (std::uint32_t i = 0; i < kSpecializationCount; ++i) entries[i] = {i, i * 4u, 4u};
    const VkSpecializationInfo specialization = {kSpecializationCount, entries, sizeof(state.specialization),
                                                 state.specialization};
    VkPipelineShaderStageRequiredSubgroupSizeCreateInfo required = {
        VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO};
    required.requiredSubgroupSize = state.subgroupSize;
    VkComputePipelineCreateInfo info = {VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  state.requireSubgroupSize ? &required : nullptr,
                  VK_PIPELINE_SHADER_STAGE_CREATE_REQUIRE_FULL_SUBGROUPS_BIT,
                  VK_SHADER_STAGE_COMPUTE_BIT,
                  shader,
                  "main",
                  &specialization};
    info.layout = state.pipelineLayout;
    result = device.vk.CreateComputePipelines(device.device, state.desc.pipelineCache, 1, &info, nullptr,
                                              &state.pipelines[id]);
    device.vk.DestroyShaderModule(device.device, shader, nullptr);
    return result == VK_SUCCESS ? Result() : vulkanFailure(result, pass.name);
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
    for (VkPipeline pipeline : pipelines) vk.DestroyPipeline(device.device, pipeline, nullptr);
    vk.DestroyPipelineLayout(device.device, pipelineLayout, nullptr);
    vk.DestroyDescriptorSetLayout(device.device, listsLayout, nullptr);
    vk.DestroyDescriptorSetLayout(device.device, receiversLayout, nullptr);
    vk.DestroyDescriptorSetLayout(device.device, shadowmapsLayout, nullptr);
    vk.DestroySampler(device.device, shadowSampler, nullptr);
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
        state->desc = desc;
        readDevice(*state, desc);
        state->desc.queueFamilies = {};  // the caller's memory; copied by readDevice
        const std::uint32_t values[] = {state->subgroupSize,
                                        providerOf(desc.filter),
                                        reservationOf(desc.listReservation),
                                        desc.pcfRadius,
                                        desc.hostDepthPyramid ? 1u : 0u,
                                        desc.pcss.searchTaps,
                                        desc.pcss.filterTaps,
                                        desc.visibilityBits,
                                        desc.maxShadowAtlases,
                                        depthBiasOf(desc.depthBias),
                                        desc.facedAwayIsDark ? 1u : 0u};
        static_assert(kSpecSubgroupSize == 0 && kSpecProvider == 1 && kSpecListReservation == 2 &&
                      kSpecPcfRadius == 3 && kSpecHostDepthPyramid == 4 && kSpecPcssSearchTaps == 5 &&
                      kSpecPcssFilterTaps == 6 && kSpecVisibilityBits == 7 && kSpecShadowAtlases == 8 &&
                      kSpecDepthBias == 9 && kSpecFacedAwayIsDark == 10);
        std::copy(std::begin(values), std::end(values), state->specialization);
        if (Result made = createLayouts(*state); !made) return made;
        for (std::uint32_t id = 0; id < kPassCount; ++id) {
            if (Result made = createPipeline(*state, static_cast<PassId>(id)); !made) return made;
        }
        state->desc.generateShadowsSpirv = {};
        out.reset(new Context(std::move(state)));
        return {};
    } catch (const std::bad_alloc&) {
        return Result::failure(Status::OutOfMemory, "Out of memory while creating a context.");
    }
}

VkDescriptorSetLayout Context::listsSetLayout() const noexcept {
    return state_->listsLayout;
}
VkDescriptorSetLayout Context::receiversSetLayout() const noexcept {
    return state_->receiversLayout;
}
VkDescriptorSetLayout Context::shadowmapsSetLayout() const noexcept {
    return state_->shadowmapsLayout;
}
std::uint32_t Context::subgroupSize() const noexcept {
    return state_->subgroupSize;
}
std::span<const std::uint32_t> Context::specializationValues() const noexcept {
    return state_->specialization;
}

}  // namespace gnomon
