#include "unit/house/fake_vulkan.h"

#include <algorithm>
#include <cstring>

namespace gnomon::house {
namespace {

// What a buffer or an image needs, whatever its size: large enough for the little that is written without a frame.
constexpr VkDeviceSize kBytesOfEverything = 1u << 16;

FakeVulkan* current = nullptr;  // the driver's functions carry no pointer of ours

template <typename Handle>
Handle handleOf(std::uint64_t number) {
    return reinterpret_cast<Handle>(number);
}

// A fresh handle, or null once the fake has run out of memory.
template <typename Handle>
VkResult make(Handle* out) {
    if (current->made >= current->failAfter) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    *out = handleOf<Handle>(++current->made);
    return VK_SUCCESS;
}

template <typename Handle>
VKAPI_ATTR void VKAPI_CALL destroy(VkDevice device, Handle handle, const VkAllocationCallbacks*) {
    if (device == VK_NULL_HANDLE) ++current->callsWithoutDevice;
    if (handle != VK_NULL_HANDLE) ++current->destroyed;
}

template <typename Info, typename Handle>
VKAPI_ATTR VkResult VKAPI_CALL create(VkDevice, const Info*, const VkAllocationCallbacks*, Handle* out) {
    return make(out);
}

VKAPI_ATTR void VKAPI_CALL getProperties2(VkPhysicalDevice, VkPhysicalDeviceProperties2* out) {
    out->properties = current->properties;
    out->properties.limits.maxPerStageDescriptorStorageBuffers = current->storageBuffersPerStage;
    for (auto* next = static_cast<VkBaseOutStructure*>(out->pNext); next != nullptr; next = next->pNext) {
        if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES) {
            auto* v11 = reinterpret_cast<VkPhysicalDeviceVulkan11Properties*>(next);
            v11->subgroupSize = current->subgroupSize;
            v11->subgroupSupportedOperations = current->subgroupOperations;
            v11->subgroupSupportedStages = current->subgroupStages;
        }
        if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES) {
            auto* v13 = reinterpret_cast<VkPhysicalDeviceVulkan13Properties*>(next);
            v13->minSubgroupSize = current->minSubgroupSize;
            v13->maxSubgroupSize = current->maxSubgroupSize;
            v13->requiredSubgroupSizeStages = current->requiredSubgroupSizeStages;
        }
    }
}

VKAPI_ATTR void VKAPI_CALL getMemory(VkPhysicalDevice, VkPhysicalDeviceMemoryProperties* out) {
    *out = {};
    out->memoryTypeCount = out->memoryHeapCount = 1;
    out->memoryTypes[0].propertyFlags = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                        VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
}

template <typename Handle>
VKAPI_ATTR void VKAPI_CALL getRequirements(VkDevice, Handle, VkMemoryRequirements* out) {
    *out = {.size = kBytesOfEverything, .alignment = 16, .memoryTypeBits = 1};
}

VKAPI_ATTR VkResult VKAPI_CALL allocateMemory(VkDevice, const VkMemoryAllocateInfo* info, const VkAllocationCallbacks*,
                                              VkDeviceMemory* out) {
    const VkResult result = make(out);
    if (result == VK_SUCCESS) current->memory[*out].resize(info->allocationSize);
    return result;
}

VKAPI_ATTR void VKAPI_CALL freeMemory(VkDevice device, VkDeviceMemory memory, const VkAllocationCallbacks* callbacks) {
    destroy(device, memory, callbacks);
    current->memory.erase(memory);
}

VKAPI_ATTR VkResult VKAPI_CALL mapMemory(VkDevice, VkDeviceMemory memory, VkDeviceSize, VkDeviceSize, VkMemoryMapFlags,
                                         void** out) {
    *out = current->memory.at(memory).data();
    return VK_SUCCESS;
}

template <typename Handle>
VKAPI_ATTR VkResult VKAPI_CALL bindMemory(VkDevice, Handle, VkDeviceMemory, VkDeviceSize) {
    return VK_SUCCESS;
}

