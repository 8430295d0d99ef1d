#include "renderer/gpu/device.h"

#include <exception>

namespace gnomon::renderer {

Device::Device(const VulkanInstance& instance, const DeviceInfo& info, const std::vector<const char*>& extensions,
               void* moreFeatures)
    : instance_(instance), info_(info) {
    if (!info.suitable) throw GpuError(info.missing);
    create(extensions, moreFeatures);
    vkGetDeviceQueue(device_, info_.queueFamily, 0, &queue_);
    memory_ = std::make_unique<MemoryPool>(info_.handle, device_);
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr,
                                 VK_COMMAND_POOL_CREATE_TRANSIENT_BIT, info_.queueFamily};
    check(vkCreateCommandPool(device_, &pool, nullptr, &immediatePool_), "creating a command pool");
    VkPipelineCacheCreateInfo cache{};
    cache.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO;
    check(vkCreatePipelineCache(device_, &cache, nullptr, &pipelineCache_), "creating a pipeline cache");

    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(info_.handle, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(info_.handle, &count, families.data());
    const std::uint32_t bits = families[info_.queueFamily].timestampValidBits;
    timestampMask_ = bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
    timestampPeriodNs_ = bits == 0 ? 0.0 : static_cast<double>(limits().timestampPeriod);
}

void Device::create(const std::vector<const char*>& extensions, void* moreFeatures) {
    VkPhysicalDeviceFeatures found{};
    vkGetPhysicalDeviceFeatures(info_.handle, &found);
    features_.samplerAnisotropy = found.samplerAnisotropy;
    features_.depthBiasClamp = found.depthBiasClamp;

    VkPhysicalDeviceVulkan13Features v13{};
    v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    v13.pNext = moreFeatures;
    v13.synchronization2 = VK_TRUE;
    v13.dynamicRendering = VK_TRUE;
    v13.computeFullSubgroups = VK_TRUE;
    v13.subgroupSizeControl = VK_TRUE;

    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = info_.queueFamily;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    create.pNext = &v13;
    create.queueCreateInfoCount = 1;
    create.pQueueCreateInfos = &queue;
    create.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    create.ppEnabledExtensionNames = extensions.data();
    create.pEnabledFeatures = &features_;
    check(vkCreateDevice(info_.handle, &create, nullptr, &device_), "creating the device");
}

Device::~Device() {
    vkDeviceWaitIdle(device_);
    vkDestroyPipelineCache(device_, pipelineCache_, nullptr);
    vkDestroyCommandPool(device_, immediatePool_, nullptr);
    memory_.reset();
    vkDestroyDevice(device_, nullptr);
}

bool Device::supports(VkFormat format, VkFormatFeatureFlags optimalTilingFeatures) const {
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(info_.handle, format, &properties);
    return (properties.optimalTilingFeatures & optimalTilingFeatures) == optimalTilingFeatures;
}

void Device::submitAndWait(const std::function<void(VkCommandBuffer)>& record) const {
    Commands commands(*this);
    record(commands.begin());
    commands.submit();
    commands.wait();
}

void Device::waitIdle() const {
    check(vkDeviceWaitIdle(device_), "waiting for the device");
}

void Device::name(VkObjectType type, std::uint64_t object, const std::string& name) const {
    if (!instance_.debugLabels()) return;
    VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT, nullptr, type, object,
                                       name.c_str()};
    instance_.debug().setObjectName(device_, &info);
}

void Device::beginLabel(VkCommandBuffer commands, const char* name) const {
    if (!instance_.debugLabels()) return;
    VkDebugUtilsLabelEXT label{};
    label.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT;
    label.pLabelName = name;
    instance_.debug().beginLabel(commands, &label);
}

void Device::endLabel(VkCommandBuffer commands) const {
    if (instance_.debugLabels()) instance_.debug().endLabel(commands);
}

Commands::Commands(const Device& device) : device_(device) {
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr,
                                 VK_COMMAND_POOL_CREATE_TRANSIENT_BIT, device.queueFamily()};
    check(vkCreateCommandPool(device.handle(), &pool, nullptr, &pool_), "creating a command pool");
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool_,
                                         VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    check(vkAllocateCommandBuffers(device.handle(), &allocate, &commands_), "allocating a command buffer");
    VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, 0};
    check(vkCreateFence(device.handle(), &fence, nullptr, &fence_), "creating a fence");
}

Commands::~Commands() {
    if (submitted_) vkWaitForFences(device_.handle(), 1, &fence_, VK_TRUE, UINT64_MAX);
    vkDestroyFence(device_.handle(), fence_, nullptr);
    vkDestroyCommandPool(device_.handle(), pool_, nullptr);
}

VkCommandBuffer Commands::begin() {
    wait();
    check(vkResetCommandPool(device_.handle(), pool_, 0), "resetting a command pool");
    VkCommandBufferBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands_, &info), "beginning a command buffer");
    return commands_;
}

void Commands::submit() {
    check(vkEndCommandBuffer(commands_), "ending a command buffer");
    VkCommandBufferSubmitInfo commands{};
    commands.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
    commands.commandBuffer = commands_;
    VkSubmitInfo2 submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &commands;
    check(vkResetFences(device_.handle(), 1, &fence_), "resetting a fence");
    check(vkQueueSubmit2(device_.queue(), 1, &submit, fence_), "submitting commands");
    submitted_ = true;
}

void Commands::wait() {
    if (!submitted_) return;
    check(vkWaitForFences(device_.handle(), 1, &fence_, VK_TRUE, UINT64_MAX), "waiting for the device");
    submitted_ = false;
}

}  // namespace gnomon::renderer
