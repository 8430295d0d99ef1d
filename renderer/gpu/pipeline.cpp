#include "renderer/gpu/pipeline.h"

namespace gnomon::renderer {

namespace {

// Lives for the length of a pipeline's creation.
struct ShaderModule {
    ShaderModule(const Device& d, std::span<const std::uint32_t> spirv) : device(d) {
        VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0, spirv.size_bytes(),
                                      spirv.data()};
        check(vkCreateShaderModule(device.handle(), &info, nullptr, &handle), "creating a shader");
    }
    ~ShaderModule() { vkDestroyShaderModule(device.handle(), handle, nullptr); }
    ShaderModule(const ShaderModule&) = delete;
    ShaderModule& operator=(const ShaderModule&) = delete;
    const Device& device;
    VkShaderModule handle = VK_NULL_HANDLE;
};

VkPipelineShaderStageCreateInfo stageInfo(VkShaderStageFlagBits stage, VkShaderModule module) {
    VkPipelineShaderStageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage = stage;
    info.module = module;
    info.pName = "main";
    return info;
}

VkPipelineRasterizationStateCreateInfo rasterOf(const GraphicsPipelineDesc& desc) {
    VkPipelineRasterizationStateCreateInfo raster{};
    raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    raster.polygonMode = VK_POLYGON_MODE_FILL;
    raster.cullMode = desc.cull;
    raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    raster.lineWidth = 1.0f;
    return raster;
}

VkPipelineDepthStencilStateCreateInfo depthOf(const GraphicsPipelineDesc& desc) {
    VkPipelineDepthStencilStateCreateInfo depth{};
    depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
    depth.depthTestEnable = desc.depthFormat != VK_FORMAT_UNDEFINED;
    depth.depthWriteEnable = desc.depthWrite;
    depth.depthCompareOp = desc.depthCompare;
    return depth;
}

std::vector<VkDynamicState> dynamicStatesOf(const GraphicsPipelineDesc& desc) {
    std::vector<VkDynamicState> states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    if (desc.dynamicCull) states.insert(states.end(), {VK_DYNAMIC_STATE_CULL_MODE, VK_DYNAMIC_STATE_FRONT_FACE});
    if (desc.dynamicDepthBias)
        states.insert(states.end(), {VK_DYNAMIC_STATE_DEPTH_BIAS_ENABLE, VK_DYNAMIC_STATE_DEPTH_BIAS});
    if (desc.dynamicDepthCompare) states.push_back(VK_DYNAMIC_STATE_DEPTH_COMPARE_OP);
    return states;
}

// All state but the stages.
Pipeline makeWithStages(const Device& device, const GraphicsPipelineDesc& desc,
                        std::span<const VkPipelineShaderStageCreateInfo> stages) {
    VkPipelineVertexInputStateCreateInfo input{};
    input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{};
    viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    viewport.viewportCount = viewport.scissorCount = 1;
    const VkPipelineRasterizationStateCreateInfo raster = rasterOf(desc);
    VkPipelineMultisampleStateCreateInfo samples{};
    samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    const VkPipelineDepthStencilStateCreateInfo depth = depthOf(desc);
    VkPipelineColorBlendAttachmentState blend{};
    blend.colorWriteMask = 0xF;
    const std::vector<VkPipelineColorBlendAttachmentState> blends(desc.colourFormats.size(), blend);
    VkPipelineColorBlendStateCreateInfo colour{};
    colour.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    colour.attachmentCount = static_cast<std::uint32_t>(blends.size());
    colour.pAttachments = blends.data();
    const std::vector<VkDynamicState> states = dynamicStatesOf(desc);
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO, nullptr, 0,
                                             static_cast<std::uint32_t>(states.size()), states.data()};
    VkPipelineRenderingCreateInfo rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
    rendering.colorAttachmentCount = static_cast<std::uint32_t>(desc.colourFormats.size());
    rendering.pColorAttachmentFormats = desc.colourFormats.data();
    rendering.depthAttachmentFormat = desc.depthFormat;
    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.pNext = &rendering;
    info.stageCount = static_cast<std::uint32_t>(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &colour;
    info.pDynamicState = &dynamic;
    info.layout = desc.layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    check(vkCreateGraphicsPipelines(device.handle(), device.pipelineCache(), 1, &info, nullptr, &pipeline),
          "creating a graphics pipeline");
    return {device.handle(), pipeline};
}

}  // namespace

SetLayout makeSetLayout(const Device& device, std::span<const VkDescriptorType> types, VkShaderStageFlags stages) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const VkDescriptorType type : types) {
        bindings.push_back({static_cast<std::uint32_t>(bindings.size()), type, 1, stages, nullptr});
    }
    VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, nullptr, 0,
                                         static_cast<std::uint32_t>(bindings.size()), bindings.data()};
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    check(vkCreateDescriptorSetLayout(device.handle(), &info, nullptr, &layout), "creating a descriptor set layout");
    return {device.handle(), layout};
}