// Sets go with their pool.
VKAPI_ATTR VkResult VKAPI_CALL allocateSets(VkDevice, const VkDescriptorSetAllocateInfo* info, VkDescriptorSet* out) {
    for (std::uint32_t i = 0; i < info->descriptorSetCount; ++i) out[i] = handleOf<VkDescriptorSet>(i + 1);
    return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL updateSets(VkDevice, std::uint32_t, const VkWriteDescriptorSet*, std::uint32_t,
                                      const VkCopyDescriptorSet*) {}

VKAPI_ATTR void VKAPI_CALL getFamilies(VkPhysicalDevice, std::uint32_t* count, VkQueueFamilyProperties* out) {
    *count = 1;
    if (out != nullptr) out[0] = {VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT, 1, current->timestampBits, {1, 1, 1}};
}

VKAPI_ATTR VkResult VKAPI_CALL createSetLayout(VkDevice, const VkDescriptorSetLayoutCreateInfo* info,
                                               const VkAllocationCallbacks*, VkDescriptorSetLayout* out) {
    const VkResult result = make(out);
    if (result != VK_SUCCESS) return result;
    FakeVulkan::SetLayout layout = {*out, {}};
    for (std::uint32_t i = 0; i < info->bindingCount; ++i) {
        const VkDescriptorSetLayoutBinding& b = info->pBindings[i];
        layout.bindings.push_back({b.binding, b.descriptorType, b.descriptorCount});
    }
    current->setLayouts.push_back(layout);
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL createShaderModule(VkDevice, const VkShaderModuleCreateInfo* info,
                                                  const VkAllocationCallbacks*, VkShaderModule* out) {
    const VkResult result = make(out);
    if (result == VK_SUCCESS) current->modules[*out] = info->codeSize;
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL createBuffer(VkDevice, const VkBufferCreateInfo* info, const VkAllocationCallbacks*,
                                            VkBuffer* out) {
    const VkResult result = make(out);
    if (result == VK_SUCCESS) current->usages[*out] = info->usage;
    return result;
}

FakeVulkan::Pipeline describe(const VkPipelineShaderStageCreateInfo& stage) {
    FakeVulkan::Pipeline out;
    out.stageFlags = stage.flags;
    out.spirvBytes = current->modules[stage.module];
    if (stage.pNext != nullptr) {
        const auto* size = static_cast<const VkPipelineShaderStageRequiredSubgroupSizeCreateInfo*>(stage.pNext);
        if (size->sType == VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO) {
            out.requiredSubgroupSize = size->requiredSubgroupSize;
        }
    }
    const VkSpecializationInfo* info = stage.pSpecializationInfo;
    for (std::uint32_t i = 0; info != nullptr && i < info->mapEntryCount; ++i) {
        const VkSpecializationMapEntry& entry = info->pMapEntries[i];
        std::memcpy(&out.constants[entry.constantID], static_cast<const char*>(info->pData) + entry.offset, entry.size);
    }
    return out;
}

VKAPI_ATTR VkResult VKAPI_CALL createComputePipelines(VkDevice, VkPipelineCache, std::uint32_t count,
                                                      const VkComputePipelineCreateInfo* infos,
                                                      const VkAllocationCallbacks*, VkPipeline* out) {
    for (std::uint32_t i = 0; i < count; ++i) {
        const VkResult result = make(&out[i]);
        if (result != VK_SUCCESS) return result;
        current->pipelines.push_back(describe(infos[i].stage));
    }
    return VK_SUCCESS;
}

// Stands for every function that creating contexts and views has no reason to call.
VKAPI_ATTR void VKAPI_CALL neverCalled() {
    std::abort();
}

PFN_vkVoidFunction lookUp(const char* name);
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice, const char* name) {
    return lookUp(name);
}
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance, const char* name) {
    return lookUp(name);
}

PFN_vkVoidFunction lookUp(const char* name) {
    const auto as = [](auto* function) { return reinterpret_cast<PFN_vkVoidFunction>(function); };
    if (current->hidden.contains(name)) return nullptr;
    const struct {
        const char* name;
        PFN_vkVoidFunction function;
    } known[] = {
        {"vkGetDeviceProcAddr", as(getDeviceProcAddr)},
        {"vkGetPhysicalDeviceProperties2", as(getProperties2)},
        {"vkGetPhysicalDeviceMemoryProperties", as(getMemory)},
        {"vkGetPhysicalDeviceQueueFamilyProperties", as(getFamilies)},
        {"vkCreateDescriptorSetLayout", as(createSetLayout)},
        {"vkCreateComputePipelines", as(createComputePipelines)},
        {"vkCreateSampler", as(create<VkSamplerCreateInfo, VkSampler>)},
        {"vkCreatePipelineLayout", as(create<VkPipelineLayoutCreateInfo, VkPipelineLayout>)},
        {"vkCreateShaderModule", as(createShaderModule)},
        {"vkDestroyDescriptorSetLayout", as(destroy<VkDescriptorSetLayout>)},
        {"vkDestroyPipeline", as(destroy<VkPipeline>)},
        {"vkDestroyPipelineLayout", as(destroy<VkPipelineLayout>)},
        {"vkCreateQueryPool", as(create<VkQueryPoolCreateInfo, VkQueryPool>)},
        {"vkDestroyQueryPool", as(destroy<VkQueryPool>)},
        {"vkDestroySampler", as(destroy<VkSampler>)},
        {"vkDestroyShaderModule", as(destroy<VkShaderModule>)},
        {"vkCreateBuffer", as(createBuffer)},
        {"vkDestroyBuffer", as(destroy<VkBuffer>)},
        {"vkGetBufferMemoryRequirements", as(getRequirements<VkBuffer>)},
        {"vkBindBufferMemory", as(bindMemory<VkBuffer>)},
        {"vkCreateImage", as(create<VkImageCreateInfo, VkImage>)},
        {"vkDestroyImage", as(destroy<VkImage>)},
        {"vkGetImageMemoryRequirements", as(getRequirements<VkImage>)},
        {"vkBindImageMemory", as(bindMemory<VkImage>)},
        {"vkCreateImageView", as(create<VkImageViewCreateInfo, VkImageView>)},
        {"vkDestroyImageView", as(destroy<VkImageView>)},
        {"vkAllocateMemory", as(allocateMemory)},
        {"vkFreeMemory", as(freeMemory)},
        {"vkMapMemory", as(mapMemory)},
        {"vkCreateDescriptorPool", as(create<VkDescriptorPoolCreateInfo, VkDescriptorPool>)},
        {"vkDestroyDescriptorPool", as(destroy<VkDescriptorPool>)},
        {"vkAllocateDescriptorSets", as(allocateSets)},
        {"vkUpdateDescriptorSets", as(updateSets)},
    };
    for (const auto& entry : known) {
        if (std::strcmp(entry.name, name) == 0) return entry.function;
    }
    return as(neverCalled);
}

constexpr std::uint32_t kFamilies[] = {0};

}  // namespace

