#include "renderer/gbuffer/gbuffer.h"

#include <glm/gtc/type_ptr.hpp>

namespace gnomon::renderer {

namespace {

constexpr std::uint32_t kGBufferVertexSpirv[] = {
#include "gbuffer_vert.spv.h"
};
constexpr std::uint32_t kGBufferFragmentSpirv[] = {
#include "gbuffer_frag.spv.h"
};
constexpr std::uint32_t kMaskedSpirv[] = {
#include "gbuffer_masked_frag.spv.h"
};

struct Push {
    glm::mat4 clipFromView;
    glm::vec4 viewFromWorldRows[3];
    glm::vec4 eye;
};

constexpr const char* kNames[GBuffer::kColourCount] = {
    "gbuffer base colour", "gbuffer normal",         "gbuffer material",   "gbuffer emissive",
    "gbuffer face normal", "gbuffer receiver flags", "gbuffer triangle id"};

}  // namespace

GBufferCamera gbufferCameraOf(const Camera& camera) {
    const glm::mat4 viewFromWorld = glm::make_mat4(camera.viewFromWorld);
    const glm::mat4 clipFromView = glm::make_mat4(camera.clipFromView);
    const glm::mat3 worldFromViewRotation = glm::transpose(glm::mat3(viewFromWorld));
    const glm::mat4 rows = glm::transpose(clipFromView);
    GBufferCamera out;
    out.viewFromWorld = viewFromWorld;
    out.clipFromView = clipFromView;
    out.clipFromWorld = clipFromView * viewFromWorld;
    out.deviceDepth = camera.deviceDepth;
    // The row of the clip transform that grows into the scene: w for perspective, +-z for orthographic views.
    glm::vec3 inward(rows[3]);
    if (glm::length(inward) > 0.0f) {
        out.eye = glm::vec4(worldFromViewRotation * -glm::vec3(viewFromWorld[3]), 1.0f);
    } else {
        inward = glm::vec3(rows[2]) * (camera.deviceDepth == DeviceDepth::ReversedZ ? -1.0f : 1.0f);
        out.eye = glm::vec4(worldFromViewRotation * -glm::normalize(inward), 0.0f);
    }
    // Right, down, inward are right-handed in a view that is not a mirror image.
    out.mirrored = glm::dot(glm::cross(glm::vec3(rows[0]), glm::vec3(rows[1])), inward) < 0.0f;
    return out;
}

GBuffer::GBuffer(const Device& device, const GpuScene& scene, std::uint32_t width, std::uint32_t height)
    : device_(device) {
    const VkDescriptorSetLayout sets[] = {scene.sceneSetLayout(), scene.materialSetLayout()};
    layout_ = makePipelineLayout(device, sets, VK_SHADER_STAGE_VERTEX_BIT, sizeof(Push));
    GraphicsPipelineDesc desc;
    desc.vertexSpirv = kGBufferVertexSpirv;
    desc.fragmentSpirv = kGBufferFragmentSpirv;
    desc.layout = layout_;
    desc.colourFormats.assign(kFormats.begin(), kFormats.end());
    desc.depthFormat = kDepthFormat;
    desc.dynamicCull = desc.dynamicDepthCompare = true;
    opaque_ = makeGraphicsPipeline(device, desc);
    desc.fragmentSpirv = kMaskedSpirv;
    masked_ = makeGraphicsPipeline(device, desc);
    resize(width, height);
}

void GBuffer::resize(std::uint32_t width, std::uint32_t height) {
    const VkPhysicalDeviceLimits& limits = device_.limits();
    if (width > limits.maxFramebufferWidth || height > limits.maxFramebufferHeight) {
        throw GpuError("'" + device_.info().name + "' draws at most " + std::to_string(limits.maxFramebufferWidth) +
                       "x" + std::to_string(limits.maxFramebufferHeight) + " pixels; choose a smaller resolution.");
    }
    ImageDesc desc;
    desc.width = width;
    desc.height = height;
    for (std::uint32_t c = 0; c < kColourCount; ++c) {
        desc.name = kNames[c];
        desc.format = kFormats[c];
        desc.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
        colours_[c] = GpuImage(device_, desc);
    }
    desc.name = "gbuffer depth";
    desc.format = kDepthFormat;
    desc.usage =
        VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    depth_ = GpuImage(device_, desc);
    extent_ = {width, height};
}

void GBuffer::recordLayouts(VkCommandBuffer commands, bool forDrawing) const {
    // Whatever read or copied the last frame's images must be done; their contents are not needed any more.
    constexpr Access kReaders{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_NONE};
    constexpr VkImageLayout kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    std::vector<VkImageMemoryBarrier2> barriers;
    auto add = [&](const GpuImage& image, VkImageLayout drawn, Access writes) {
        barriers.push_back(forDrawing ? imageBarrier(image, VK_IMAGE_LAYOUT_UNDEFINED, kReaders, drawn, writes)
                                      : imageBarrier(image, drawn, writes, kRead, access::kSampled));
    };
    for (const GpuImage& colour : colours_) add(colour, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, access::kColourWrite);
    add(depth_, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, access::kDepthWrite);
    recordBarriers(commands, barriers);
}

void GBuffer::beginRendering(VkCommandBuffer commands, VkExtent2D active, DeviceDepth deviceDepth) const {
    std::array<VkRenderingAttachmentInfo, kColourCount> attachments{};
    for (std::uint32_t c = 0; c < kColourCount; ++c) {
        attachments[c].sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
        attachments[c].imageView = colours_[c].view();
        attachments[c].imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        attachments[c].loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        attachments[c].storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    }
    attachments[TriangleId].clearValue.color.uint32[0] = 0xFFFFFFFFu;
    VkRenderingAttachmentInfo depth = attachments[0];
    depth.imageView = depth_.view();
    depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depth.clearValue.depthStencil.depth = deviceDepth == DeviceDepth::ReversedZ ? 0.0f : 1.0f;
    VkRenderingInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    // The clear covers the whole image, also beyond the active extent.
    info.renderArea.extent = extent_;
    info.layerCount = 1;
    info.colorAttachmentCount = kColourCount;
    info.pColorAttachments = attachments.data();
    info.pDepthAttachment = &depth;
    vkCmdBeginRendering(commands, &info);
    const VkViewport viewport{0.0f, 0.0f, static_cast<float>(active.width), static_cast<float>(active.height),
                              0.0f, 1.0f};
    const VkRect2D scissor{{0, 0}, active};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &scissor);
}

