#include "vulkan_setup.h"

#include <cstdio>
#include <stdexcept>
#include <string>

namespace host {

void check(VkResult result, const char* call) {
    if (result == VK_SUCCESS) return;
    throw std::runtime_error(std::string(call) + " failed with VkResult " + std::to_string(result) + ".");
}

void imageBarrier(VkCommandBuffer commands, const Image& image, Use from, VkImageLayout before, Use to,
                  VkImageLayout after) {
    VkImageMemoryBarrier2 barrier = {VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = from.stage;
    barrier.srcAccessMask = from.access;
    barrier.dstStageMask = to.stage;
    barrier.dstAccessMask = to.access;
    barrier.oldLayout = before;
    barrier.newLayout = after;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image.handle;
    barrier.subresourceRange = {image.aspect, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
    VkDependencyInfo info = {VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &info);
}

Device::Device(std::uint32_t index) {
    VkApplicationInfo app = {VK_STRUCTURE_TYPE_APPLICATION_INFO};
    app.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &app;
    check(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
    try {
        choosePhysical(index);
        chooseQueueFamily();
        makeDevice();
    } catch (...) {
        vkDestroyInstance(instance, nullptr);
        throw;
    }
}

Device::~Device() {
    vkDeviceWaitIdle(handle);
    for (auto destroy = undo_.rbegin(); destroy != undo_.rend(); ++destroy) (*destroy)();
    vkDestroyDevice(handle, nullptr);
    vkDestroyInstance(instance, nullptr);
}

void Device::choosePhysical(std::uint32_t index) {
    std::uint32_t count = 0;
    check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
    std::vector<VkPhysicalDevice> devices(count);
    check(vkEnumeratePhysicalDevices(instance, &count, devices.data()), "vkEnumeratePhysicalDevices");
    VkPhysicalDeviceProperties properties;
    if (index >= count) {
        std::string sentence = "There is no such Vulkan device";
        for (std::uint32_t i = 0; i < count; ++i) {
            vkGetPhysicalDeviceProperties(devices[i], &properties);
            sentence += (i == 0 ? ": give " : ", ") + std::to_string(i) + " (" + properties.deviceName + ")";
        }
        throw std::runtime_error(sentence + (count == 0 ? ": there is none at all." : "."));
    }
    physical = devices[index];
    vkGetPhysicalDeviceProperties(physical, &properties);
    std::printf("device: %s\n", properties.deviceName);
    if (properties.apiVersion < VK_API_VERSION_1_3) throw std::runtime_error("The device lacks Vulkan 1.3.");
}

// One queue that draws and computes. Every family that draws computes too, by Vulkan's rules, unless the device has
// another that does.
void Device::chooseQueueFamily() {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    constexpr VkQueueFlags kBoth = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    while (queueFamily < count && (families[queueFamily].queueFlags & kBoth) != kBoth) ++queueFamily;
    if (queueFamily == count) throw std::runtime_error("The device has no graphics queue.");
}

void Device::makeDevice() {
    VkPhysicalDeviceVulkan13Features features = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    // These three are what the library needs. Every Vulkan 1.3 device has them, but they must be enabled.
    features.synchronization2 = VK_TRUE;
    features.subgroupSizeControl = VK_TRUE;
    features.computeFullSubgroups = VK_TRUE;
    // And this is for the drawing here.
    features.dynamicRendering = VK_TRUE;
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queues = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queues.queueFamilyIndex = queueFamily;
    queues.queueCount = 1;
    queues.pQueuePriorities = &priority;
    VkDeviceCreateInfo info = {VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queues;
    check(vkCreateDevice(physical, &info, nullptr, &handle), "vkCreateDevice");
    vkGetDeviceQueue(handle, queueFamily, 0, &queue);
}

// An allocation for each resource, which is plenty here. An engine has an allocator.
VkDeviceMemory Device::allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted) {
    VkPhysicalDeviceMemoryProperties properties;
    vkGetPhysicalDeviceMemoryProperties(physical, &properties);
    VkMemoryAllocateInfo info = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size, 0};
    for (; info.memoryTypeIndex < properties.memoryTypeCount; ++info.memoryTypeIndex) {
        const bool fits = (needs.memoryTypeBits >> info.memoryTypeIndex & 1u) != 0;
        if (fits && (~properties.memoryTypes[info.memoryTypeIndex].propertyFlags & wanted) == 0) break;
    }
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check(vkAllocateMemory(handle, &info, nullptr, &memory), "vkAllocateMemory");
    own([this, memory] { vkFreeMemory(handle, memory, nullptr); });
    return memory;
}

Buffer Device::makeBuffer(VkDeviceSize bytes, VkBufferUsageFlags usage) {
    VkBufferCreateInfo info = {VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = bytes;
    info.usage = usage;
    Buffer buffer;
    check(vkCreateBuffer(handle, &info, nullptr, &buffer.handle), "vkCreateBuffer");
    own([this, made = buffer.handle] { vkDestroyBuffer(handle, made, nullptr); });
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(handle, buffer.handle, &needs);
    const VkDeviceMemory memory =
        allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    check(vkBindBufferMemory(handle, buffer.handle, memory, 0), "vkBindBufferMemory");
    check(vkMapMemory(handle, memory, 0, VK_WHOLE_SIZE, 0, &buffer.mapped), "vkMapMemory");
    return buffer;
}

Image Device::makeImage(VkFormat format, std::uint32_t widthPx, std::uint32_t heightPx, VkImageUsageFlags usage,
                        VkImageViewType viewType) {
    VkImageCreateInfo info = {VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {widthPx, heightPx, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = usage;
    Image image;
    image.aspect = format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    check(vkCreateImage(handle, &info, nullptr, &image.handle), "vkCreateImage");
    own([this, made = image.handle] { vkDestroyImage(handle, made, nullptr); });
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(handle, image.handle, &needs);
    const VkDeviceMemory memory = allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    check(vkBindImageMemory(handle, image.handle, memory, 0), "vkBindImageMemory");
    VkImageViewCreateInfo view = {VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = image.handle;
    view.viewType = viewType;
    view.format = format;
    view.subresourceRange = {image.aspect, 0, 1, 0, 1};
    check(vkCreateImageView(handle, &view, nullptr, &image.view), "vkCreateImageView");
    own([this, made = image.view] { vkDestroyImageView(handle, made, nullptr); });
    return image;
}

VkPipelineLayout Device::makePipelineLayout(std::span<const VkDescriptorSetLayout> sets, std::uint32_t pushBytes) {
    const VkPushConstantRange push = {VK_SHADER_STAGE_VERTEX_BIT, 0, pushBytes};
    VkPipelineLayoutCreateInfo info = {VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = static_cast<std::uint32_t>(sets.size());
    info.pSetLayouts = sets.data();
    info.pushConstantRangeCount = pushBytes != 0 ? 1 : 0;
    info.pPushConstantRanges = &push;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    check(vkCreatePipelineLayout(handle, &info, nullptr, &layout), "vkCreatePipelineLayout");
    own([this, layout] { vkDestroyPipelineLayout(handle, layout, nullptr); });
    return layout;
}

VkShaderModule Device::makeShader(std::span<const std::uint32_t> spirv) {
    VkShaderModuleCreateInfo info = {VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = spirv.size_bytes();
    info.pCode = spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    check(vkCreateShaderModule(handle, &info, nullptr, &module), "vkCreateShaderModule");
    own([this, module] { vkDestroyShaderModule(handle, module, nullptr); });
    return module;
}

VkPipeline Device::makeComputePipeline(std::span<const std::uint32_t> spirv, VkPipelineLayout layout,
                                       std::span<const std::uint32_t> constants) {
    std::vector<VkSpecializationMapEntry> entries;
    for (std::uint32_t id = 0; id < constants.size(); ++id) entries.push_back({id, id * 4, 4});
    const VkSpecializationInfo specialization = {static_cast<std::uint32_t>(entries.size()), entries.data(),
                                                 constants.size_bytes(), constants.data()};
    VkComputePipelineCreateInfo info = {VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = makeShader(spirv);
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = &specialization;
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    check(vkCreateComputePipelines(handle, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), "vkCreateComputePipelines");
    own([this, pipeline] { vkDestroyPipeline(handle, pipeline, nullptr); });
    return pipeline;
}

FrameRing::FrameRing(Device& device, std::uint32_t framesInFlight) : device_(device), frames_(framesInFlight) {
    VkCommandPoolCreateInfo poolInfo = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    poolInfo.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    poolInfo.queueFamilyIndex = device.queueFamily;
    VkCommandPool pool = VK_NULL_HANDLE;
    check(vkCreateCommandPool(device.handle, &poolInfo, nullptr, &pool), "vkCreateCommandPool");
    device.own([&device, pool] { vkDestroyCommandPool(device.handle, pool, nullptr); });
    for (Frame& frame : frames_) {
        VkCommandBufferAllocateInfo info = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
        info.commandPool = pool;
        info.commandBufferCount = 1;
        check(vkAllocateCommandBuffers(device.handle, &info, &frame.commands), "vkAllocateCommandBuffers");
        VkFenceCreateInfo fence = {VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        fence.flags = VK_FENCE_CREATE_SIGNALED_BIT;  // nothing to wait for in the first frames
        check(vkCreateFence(device.handle, &fence, nullptr, &frame.finished), "vkCreateFence");
        device.own([&device, made = frame.finished] { vkDestroyFence(device.handle, made, nullptr); });
    }
}

VkCommandBuffer FrameRing::begin(std::uint64_t number) {
    const Frame& frame = frames_[number % frames_.size()];
    check(vkWaitForFences(device_.handle, 1, &frame.finished, VK_TRUE, UINT64_MAX), "vkWaitForFences");
    VkCommandBufferBeginInfo info = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(frame.commands, &info), "vkBeginCommandBuffer");
    return frame.commands;
}

void FrameRing::submit(std::uint64_t number) {
    const Frame& frame = frames_[number % frames_.size()];
    check(vkEndCommandBuffer(frame.commands), "vkEndCommandBuffer");
    check(vkResetFences(device_.handle, 1, &frame.finished), "vkResetFences");
    VkSubmitInfo info = {VK_STRUCTURE_TYPE_SUBMIT_INFO};
    info.commandBufferCount = 1;
    info.pCommandBuffers = &frame.commands;
    check(vkQueueSubmit(device_.queue, 1, &info, frame.finished), "vkQueueSubmit");
}

void FrameRing::waitForAll() const {
    for (const Frame& frame : frames_)
        check(vkWaitForFences(device_.handle, 1, &frame.finished, VK_TRUE, UINT64_MAX), "vkWaitForFences");
}

}  // namespace host