FakeVulkan::FakeVulkan() {
    current = this;
    properties.apiVersion = VK_API_VERSION_1_3;
    std::strcpy(properties.deviceName, "Fake device");
    VkPhysicalDeviceLimits& limits = properties.limits;
    limits.maxStorageBufferRange = 1u << 30;
    limits.maxUniformBufferRange = 65536;
    limits.maxBoundDescriptorSets = 4;
    limits.maxDescriptorSetStorageBuffers = storageBuffersPerStage;
    limits.maxPerStageDescriptorUniformBuffers = limits.maxDescriptorSetUniformBuffers = 12;
    limits.maxPerStageDescriptorSampledImages = limits.maxDescriptorSetSampledImages = 64;
    limits.maxPerStageDescriptorSamplers = limits.maxDescriptorSetSamplers = 16;
    limits.maxPerStageResources = 128;
    limits.maxComputeSharedMemorySize = 32768;
    limits.maxComputeWorkGroupInvocations = 1024;
    std::fill_n(limits.maxComputeWorkGroupCount, 3, 65535u);
    std::fill_n(limits.maxComputeWorkGroupSize, 3, 1024u);
    limits.minStorageBufferOffsetAlignment = 256;
    limits.timestampPeriod = 1.0f;
    subgroupOperations = VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_VOTE_BIT |
                         VK_SUBGROUP_FEATURE_ARITHMETIC_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT;
}

FakeVulkan::~FakeVulkan() {
    current = nullptr;
}

ContextDesc FakeVulkan::desc() const {
    ContextDesc desc;
    desc.instance = handleOf<VkInstance>(1);
    desc.physicalDevice = handleOf<VkPhysicalDevice>(2);
    desc.device = handleOf<VkDevice>(3);
    desc.getInstanceProcAddr = getInstanceProcAddr;
    desc.queueFamilies = kFamilies;
    return desc;
}

const FakeVulkan::SetLayout* FakeVulkan::find(VkDescriptorSetLayout handle) const {
    const auto found = std::ranges::find(setLayouts, handle, &SetLayout::handle);
    return found == setLayouts.end() ? nullptr : &*found;
}

}  // namespace gnomon::house
