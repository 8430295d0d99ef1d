#include "renderer/lighting/lighting.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "gpu_interface/numbers.h"
#include "renderer/gpu/error.h"
#include "renderer/lighting/lighting_data.h"

namespace gnomon::renderer {
namespace {

constexpr std::uint32_t kDeferredSpirv[] = {
#include "lighting_deferred.spv.h"
};
constexpr std::uint32_t kEvaluateSpirv[] = {
#include "lighting_evaluate.spv.h"
};
constexpr std::uint32_t kInlineSpirv[] = {
#include "lighting_inline.spv.h"
};

HostLight hostLightOf(const SceneLight& light) {
    HostLight h = {};
    const glm::vec3 intensity = light.colour * light.intensity;
    h.intensity = {intensity.x, intensity.y, intensity.z};
    h.coneOffset = 1.0f;
    if (light.kind == LightKind::Spot) {
        const float outer = std::cos(light.outerConeAngle);
        const float inner = std::cos(std::min(light.innerConeAngle, light.outerConeAngle));
        h.coneScale = 1.0f / std::max(inner - outer, 1e-3f);
        h.coneOffset = -outer * h.coneScale;
    }
    return h;
}

template <typename T>
std::span<const std::byte> bytesOf(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

}  // namespace

Lighting::Lighting(const Device& device, const Context& context, const Scene& scene, const GBuffer& gbuffer,
                   bool quantiseInline)
    : device_(device) {
    const VkExtent2D extent = gbuffer.extent();
    picture_ = GpuImage(
        device, {.name = "picture",
                 .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                 .width = extent.width,
                 .height = extent.height,
                 .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    std::vector<HostLight> lights(std::max<std::size_t>(scene.lights.size(), 1));
    std::transform(scene.lights.begin(), scene.lights.end(), lights.begin(), hostLightOf);
    hostLights_ = Buffer(device, "host_lights", lights.size() * sizeof(HostLight),
                         VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const std::vector<SceneConstants> constants = {
        {{scene.skyColour.x, scene.skyColour.y, scene.skyColour.z, 0.0f},
         {scene.groundColour.x, scene.groundColour.y, scene.groundColour.z, 0.0f}}};
    sceneConstants_ = Buffer(device, "scene_constants", sizeof(SceneConstants),
                             VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    Uploader uploader(device);
    uploader.buffer(hostLights_, bytesOf(lights));
    uploader.buffer(sceneConstants_, bytesOf(constants));
    uploader.finish();
    createSet(gbuffer);

    const VkDescriptorSetLayout main[] = {context.listsSetLayout(), context.receiversSetLayout(), emptyLayout_,
                                          ownLayout_};
    const VkDescriptorSetLayout evaluate[] = {context.listsSetLayout(), context.receiversSetLayout(),
                                              context.shadowmapsSetLayout(), ownLayout_};
    mainLayout_ = makePipelineLayout(device, main);
    evaluateLayout_ = makePipelineLayout(device, evaluate);
    std::vector<std::uint32_t> constantsOf(gpu::kSpecFirstFree + 1, 0u);
    std::ranges::copy(context.specializationValues(), constantsOf.begin());
    constantsOf[gpu::kSpecFirstFree] = quantiseInline ? 1u : 0u;
    // A device with one size need not, and perhaps cannot, be asked for it.
    const bool oneSize = device.info().minSubgroupSize == device.info().maxSubgroupSize;
    const std::uint32_t lanes = oneSize ? 0 : context.subgroupSize();
    deferred_ = makeComputePipeline(device, kDeferredSpirv, mainLayout_, constantsOf, lanes);
    evaluate_ = makeComputePipeline(device, kEvaluateSpirv, evaluateLayout_, constantsOf, lanes);
    inline_ = makeComputePipeline(device, kInlineSpirv, evaluateLayout_, constantsOf, lanes);
    constantsOf[gpu::kSpecProvider] = gpu::kProviderOff;
    unshadowed_ = makeComputePipeline(device, kInlineSpirv, evaluateLayout_, constantsOf, lanes);
}

void Lighting::createSet(const GBuffer& gbuffer) {
    constexpr VkDescriptorType kSampled = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    const VkDescriptorType types[] = {kSampled,
                                      kSampled,
                                      kSampled,
                                      kSampled,
                                      VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                      VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER};
    ownLayout_ = makeSetLayout(device_, types, VK_SHADER_STAGE_COMPUTE_BIT);
    emptyLayout_ = makeSetLayout(device_, {}, VK_SHADER_STAGE_COMPUTE_BIT);
    pool_ = makeDescriptorPool(device_, 1, types);
    ownSet_ = allocateSet(device_, pool_, ownLayout_);
    const GBuffer::Channel channels[] = {GBuffer::BaseColour, GBuffer::Normal, GBuffer::MaterialData,
                                         GBuffer::Emissive};
    for (std::uint32_t i = 0; i < std::size(channels); ++i) {
        writeImage(device_, ownSet_, i, kSampled, gbuffer.view(channels[i]), VK_NULL_HANDLE);
    }
    writeImage(device_, ownSet_, 4, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, picture_.view(), VK_NULL_HANDLE,
               VK_IMAGE_LAYOUT_GENERAL);
    writeBuffer(device_, ownSet_, 5, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, hostLights_.handle());
    writeBuffer(device_, ownSet_, 6, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, sceneConstants_.handle());
}

// The picture before may still be read by a copy or written by the last frame's lighting.
void Lighting::beginPicture(VkCommandBuffer commands) {
    const VkImageLayout from = pictureReady_ ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_UNDEFINED;
    pictureReady_ = true;
    const Access before = {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
    const VkImageMemoryBarrier2 barrier =
        imageBarrier(picture_, from, before, VK_IMAGE_LAYOUT_GENERAL, access::kComputeWrite);
    recordBarriers(commands, std::span(&barrier, 1));
}

void Lighting::bind(VkCommandBuffer commands, const View& view, VkPipeline pipeline, VkPipelineLayout layout,
                    bool shadowmaps) {
    const VkDescriptorSet first[] = {view.listsSet(), view.receiversSet(), view.shadowmapsSet()};
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, shadowmaps ? 3 : 2, first, 0, nullptr);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 3, 1, &ownSet_, 0, nullptr);
}

void Lighting::recordDeferred(VkCommandBuffer commands, const View& view, GpuTimer* timer) {
    beginPicture(commands);
    const VkExtent2D tiles = view.tileCounts();
    {
        const GpuScope scope(timer, commands, "lighting");
        bind(commands, view, deferred_, mainLayout_, false);
        vkCmdDispatch(commands, tiles.width, tiles.height, 1);
    }
    const GpuScope scope(timer, commands, "lighting_evaluate");
    bind(commands, view, evaluate_, evaluateLayout_, true);
    vkCmdDispatchIndirect(commands, view.evaluateTilesBuffer(), view.evaluateCommandOffset());
}

void Lighting::recordInline(VkCommandBuffer commands, const View& view, LightingVariant variant, GpuTimer* timer) {
    beginPicture(commands);
    const VkExtent2D tiles = view.tileCounts();
    const bool shadowed = variant == LightingVariant::Inline;
    const GpuScope scope(timer, commands, shadowed ? "lighting_inline" : "lighting_unshadowed");
    bind(commands, view, shadowed ? inline_ : unshadowed_, evaluateLayout_, true);
    vkCmdDispatch(commands, tiles.width, tiles.height, 1);
}

std::vector<MemoryRow> Lighting::memoryRows() const {
    return {{"picture", picture_.bytes()}, {"host_lights", hostLights_.bytes()}};
}

}  // namespace gnomon::renderer
