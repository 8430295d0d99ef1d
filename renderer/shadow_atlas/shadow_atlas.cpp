#include "renderer/shadow_atlas/shadow_atlas.h"

#include <algorithm>
#include <bit>
#include <glm/gtc/type_ptr.hpp>

namespace gnomon::renderer {

namespace {
constexpr std::uint32_t kShadowVertexSpirv[] = {
#include "shadow_vert.spv.h"
};
constexpr std::uint32_t kMaskedVertexSpirv[] = {
#include "shadow_masked_vert.spv.h"
};
constexpr std::uint32_t kShadowMaskedFragmentSpirv[] = {
#include "shadow_masked_frag.spv.h"
};

// Whether a view's image shows the world mirrored: its rows across, down and into the scene turn to the left.
bool isMirrored(const ShadowView& view) {
    const glm::mat4 m = glm::make_mat4(view.clipFromWorld);
    const auto row = [&](int i) { return glm::dvec3(m[0][i], m[1][i], m[2][i]); };
    const glm::dvec3 axis = view.orthographic ? -row(2) : row(3);  // reversed Z falls into the scene
    return glm::dot(glm::cross(row(0), row(1)), axis) < 0.0;
}

}  // namespace

std::uint32_t ShadowAtlasImage::defaultSizePx(const Device& device, std::uint32_t screenHeightPx) {
    const std::uint32_t wanted = screenHeightPx <= 1080 ? 4096u : 8192u;
    const VkPhysicalDeviceLimits& limits = device.limits();
    return std::min(wanted, std::bit_floor(std::min({limits.maxImageDimension2D, limits.maxFramebufferWidth,
                                                     limits.maxFramebufferHeight})));
}

ShadowAtlasImage::ShadowAtlasImage(const Device& device, const GpuScene& scene, std::uint32_t sizePx,
                                   std::uint32_t layers, const ShadowDrawing& drawing)
    : device_(device), sizePx_(sizePx) {
    if (!std::has_single_bit(sizePx)) throw GpuError("The shadow atlas' side must be a power of two.");
    const VkPhysicalDeviceLimits& limits = device.limits();
    if (sizePx > std::min(limits.maxFramebufferWidth, limits.maxFramebufferHeight)) {
        throw GpuError("'" + device.info().name + "' draws at most " + std::to_string(limits.maxFramebufferWidth) +
                       " pixels wide; choose a smaller shadow atlas.");
    }
    setDrawing(drawing);
    ImageDesc desc;
    desc.name = "shadow atlas";
    desc.format = kFormat;
    desc.width = desc.height = sizePx;
    desc.layers = layers;
    desc.arrayView = true;
    desc.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                 VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    image_ = GpuImage(device, desc);
    device.submitAndWait([&](VkCommandBuffer commands) {
        VkImageMemoryBarrier2 barrier = imageBarrier(image_, VK_IMAGE_LAYOUT_UNDEFINED, access::kNone,
                                                     VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, access::kTransferWrite);
        recordBarriers(commands, {&barrier, 1});
        const VkClearDepthStencilValue unoccluded{0.0f, 0};
        vkCmdClearDepthStencilImage(commands, image_.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &unoccluded, 1,
                                    &barrier.subresourceRange);
        barrier = imageBarrier(image_, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, access::kTransferWrite,
                               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, access::kSampled);
        recordBarriers(commands, {&barrier, 1});
    });

    const VkDescriptorSetLayout sets[] = {scene.sceneSetLayout(), scene.materialSetLayout()};
    layout_ = makePipelineLayout(device, sets, VK_SHADER_STAGE_VERTEX_BIT, sizeof(glm::mat4));
    GraphicsPipelineDesc pipeline;
    pipeline.vertexSpirv = kShadowVertexSpirv;
    pipeline.layout = layout_;
    pipeline.depthFormat = kFormat;
    pipeline.dynamicCull = true;
    pipeline.dynamicDepthBias = true;
    opaque_ = makeGraphicsPipeline(device, pipeline);
    pipeline.vertexSpirv = kMaskedVertexSpirv;
    pipeline.fragmentSpirv = kShadowMaskedFragmentSpirv;
    masked_ = makeGraphicsPipeline(device, pipeline);
}

void ShadowAtlasImage::setDrawing(const ShadowDrawing& drawing) {
    if (drawing.bias.clamp != 0.0f && device_.features().depthBiasClamp == VK_FALSE)
        throw GpuError("'" + device_.info().name + "' cannot clamp a depth bias; leave the clamp out.");
    if (drawing_ == drawing) return;
    drawing_ = drawing;
    drawn_.clear();
    planned_.clear();
}

ShadowAtlasImage::Key ShadowAtlasImage::keyOf(const ShadowLight& light, const PlannedView& view) {
    return {light.position,
            light.direction,
            light.rangeMetres,
            light.outerConeAngle,
            light.kind,
            view.cascade.centre,
            view.cascade.halfExtent,
            view.cascade.depth,
            view.face,
            view.x,
            view.y,
            view.layer,
            view.size,
            view.guardTexels};
}

void ShadowAtlasImage::prepare(const GpuScene& scene, std::span<const ShadowLight> lights, ShadowPlan& plan) {
    statistics_ = {};
    tasks_.clear();
    ranges_.clear();
    std::unordered_map<std::uint64_t, Drawn> now;
    now.reserve(plan.views.size());
    std::uint32_t candidatesOf = kNone;
    for (PlannedView& view : plan.views) {
        const ShadowLight& light = lights[view.light];
        const std::uint64_t id = std::uint64_t{view.light} * 8 + view.face;
        const Key key = keyOf(light, view);
        const auto volume = [&] { return cullVolumeOf(glm::make_mat4(view.view.clipFromWorld), scene.origin()); };
        const auto old = drawn_.find(id);
        // An old key may only stand if nothing else was drawn over its square. That holds here: squares of one plan
        // never overlap, and a square that was not in the last plan is not in drawn_.
        const bool cached = old != drawn_.end() && old->second.key == key &&
                            (old->second.castersRevision == scene.castersRevision() ||
                             !scene.changedSince(old->second.castersRevision, volume()));
        now.emplace(id, Drawn{key, scene.castersRevision()});
        view.view.changed = !cached;
        if (cached) {
            ++statistics_.viewsCached;
            continue;
        }
        if (candidatesOf != view.light) {
            candidatesOf = view.light;
            candidates_.clear();
            scene.candidates(light.position, light.rangeMetres, candidates_);
        }
        const auto first = static_cast<std::uint32_t>(ranges_.size());
        std::vector<DrawRange> visible;
        scene.cull(volume(), candidates_, visible);
        ranges_.insert(ranges_.end(), visible.begin(), visible.end());
        tasks_.push_back({&view, first, static_cast<std::uint32_t>(ranges_.size()) - first});
        statistics_.drawnViews.push_back(static_cast<std::uint32_t>(&view - plan.views.data()));
        ++statistics_.viewsDrawn;
    }
    planned_ = std::move(now);
}

void ShadowAtlasImage::drawView(VkCommandBuffer commands, const GpuScene& scene, const Task& task,
                                ShadowAtlasStatistics& statistics) const {
    const PlannedView& view = *task.view;
    const VkRect2D rect{{static_cast<int>(view.x), static_cast<int>(view.y)}, {view.size, view.size}};
    const VkViewport viewport{static_cast<float>(view.x),
                              static_cast<float>(view.y),
                              static_cast<float>(view.size),
                              static_cast<float>(view.size),
                              0.0f,
                              1.0f};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &rect);
    VkClearAttachment clear{};
    clear.aspectMask = VK_IMAGE_ASPECT_DEPTH_BIT;
    const VkClearRect clearRect{rect, 0, 1};
    vkCmdClearAttachments(commands, 1, &clear, 1, &clearRect);
    vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(view.view.clipFromWorld),
                       view.view.clipFromWorld);
    VkPipeline bound = VK_NULL_HANDLE;
    std::uint32_t material = kNone;
    const bool mirrored = isMirrored(view.view);
    for (std::uint32_t r = task.firstRange; r < task.firstRange + task.rangeCount; ++r) {
        const DrawRange& range = ranges_[r];
        const DrawItem& item = scene.items()[range.item];
        const std::uint32_t itemMaterial = item.material;
        const MaterialTraits& traits = scene.materials()[itemMaterial];
        const bool masked = traits.masked;
        const VkPipeline wanted = masked ? masked_ : opaque_;
        if (wanted != bound) vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, bound = wanted);
        if (masked && itemMaterial != material) {
            material = itemMaterial;
            const VkDescriptorSet set = scene.materialSet(material);
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 1, 1, &set, 0, nullptr);
        }
        const bool frontsLeftOut = !drawing_.subsurfaceFronts && traits.subsurface && !traits.doubleSided;
        vkCmdSetCullMode(commands, frontsLeftOut ? VK_CULL_MODE_FRONT_BIT : VK_CULL_MODE_NONE);
        vkCmdSetFrontFace(commands,
                          item.mirrored != mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
        vkCmdDrawIndexed(commands, range.triangleCount * 3, 1, range.firstTriangle * 3, 0, range.item);
        ++statistics.draws;
        statistics.triangles += range.triangleCount;
    }
}

