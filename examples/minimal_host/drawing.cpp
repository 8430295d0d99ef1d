#include "drawing.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace host {
namespace {

constexpr std::uint32_t kVertexSpirv[] = {
#include "scene_vert.spv.h"
};
constexpr std::uint32_t kFragmentSpirv[] = {
#include "gbuffer_frag.spv.h"
};

// The library's own pipelines read all of the host's images in this way, and so does the lighting here. A host that
// lights in fragment shaders adds that stage.
constexpr Use kSampled = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
// Readers of an earlier frame, on the same queue: writing must wait for them, but they left nothing to make visible.
constexpr Use kReadersBefore = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_NONE};
constexpr Use kDepthTest = {
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
constexpr Use kColourWrite = {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};

constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
constexpr VkFormat kFaceNormalFormat = VK_FORMAT_R16G16_UINT;  // octahedral; the one format that the library reads

VkRenderingAttachmentInfo attachment(const Image& image, VkImageLayout layout, VkAttachmentLoadOp loadOp) {
    VkRenderingAttachmentInfo info = {VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    info.imageView = image.view;
    info.imageLayout = layout;
    info.loadOp = loadOp;
    info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    return info;  // clears to 0: with reversed z nothing is there, and nothing is in the way of the light
}

}  // namespace

Drawing::Drawing(Device& device, std::uint32_t widthPx, std::uint32_t heightPx, std::uint32_t atlasPx)
    : device_(device), extent_{widthPx, heightPx}, atlasExtent_{atlasPx, atlasPx} {
    constexpr VkImageUsageFlags kDepthUsage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    depth_ = device.makeImage(kDepthFormat, widthPx, heightPx, kDepthUsage);
    faceNormals_ = device.makeImage(kFaceNormalFormat, widthPx, heightPx,
                                    VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    // Of one layer, and still seen through an array view.
    atlas_ = device.makeImage(kDepthFormat, atlasPx, atlasPx, kDepthUsage, VK_IMAGE_VIEW_TYPE_2D_ARRAY);

    const std::vector<Vertex> triangles = sceneTriangles();
    vertexCount_ = static_cast<std::uint32_t>(triangles.size());
    vertices_ = device.makeBuffer(triangles.size() * sizeof(Vertex), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    std::memcpy(vertices_.mapped, triangles.data(), triangles.size() * sizeof(Vertex));

    layout_ = device.makePipelineLayout({}, sizeof(Mat4));
    gbufferPipeline_ = makePipeline(true);
    shadowPipeline_ = makePipeline(false);
}

VkPipeline Drawing::makePipeline(bool gbuffer) {
    VkPipelineShaderStageCreateInfo stages[2] = {{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO},
                                                 {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO}};
    stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
    stages[0].module = device_.makeShader(kVertexSpirv);
    stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
    if (gbuffer) stages[1].module = device_.makeShader(kFragmentSpirv);
    stages[0].pName = stages[1].pName = "main";

    const VkVertexInputBindingDescription binding = {0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX};
    const VkVertexInputAttributeDescription attributes[] = {
        {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
        {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, normal)}};
    VkPipelineVertexInputStateCreateInfo vertices = {VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    vertices.vertexBindingDescriptionCount = 1;
    vertices.pVertexBindingDescriptions = &binding;
    vertices.vertexAttributeDescriptionCount = 2;
    vertices.pVertexAttributeDescriptions = attributes;

    VkPipelineInputAssemblyStateCreateInfo assembly = {VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport = {VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = viewport.scissorCount = 1;
    // No depth bias, in no pipeline: the library moves the receivers itself, by Light::biasMetres. And no culling:
    // shadowmaps hold what the camera sees, from both sides.
    VkPipelineRasterizationStateCreateInfo raster = {VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo samples = {VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineDepthStencilStateCreateInfo depth = {VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = depth.depthWriteEnable = VK_TRUE;
    depth.depthCompareOp = VK_COMPARE_OP_GREATER;  // reversed z
    VkPipelineColorBlendAttachmentState written = {};
    written.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT;
    VkPipelineColorBlendStateCreateInfo blend = {VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = gbuffer ? 1 : 0;
    blend.pAttachments = &written;
    const VkDynamicState dynamicStates[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic = {VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = dynamicStates;
    VkPipelineRenderingCreateInfo rendering = {VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.colorAttachmentCount = gbuffer ? 1 : 0;
    rendering.pColorAttachmentFormats = &kFaceNormalFormat;
    rendering.depthAttachmentFormat = kDepthFormat;

    VkGraphicsPipelineCreateInfo info = {VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
    info.stageCount = gbuffer ? 2 : 1;
    info.pStages = stages;
    info.pVertexInputState = &vertices;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = layout_;
    VkPipeline pipeline = VK_NULL_HANDLE;
    check(vkCreateGraphicsPipelines(device_.handle, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
          "vkCreateGraphicsPipelines");
    device_.own([&device = device_, pipeline] { vkDestroyPipeline(device.handle, pipeline, nullptr); });
    return pipeline;
}

void Drawing::drawScene(VkCommandBuffer commands, const VkRect2D& rectangle, const float* clipFromWorld) {
    const VkViewport viewport = {static_cast<float>(rectangle.offset.x),
                                 static_cast<float>(rectangle.offset.y),
                                 static_cast<float>(rectangle.extent.width),
                                 static_cast<float>(rectangle.extent.height),
                                 0,
                                 1};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &rectangle);
    vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(Mat4), clipFromWorld);
    const VkDeviceSize offset = 0;
    vkCmdBindVertexBuffers(commands, 0, 1, &vertices_.handle, &offset);
    vkCmdDraw(commands, vertexCount_, 1, 0, 0);
}

void Drawing::recordGBuffer(VkCommandBuffer commands, const Mat4& clipFromWorld) {
    // What the frame before left there may be forgotten: hence UNDEFINED.
    imageBarrier(commands, depth_, kReadersBefore, VK_IMAGE_LAYOUT_UNDEFINED, kDepthTest,
                 VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    imageBarrier(commands, faceNormals_, kReadersBefore, VK_IMAGE_LAYOUT_UNDEFINED, kColourWrite,
                 VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);

    // Pixels without geometry keep exactly the far value, which is 0 with reversed z: the library takes them for
    // background. Their face normal is never read.
    const VkRenderingAttachmentInfo depth =
        attachment(depth_, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_CLEAR);
    const VkRenderingAttachmentInfo colour =
        attachment(faceNormals_, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_CLEAR);
    VkRenderingInfo info = {VK_STRUCTURE_TYPE_RENDERING_INFO};
    info.renderArea = {{0, 0}, extent_};
    info.layerCount = 1;
    info.colorAttachmentCount = 1;
    info.pColorAttachments = &colour;
    info.pDepthAttachment = &depth;
    vkCmdBeginRendering(commands, &info);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, gbufferPipeline_);
    drawScene(commands, info.renderArea, clipFromWorld.data());
    vkCmdEndRendering(commands);

    imageBarrier(commands, depth_, kDepthTest, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, kSampled,
                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    imageBarrier(commands, faceNormals_, kColourWrite, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kSampled,
                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

void Drawing::recordShadowmaps(VkCommandBuffer commands, std::span<const gnomon::ShadowView> views) {
    const bool kept = atlasLayout_ != VK_IMAGE_LAYOUT_UNDEFINED;
    if (kept && std::ranges::none_of(views, &gnomon::ShadowView::changed)) return;
    // Its contents are kept from frame to frame, but for the first, when it has none.
    imageBarrier(commands, atlas_, kReadersBefore, atlasLayout_, kDepthTest, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    atlasLayout_ = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;

    const VkRenderingAttachmentInfo depth = attachment(atlas_, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                                                       kept ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR);
    VkRenderingInfo info = {VK_STRUCTURE_TYPE_RENDERING_INFO};
    info.renderArea = {{0, 0}, atlasExtent_};
    info.layerCount = 1;
    info.pDepthAttachment = &depth;
    vkCmdBeginRendering(commands, &info);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, shadowPipeline_);
    for (const gnomon::ShadowView& view : views) {
        if (!view.changed) continue;
        const VkRect2D rectangle = {{static_cast<std::int32_t>(view.xPx), static_cast<std::int32_t>(view.yPx)},
                                    {view.widthPx, view.heightPx}};
        const VkClearAttachment clear = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, {}};
        const VkClearRect cleared = {rectangle, 0, 1};
        vkCmdClearAttachments(commands, 1, &clear, 1, &cleared);
        drawScene(commands, rectangle, view.clipFromWorld);
    }
    vkCmdEndRendering(commands);

    imageBarrier(commands, atlas_, kDepthTest, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, kSampled,
                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

}  // namespace host
