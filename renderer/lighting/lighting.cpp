#include "renderer/lighting/lighting.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "renderer/gpu/error.h"
#include "renderer/gpu/timeline_scope.h"
#include "renderer/lighting/lighting_data.h"

namespace gnomon::renderer {
namespace {

// Equal inner and outer angles make a sharp edge: it is this share of the cone's versine wide.
constexpr double kLeastEdge = 1e-4;

double versineOf(double angle) {
    const double half = std::sin(0.5 * angle);
    return 2.0 * half * half;
}

HostLight hostLightOf(const SceneLight& light) {
    HostLight h = {};
    const glm::vec3 intensity = light.colour * light.intensity;
    h.intensity = {intensity.x, intensity.y, intensity.z};
    if (light.kind != LightKind::Directional && !light.rangeIsGuessed) {
        const double range = static_cast<double>(light.rangeMetres);
        h.windowPerSquareMetre = static_cast<float>(1.0 / std::max(range * range, 1e-30));
    }
    if (light.kind == LightKind::Spot) {
        const double outer = versineOf(static_cast<double>(light.outerConeAngle));
        const double inner = versineOf(static_cast<double>(std::min(light.innerConeAngle, light.outerConeAngle)));
        h.coneVersine = static_cast<float>(outer);
        h.coneScale = static_cast<float>(1.0 / std::max(outer - inner, kLeastEdge * outer));
    }
    return h;
}

template <typename T>
std::span<const std::byte> bytesOf(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

}  // namespace

Lighting::Lighting(const Device& device, LightingPipelines& pipelines, const Scene& scene, const GBuffer& gbuffer,
                   PictureFormat format)
    : device_(device), pipelines_(pipelines), format_(format) {
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
    pool_ = makeDescriptorPool(device_, 1, kLightingSetTypes);
    ownSet_ = allocateSet(device_, pool_, pipelines_.ownSet());
    resize(gbuffer);
}

void Lighting::resize(const GBuffer& gbuffer) {
    const VkExtent2D extent = gbuffer.extent();
    const bool floats = format_ == PictureFormat::Float;
    picture_ = GpuImage(
        device_, {.name = "picture",
                  .format = floats ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R16G16B16A16_SFLOAT,
                  .width = extent.width,
                  .height = extent.height,
                  .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    pictureReady_ = false;
    writeSet(gbuffer);
}

void Lighting::writeSet(const GBuffer& gbuffer) {
    const GBuffer::Channel channels[] = {GBuffer::BaseColour, GBuffer::Normal, GBuffer::MaterialData,
                                         GBuffer::Emissive};
    for (std::uint32_t i = 0; i < std::size(channels); ++i) {
        writeImage(device_, ownSet_, i, kLightingSetTypes[i], gbuffer.view(channels[i]), VK_NULL_HANDLE);
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

void Lighting::bind(VkCommandBuffer commands, const View& view, LightingKind kind, VkPipeline pipeline) {
    const VkDescriptorSet first[] = {view.listsSet(), view.receiversSet(), view.shadowmapsSet()};
    const VkPipelineLayout layout = pipelines_.layoutOf(kind);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, kind == LightingKind::Deferred ? 2 : 3,
                            first, 0, nullptr);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 3, 1, &ownSet_, 0, nullptr);
}

void Lighting::recordDeferred(VkCommandBuffer commands, const View& view, const ShadowSettings& settings,
                              Timeline* timeline) {
    beginPicture(commands);
    const VkExtent2D tiles = view.tileCounts();
    const VkPipeline main = pipelines_.get(LightingKind::Deferred, settings, {}, format_);
    const VkPipeline evaluate = pipelines_.get(LightingKind::Evaluate, settings, {}, format_);
    {
        const TimelineScope scope(device_, timeline, commands, "lighting", Phase::Lighting, RowKind::Compute);
        bind(commands, view, LightingKind::Deferred, main);
        vkCmdDispatch(commands, tiles.width, tiles.height, 1);
    }
    const TimelineScope scope(device_, timeline, commands, "lighting_evaluate", Phase::Lighting, RowKind::Compute);
    bind(commands, view, LightingKind::Evaluate, evaluate);
    vkCmdDispatchIndirect(commands, view.evaluateTilesBuffer(), view.evaluateCommandOffset());
}

void Lighting::recordInline(VkCommandBuffer commands, const View& view, LightingKind kind,
                            const ShadowSettings& settings, const InlineVariant& variant, Timeline* timeline) {
    beginPicture(commands);
    const VkExtent2D tiles = view.tileCounts();
    const VkPipeline pipeline = pipelines_.get(kind, settings, variant, format_);
    const char* name = kind == LightingKind::Inline ? "lighting_inline" : "lighting_unshadowed";
    const TimelineScope scope(device_, timeline, commands, name, Phase::Lighting, RowKind::Compute);
    bind(commands, view, kind, pipeline);
    vkCmdDispatch(commands, tiles.width, tiles.height, 1);
}

std::vector<MemoryRow> Lighting::memoryRows() const {
    return {{"picture", picture_.bytes()}, {"host_lights", hostLights_.bytes()}};
}

}  // namespace gnomon::renderer