GBufferStatistics GBuffer::drawRanges(VkCommandBuffer commands, const GpuScene& scene,
                                      const GBufferCamera& camera) const {
    GBufferStatistics statistics;
    const glm::mat4 rows = glm::transpose(camera.viewFromWorld);
    const Push push{camera.clipFromView, {rows[0], rows[1], rows[2]}, camera.eye};
    vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(push), &push);
    vkCmdSetDepthCompareOp(commands,
                           camera.deviceDepth == DeviceDepth::ReversedZ ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS);
    const VkDescriptorSet sceneSet = scene.sceneSet();
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &sceneSet, 0, nullptr);
    VkPipeline bound = VK_NULL_HANDLE;
    std::uint32_t material = kNone, item = kNone;
    for (const DrawRange& range : ranges_) {
        if (range.item != item) {
            item = range.item;
            const DrawItem& drawItem = scene.items()[item];
            const MaterialTraits& traits = scene.materials()[drawItem.material];
            const VkPipeline wanted = traits.masked ? masked_ : opaque_;
            if (wanted != bound) vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, bound = wanted);
            if (drawItem.material != material) {
                material = drawItem.material;
                const VkDescriptorSet set = scene.materialSet(material);
                vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 1, 1, &set, 0, nullptr);
            }
            vkCmdSetCullMode(commands, traits.doubleSided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT);
            const bool turned = drawItem.mirrored != camera.mirrored;
            vkCmdSetFrontFace(commands, turned ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
        }
        vkCmdDraw(commands, range.triangleCount * 3, 1, range.firstTriangle * 3, item);
        ++statistics.draws;
        statistics.triangles += range.triangleCount;
    }
    return statistics;
}

GBufferStatistics GBuffer::record(VkCommandBuffer commands, const GpuScene& scene, const GBufferCamera& camera,
                                  std::uint32_t activeWidth, std::uint32_t activeHeight) {
    const VkExtent2D active{activeWidth != 0 ? activeWidth : extent_.width,
                            activeHeight != 0 ? activeHeight : extent_.height};
    if (active.width > extent_.width || active.height > extent_.height) {
        throw GpuError("The active extent is larger than the G-buffer; resize it first.");
    }
    ranges_.clear();
    scene.cull(cullVolumeOf(camera.clipFromWorld, scene.origin()), ranges_);
    recordLayouts(commands, true);
    beginRendering(commands, active, camera.deviceDepth);
    const GBufferStatistics statistics = drawRanges(commands, scene, camera);
    vkCmdEndRendering(commands);
    recordLayouts(commands, false);
    return statistics;
}

std::vector<MemoryRow> GBuffer::memoryRows() const {
    std::vector<MemoryRow> rows;
    for (const GpuImage& colour : colours_) rows.push_back({colour.desc().name, colour.bytes()});
    rows.push_back({depth_.desc().name, depth_.bytes()});
    return rows;
}

}  // namespace gnomon::renderer
