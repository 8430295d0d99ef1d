// A bare Vulkan program with tiled deferred shadows, to be copied: one camera, four lights, one shadow atlas.
// The numbers in comments are the steps of docs/integration.md; run() has those of a frame.
//     minimal_host [picture.ppm] [index of the Vulkan device] [entries in each pool, to see an overflow]
#include <gnomon/gnomon.h>
#include <vulkan/vulkan.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

namespace {
constexpr uint32_t kTrace[] = {
#include "trace.spv.h"
};
constexpr uint32_t kLightTiles[] = {
#include "light_tiles.spv.h"
};
constexpr uint32_t kLightEvaluateTiles[] = {
#include "light_evaluate_tiles.spv.h"
};
constexpr uint32_t kWidthPx = 480, kHeightPx = 270, kAtlasPx = 1024, kFrames = 4, kFramesInFlight = 2;
constexpr float kNearMetres = 0.05f;
// One buffer for the shaders: the picture, and depths on their way to the images.
constexpr uint32_t kDepths = 4 * kWidthPx * kHeightPx, kAtlasDepths = 2 * kDepths;
constexpr uint32_t kDataBytes = kAtlasDepths + 4 * kAtlasPx * kAtlasPx;

void check(VkResult result) {
    if (result != VK_SUCCESS) throw std::runtime_error("Vulkan failed with VkResult " + std::to_string(result) + ".");
}
void check(const gnomon::Result& result) {
    if (!result) throw std::runtime_error(result.message());
}

using Vec3 = std::array<float, 3>;
using Mat4 = std::array<float, 16>;  // column-major
Mat4 multiply(const Mat4& a, const Mat4& b) {
    Mat4 m = {};
    for (int i = 0; i < 64; ++i) m[i / 16 * 4 + i % 4] += a[i / 4 % 4 * 4 + i % 4] * b[i / 16 * 4 + i / 4 % 4];
    return m;
}
Mat4 lookAlong(Vec3 eye, Vec3 d) {  // viewFromWorld of a view that looks down its -z axis, which is d; y is up
    const float l = std::hypot(d[0], d[1], d[2]), flat = std::hypot(d[0], d[2]);
    const Vec3 x = flat > 0 ? Vec3{-d[2] / flat, 0, d[0] / flat} : Vec3{1, 0, 0};
    const Vec3 z = {-d[0] / l, -d[1] / l, -d[2] / l}, y = {z[1] * x[2], z[2] * x[0] - z[0] * x[2], -z[1] * x[0]};
    return multiply({x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0, 0, 0, 0, 1},
                    {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -eye[0], -eye[1], -eye[2], 1});
}
Mat4 perspective(float tanX, float tanY) {  // clipFromView: reversed z without a far plane; Vulkan's y points down
    return {1 / tanX, 0, 0, 0, 0, -1 / tanY, 0, 0, 0, 0, 0, -1, 0, 0, kNearMetres, 0};
}

struct Host {  // what is needed everywhere
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    uint32_t queueFamily = 0;
    VkBuffer data = VK_NULL_HANDLE;
    VkDeviceAddress address = 0;  // of the data
    uint8_t* mapped = nullptr;    // the data
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkPipeline trace = VK_NULL_HANDLE, lightTiles = VK_NULL_HANDLE, lightEvaluateTiles = VK_NULL_HANDLE;
    template <class T, class Info>
    T make(VkResult(VKAPI_PTR* create)(VkDevice, const Info*, const VkAllocationCallbacks*, T*),
           const Info& info) const {
        T object = VK_NULL_HANDLE;
        check(create(device, &info, nullptr, &object));
        return object;
    }
};

// 1. Vulkan 1.3. The library needs the first three features; the shaders here need buffer addresses.
void createDevice(Host& host, uint32_t index) {
    const VkApplicationInfo app = {VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "", 0, "", 0, VK_API_VERSION_1_3};
    const VkInstanceCreateInfo instance = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, nullptr, 0, &app};
    check(vkCreateInstance(&instance, nullptr, &host.instance));
    VkPhysicalDevice devices[16];
    uint32_t deviceCount = 16, familyCount = 16;
    vkEnumeratePhysicalDevices(host.instance, &deviceCount, devices);
    if (index >= deviceCount) throw std::runtime_error("There is no such Vulkan device.");
    host.physicalDevice = devices[index];
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(host.physicalDevice, &properties);
    std::printf("device: %s\n", properties.deviceName);
    if (properties.apiVersion < VK_API_VERSION_1_3) throw std::runtime_error("The device lacks Vulkan 1.3.");
    VkQueueFamilyProperties families[16];
    vkGetPhysicalDeviceQueueFamilyProperties(host.physicalDevice, &familyCount, families);
    while ((families[host.queueFamily].queueFlags & VK_QUEUE_GRAPHICS_BIT) == 0) {  // such a family computes, too
        if (++host.queueFamily == familyCount) throw std::runtime_error("The device has no graphics queue.");
    }
    VkPhysicalDeviceVulkan12Features features12 = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    features12.bufferDeviceAddress = VK_TRUE;
    VkPhysicalDeviceVulkan13Features features = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, &features12};
    features.synchronization2 = features.computeFullSubgroups = features.subgroupSizeControl = VK_TRUE;
    const float one = 1.0f;
    const VkDeviceQueueCreateInfo q = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, {}, 0, host.queueFamily, 1, &one};
    const VkDeviceCreateInfo info = {VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features, 0, 1, &q};
    check(vkCreateDevice(host.physicalDevice, &info, nullptr, &host.device));
}