void ShadowAtlasImage::drawLayer(VkCommandBuffer commands, const GpuScene& scene, std::uint32_t layer,
                                 ShadowAtlasStatistics& statistics) const {
    const bool any = std::any_of(tasks_.begin(), tasks_.end(), [&](const Task& t) { return t.view->layer == layer; });
    if (!any) return;
    VkRenderingAttachmentInfo depth{};
    depth.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    depth.imageView = image_.layerView(layer);
    depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depth.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    depth.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    info.renderArea.extent = {sizePx_, sizePx_};
    info.layerCount = 1;
    info.pDepthAttachment = &depth;
    vkCmdBeginRendering(commands, &info);
    const VkDescriptorSet sceneSet = scene.sceneSet();
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &sceneSet, 0, nullptr);
    vkCmdBindIndexBuffer(commands, scene.indexBuffer(), 0, VK_INDEX_TYPE_UINT32);
    const HardwareBias& bias = drawing_.bias;
    vkCmdSetDepthBiasEnable(commands, bias.none() ? VK_FALSE : VK_TRUE);
    // Reversed Z: farther from the light is less.
    vkCmdSetDepthBias(commands, -bias.constantFactor, -bias.clamp, -bias.slopeFactor);
    for (const Task& task : tasks_) {
        if (task.view->layer == layer) drawView(commands, scene, task, statistics);
    }
    vkCmdEndRendering(commands);
}

ShadowAtlasStatistics ShadowAtlasImage::record(VkCommandBuffer commands, const GpuScene& scene) {
    ShadowAtlasStatistics statistics = statistics_;
    drawn_ = std::move(planned_);
    if (!tasks_.empty()) {
        constexpr Access kReaders{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_NONE};
        VkImageMemoryBarrier2 barrier = imageBarrier(image_, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kReaders,
                                                     VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, access::kDepthWrite);
        recordBarriers(commands, {&barrier, 1});
        for (std::uint32_t layer = 0; layer < image_.desc().layers; ++layer)
            drawLayer(commands, scene, layer, statistics);
        barrier = imageBarrier(image_, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, access::kDepthWrite,
                               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, access::kSampled);
        recordBarriers(commands, {&barrier, 1});
    }
    return statistics;
}

}  // namespace gnomon::renderer