PipelineLayout makePipelineLayout(const Device& device, std::span<const VkDescriptorSetLayout> sets,
                                  VkShaderStageFlags pushStages, std::uint32_t pushBytes) {
    const VkPushConstantRange push{pushStages, 0, pushBytes};
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = static_cast<std::uint32_t>(sets.size());
    info.pSetLayouts = sets.data();
    info.pushConstantRangeCount = pushBytes != 0 ? 1 : 0;
    info.pPushConstantRanges = &push;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    check(vkCreatePipelineLayout(device.handle(), &info, nullptr, &layout), "creating a pipeline layout");
    return {device.handle(), layout};
}

DescriptorPool makeDescriptorPool(const Device& device, std::uint32_t sets,
                                  std::span<const VkDescriptorType> typesPerSet) {
    std::vector<VkDescriptorPoolSize> sizes;
    for (const VkDescriptorType type : typesPerSet) sizes.push_back({type, sets});
    VkDescriptorPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    info.maxSets = sets;
    info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    info.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(device.handle(), &info, nullptr, &pool), "creating a descriptor pool");
    return {device.handle(), pool};
}

VkDescriptorSet allocateSet(const Device& device, VkDescriptorPool pool, VkDescriptorSetLayout layout) {
    VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, pool, 1, &layout};
    VkDescriptorSet set = VK_NULL_HANDLE;
    check(vkAllocateDescriptorSets(device.handle(), &info, &set), "allocating a descriptor set");
    return set;
}

void writeBuffer(const Device& device, VkDescriptorSet set, std::uint32_t binding, VkDescriptorType type,
                 VkBuffer buffer, VkDeviceSize offset, VkDeviceSize bytes) {
    const VkDescriptorBufferInfo info{buffer, offset, bytes};
    VkWriteDescriptorSet write{
        VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, set, binding, 0, 1, type, nullptr, &info, nullptr};
    vkUpdateDescriptorSets(device.handle(), 1, &write, 0, nullptr);
}

void writeImage(const Device& device, VkDescriptorSet set, std::uint32_t binding, VkDescriptorType type,
                VkImageView view, VkSampler sampler, VkImageLayout layout) {
    const VkDescriptorImageInfo info{sampler, view, layout};
    VkWriteDescriptorSet write{
        VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, set, binding, 0, 1, type, &info, nullptr, nullptr};
    vkUpdateDescriptorSets(device.handle(), 1, &write, 0, nullptr);
}

Pipeline makeGraphicsPipeline(const Device& device, const GraphicsPipelineDesc& desc) {
    const ShaderModule vertex(device, desc.vertexSpirv);
    std::vector<VkPipelineShaderStageCreateInfo> stages{stageInfo(VK_SHADER_STAGE_VERTEX_BIT, vertex.handle)};
    if (desc.fragmentSpirv.empty()) return makeWithStages(device, desc, stages);
    const ShaderModule fragment(device, desc.fragmentSpirv);
    stages.push_back(stageInfo(VK_SHADER_STAGE_FRAGMENT_BIT, fragment.handle));
    return makeWithStages(device, desc, stages);
}

Pipeline makeComputePipeline(const Device& device, std::span<const std::uint32_t> spirv, VkPipelineLayout layout,
                             std::span<const std::uint32_t> specialization, std::uint32_t requiredSubgroupSize) {
    const ShaderModule module(device, spirv);
    std::vector<VkSpecializationMapEntry> entries;
    for (std::uint32_t i = 0; i < specialization.size(); ++i) entries.push_back({i, i * 4, 4});
    const VkSpecializationInfo values{static_cast<std::uint32_t>(entries.size()), entries.data(),
                                      specialization.size_bytes(), specialization.data()};
    VkPipelineShaderStageRequiredSubgroupSizeCreateInfo size{};
    size.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO;
    size.requiredSubgroupSize = requiredSubgroupSize;
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.stage = stageInfo(VK_SHADER_STAGE_COMPUTE_BIT, module.handle);
    info.stage.pSpecializationInfo = entries.empty() ? nullptr : &values;
    info.stage.flags = VK_PIPELINE_SHADER_STAGE_CREATE_REQUIRE_FULL_SUBGROUPS_BIT;
    if (requiredSubgroupSize != 0) info.stage.pNext = &size;
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    check(vkCreateComputePipelines(device.handle(), device.pipelineCache(), 1, &info, nullptr, &pipeline),
          "creating a compute pipeline");
    return {device.handle(), pipeline};
}

}  // namespace gnomon::renderer