VkDeviceMemory allocate(const Host& host, const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted) {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(host.physicalDevice, &memory);
    uint32_t type = 0;  // Vulkan guarantees one that fits
    while ((needs.memoryTypeBits >> type & 1) == 0 || (~memory.memoryTypes[type].propertyFlags & wanted) != 0) ++type;
    const VkMemoryAllocateFlagsInfo flags = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO, nullptr,
                                             VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT};
    const VkMemoryAllocateInfo info = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &flags, needs.size, type};
    return host.make(vkAllocateMemory, info);
}
void createData(Host& host) {
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    const VkBufferCreateInfo info = {VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, nullptr, 0, kDataBytes, usage};
    host.data = host.make(vkCreateBuffer, info);
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(host.device, host.data, &needs);
    constexpr auto kMapped = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkDeviceMemory memory = allocate(host, needs, kMapped);
    check(vkBindBufferMemory(host.device, host.data, memory, 0));
    check(vkMapMemory(host.device, memory, 0, kDataBytes, 0, reinterpret_cast<void**>(&host.mapped)));
    const VkBufferDeviceAddressInfo address = {VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, nullptr, host.data};
    host.address = vkGetBufferDeviceAddress(host.device, &address);
}

// 4. The host's images: depth of the camera; and the shadow atlas, seen through an array view even if it has one layer.
VkImage createDepth(const Host& host, uint32_t widthPx, uint32_t heightPx, VkImageViewType type, VkImageView& view) {
    VkImageCreateInfo info = {VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO, nullptr, 0, VK_IMAGE_TYPE_2D, VK_FORMAT_D32_SFLOAT};
    info.extent = {widthPx, heightPx, info.mipLevels = info.arrayLayers = 1};
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    const VkImage image = host.make(vkCreateImage, info);
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(host.device, image, &needs);
    check(vkBindImageMemory(host.device, image, allocate(host, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT), 0));
    VkImageViewCreateInfo viewInfo = {VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, nullptr, 0, image, type, info.format};
    viewInfo.subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
    view = host.make(vkCreateImageView, viewInfo);
    return image;
}

// 5. Pipelines that light have the library's specialization values: they evaluate what it would have stored.
VkPipeline createPipeline(const Host& host, std::span<const uint32_t> spirv, std::span<const uint32_t> values) {
    VkShaderModuleCreateInfo module = {VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0, spirv.size_bytes()};
    module.pCode = spirv.data();
    std::vector<VkSpecializationMapEntry> entries;
    for (uint32_t i = 0; i < values.size(); ++i) entries.push_back({i, i * 4, 4});
    const VkSpecializationInfo constants = {uint32_t(values.size()), entries.data(), values.size_bytes(), &values[0]};
    VkComputePipelineCreateInfo info = {VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, VK_SHADER_STAGE_COMPUTE_BIT};
    info.stage.module = host.make(vkCreateShaderModule, module);
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = &constants;
    info.layout = host.layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    check(vkCreateComputePipelines(host.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline));
    return pipeline;
}
struct Push {  // of trace.comp
    Mat4 clipFromWorld;
    VkDeviceAddress depths;
    uint32_t firstPx[2], sizePx[2], rowPx;
};
void createPipelines(Host& host, const gnomon::Context& c) {
    const VkDescriptorSetLayout sets[] = {c.listsSetLayout(), c.receiversSetLayout(), c.shadowmapsSetLayout()};
    const VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(Push)};
    const VkPipelineLayoutCreateInfo info = {VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, {}, 0, 3, sets, 1, &push};
    host.layout = host.make(vkCreatePipelineLayout, info);
    host.trace = createPipeline(host, kTrace, c.specializationValues());
    host.lightTiles = createPipeline(host, kLightTiles, c.specializationValues());
    host.lightEvaluateTiles = createPipeline(host, kLightEvaluateTiles, c.specializationValues());
}

// 6. All of the scene's lights, and the views of those that cast shadows.
void createLights(std::vector<gnomon::Light>& lights, std::vector<gnomon::ShadowView>& views) {
    using enum gnomon::LightType;
    lights = {{.type = Spot, .position = {-4, 4, 3}, .direction = {3, -3.6f, -3}, .rangeMetres = 14},
              {.type = Spot, .position = {4, 4.5f, 2}, .direction = {-3, -4.5f, -3}, .rangeMetres = 14},
              {.type = Point, .position = {-0.2f, 1.8f, -1.8f}, .rangeMetres = 7},
              {.type = Point, .position = {2.5f, 0.8f, 2.6f}, .rangeMetres = 2.5f}};  // casts no shadow
    const Vec3 faces[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (uint32_t i = 0; i < 8; ++i) {  // two spots above, and below the six views of a point light
        gnomon::Light& light = lights[std::min(i, 2u)];
        light.firstShadowView = std::min(i, 2u);
        const uint32_t sizePx = i < 2 ? 512 : 256, xPx = i % 4 * sizePx, yPx = i < 2 ? 0 : 512 + i / 4 % 2 * 256;
        // Four texels more on each side, for filters at the border.
        const float tangent = (i < 2 ? std::tan(light.outerConeAngle) : 1) * float(sizePx) / float(sizePx - 8);
        const Vec3 eye = std::to_array(light.position), axis = i < 2 ? std::to_array(light.direction) : faces[i - 2];
        views.push_back({.xPx = xPx, .yPx = yPx, .widthPx = sizePx, .heightPx = sizePx, .nearMetres = kNearMetres});
        std::ranges::copy(multiply(perspective(tangent, tangent), lookAlong(eye, axis)), views.back().clipFromWorld);
    }
}

// Ends everything before. An engine names stages and accesses; the library's: COMPUTE_SHADER, SHADER_SAMPLED_READ.
void barrier(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to) {
    constexpr auto kAll = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT;
    constexpr auto kAny = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    const VkMemoryBarrier2 memory = {VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr, kAll, kAny, kAll, kAny};
    VkImageMemoryBarrier2 own = {VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2, nullptr, kAll, kAny, kAll, kAny, from, to};
    own.image = image;
    own.subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
    const VkDependencyInfo info = {VK_STRUCTURE_TYPE_DEPENDENCY_INFO, nullptr, 0, 1, &memory, 0, nullptr, 1, &own};
    vkCmdPipelineBarrier2(commands, &info);
}
// Stands for the host's drawing of depth. Leaves the image as the library wants it.
void draw(const Host& host, VkCommandBuffer commands, std::span<const gnomon::ShadowView> views, VkImage image,
          uint32_t widthPx, uint32_t heightPx, VkDeviceSize depths) {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, host.trace);
    for (const gnomon::ShadowView& v : views) {
        Push push = {std::to_array(v.clipFromWorld), host.address + depths, {v.xPx, v.yPx}, {v.widthPx, v.heightPx}};
        push.rowPx = widthPx;
        vkCmdPushConstants(commands, host.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(push), &push);
        vkCmdDispatch(commands, (v.widthPx + 7) / 8, (v.heightPx + 7) / 8, 1);
    }
    barrier(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const VkBufferImageCopy all = {depths, 0, 0, {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1}, {}, {widthPx, heightPx, 1}};
    vkCmdCopyBufferToImage(commands, host.data, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &all);
    barrier(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

void run(uint32_t deviceIndex, uint32_t poolEntries, const char* path) {
    Host host;
    createDevice(host, deviceIndex);
    std::unique_ptr<gnomon::Context> context;  // 2. The library's pipelines.
    gnomon::ContextDesc desc = {host.instance, host.physicalDevice, host.device, vkGetInstanceProcAddr};
    desc.queueFamilies = {&host.queueFamily, 1};
    check(gnomon::Context::create(desc, context));
    std::unique_ptr<gnomon::View> view;  // 3. The buffers of one camera.
    check(gnomon::View::create(*context, {kWidthPx, kHeightPx, kFramesInFlight, poolEntries, poolEntries}, view));
    createData(host);
    createPipelines(host, *context);
    gnomon::FrameDesc frame;
    gnomon::ShadowAtlas atlas = {VK_NULL_HANDLE, kAtlasPx, kAtlasPx};
    const VkImage depth = createDepth(host, kWidthPx, kHeightPx, VK_IMAGE_VIEW_TYPE_2D, frame.depth.view);
    const VkImage atlasImage = createDepth(host, kAtlasPx, kAtlasPx, VK_IMAGE_VIEW_TYPE_2D_ARRAY, atlas.view);
    std::vector<gnomon::Light> lights;
    std::vector<gnomon::ShadowView> shadowViews;
    createLights(lights, shadowViews);
    frame.view = {.widthPx = kWidthPx, .heightPx = kHeightPx, .lights = lights};
    const Mat4 viewFromWorld = lookAlong({0, 3.2f, 7.5f}, {0, -2.8f, -7.5f});
    const Mat4 clipFromView = perspective(0.4f * kWidthPx / kHeightPx, 0.4f);
    std::ranges::copy(viewFromWorld, frame.view.camera.viewFromWorld);
    std::ranges::copy(clipFromView, frame.view.camera.clipFromView);
    gnomon::ShadowView camera = {.widthPx = kWidthPx, .heightPx = kHeightPx};  // for draw()
    std::ranges::copy(multiply(clipFromView, viewFromWorld), camera.clipFromWorld);
    frame.shadowViews = shadowViews;
    frame.atlases = {&atlas, 1};
    VkQueue queue = VK_NULL_HANDLE;
    vkGetDeviceQueue(host.device, host.queueFamily, 0, &queue);
    const VkCommandPoolCreateInfo pool = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0, host.queueFamily};
    VkCommandBufferAllocateInfo allocate = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, {}, {}, 1};
    allocate.commandPool = host.make(vkCreateCommandPool, pool);
    for (; frame.frameNumber < kFrames; ++frame.frameNumber) {
        check(view->beginFrame(frame));  // 7. Frame frameNumber - framesInFlight has finished: here, all have.
        VkCommandBuffer commands = VK_NULL_HANDLE;  // a new one every frame, for brevity
        check(vkAllocateCommandBuffers(host.device, &allocate, &commands));
        const VkCommandBufferBeginInfo begin = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
        check(vkBeginCommandBuffer(commands, &begin));
        draw(host, commands, {&camera, 1}, depth, kWidthPx, kHeightPx, kDepths);  // 8. The G-buffer.
        view->recordHierarchicalDepth(commands);                                  // 9. No shadowmap is needed yet.
        view->recordFindLightsApproximate(commands);
        view->recordFindLightsAccurate(commands);
        draw(host, commands, shadowViews, atlasImage, kAtlasPx, kAtlasPx, kAtlasDepths);  // 10. The shadowmaps.
        view->recordGenerateShadows(commands);                                            // 11.
        const VkDescriptorSet sets[] = {view->listsSet(), view->receiversSet(), view->shadowmapsSet()};  // 12.
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, host.layout, 0, 3, sets, 0, nullptr);
        vkCmdPushConstants(commands, host.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, 8, &host.address);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, host.lightTiles);
        vkCmdDispatch(commands, view->tileCounts().width, view->tileCounts().height, 1);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, host.lightEvaluateTiles);
        vkCmdDispatchIndirect(commands, view->evaluateTilesBuffer(), view->evaluateCommandOffset());
        view->recordEndFrame(commands);  // 13.
        barrier(commands, depth, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
        check(vkEndCommandBuffer(commands));
        const VkSubmitInfo submit = {VK_STRUCTURE_TYPE_SUBMIT_INFO, nullptr, 0, nullptr, nullptr, 1, &commands};
        check(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE));
        check(vkQueueWaitIdle(queue));
    }
    gnomon::FrameStatistics s;  // 14.
    if (!view->statistics(kFrames - 1, s)) throw std::runtime_error("The last frame has no statistics.");
    std::printf("lights: %u given, %u visible, %u casting\n", s.lights.given, s.lights.visible, s.lights.casting);
    std::printf("lists: %u, slots: %u, evaluated: %u tiles\n", s.listEntries, s.visibilitySlots, s.evaluateTiles);
    std::FILE* file = std::fopen(path, "wb");
    if (file == nullptr) throw std::runtime_error("The picture could not be opened for writing.");
    std::fprintf(file, "P6\n%u %u\n255\n", kWidthPx, kHeightPx);
    for (uint32_t i = 0; i < kWidthPx * kHeightPx; ++i) std::fwrite(host.mapped + 4 * i, 1, 3, file);
    std::fclose(file);
}  // 15. The view goes before the context, both before the device: which, like the rest, goes with this process.
}  // namespace

int main(int argc, char** argv) try {
    const auto number = [&](int i) { return argc > i ? uint32_t(std::stoul(argv[i])) : 0u; };
    run(number(2), number(3), argc > 1 ? argv[1] : "minimal_host.ppm");
} catch (const std::exception& error) {
    std::fprintf(stderr, "minimal_host: %s\n", error.what());
    return 1;
}
