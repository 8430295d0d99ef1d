#include "lighting.h"

#include <cstring>

#include "scene.h"

namespace host {
namespace {

constexpr std::uint32_t kAllTilesSpirv[] = {
#include "lighting.spv.h"
};
constexpr std::uint32_t kEvaluateSpirv[] = {
#include "lighting_evaluate.spv.h"
};

// Sets of lighting.comp.
constexpr std::uint32_t kFirstSet = 0;  // lists, receivers and the host's own, in a row
constexpr std::uint32_t kShadowmapsSet = 3;

constexpr Use kComputeWrite = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
constexpr Use kCopyRead = {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};

}  // namespace

Lighting::Lighting(Device& device, const gnomon::Context& context, const gnomon::ShadowSettings& settings,
                   std::uint32_t widthPx, std::uint32_t heightPx)
    : device_(device), extent_{widthPx, heightPx} {
    picture_ = device.makeImage(VK_FORMAT_R8G8B8A8_UNORM, widthPx, heightPx,
                                VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    readback_ = device.makeBuffer(VkDeviceSize{4} * widthPx * heightPx, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const auto intensities = sceneIntensities();
    const std::size_t bytes = intensities.size() * sizeof(intensities[0]);
    intensities_ = device.makeBuffer(bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    std::memcpy(intensities_.mapped, intensities.data(), bytes);
    makeOwnSet();

    // The second layout is the first one with the shadowmaps behind it, so sets that were bound for one stay bound for
    // the other. The pipeline for all tiles cannot reach a shadowmap.
    const VkDescriptorSetLayout sets[] = {context.listsSetLayout(), context.receiversSetLayout(), ownSetLayout_,
                                          context.shadowmapsSetLayout()};
    allTilesLayout_ = device.makePipelineLayout(std::span(sets, 3));
    evaluateLayout_ = device.makePipelineLayout(sets);

    // Filters, taps and bits are specialization constants of the library's shader includes. With the same values the
    // second pipeline evaluates, bit for bit, what a slot would have held.
    const gnomon::SpecializationValues constants = context.specialization(settings);
    allTiles_ = device.makeComputePipeline(kAllTilesSpirv, allTilesLayout_, constants.values);
    evaluate_ = device.makeComputePipeline(kEvaluateSpirv, evaluateLayout_, constants.values);
}

void Lighting::makeOwnSet() {
    const VkDescriptorSetLayoutBinding bindings[] = {
        {0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr},
        {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr}};
    VkDescriptorSetLayoutCreateInfo layoutInfo = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    layoutInfo.bindingCount = 2;
    layoutInfo.pBindings = bindings;
    check(vkCreateDescriptorSetLayout(device_.handle, &layoutInfo, nullptr, &ownSetLayout_),
          "vkCreateDescriptorSetLayout");
    device_.own(
        [&device = device_, made = ownSetLayout_] { vkDestroyDescriptorSetLayout(device.handle, made, nullptr); });

    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}};
    VkDescriptorPoolCreateInfo poolInfo = {VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = 2;
    poolInfo.pPoolSizes = sizes;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(device_.handle, &poolInfo, nullptr, &pool), "vkCreateDescriptorPool");
    device_.own([&device = device_, pool] { vkDestroyDescriptorPool(device.handle, pool, nullptr); });
    VkDescriptorSetAllocateInfo allocate = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocate.descriptorPool = pool;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &ownSetLayout_;
    check(vkAllocateDescriptorSets(device_.handle, &allocate, &ownSet_), "vkAllocateDescriptorSets");

    const VkDescriptorImageInfo image = {VK_NULL_HANDLE, picture_.view, VK_IMAGE_LAYOUT_GENERAL};
    const VkDescriptorBufferInfo buffer = {intensities_.handle, 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet writes[2] = {{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET},
                                      {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET}};
    for (std::uint32_t i = 0; i < 2; ++i) {
        writes[i].dstSet = ownSet_;
        writes[i].dstBinding = i;
        writes[i].descriptorCount = 1;
        writes[i].descriptorType = bindings[i].descriptorType;
    }
    writes[0].pImageInfo = &image;
    writes[1].pBufferInfo = &buffer;
    vkUpdateDescriptorSets(device_.handle, 2, writes, 0, nullptr);
}

void Lighting::record(VkCommandBuffer commands, const gnomon::View& view, gnomon::Timeline& timeline) {
    // All pixels are written anew, so what the frame before left may be forgotten: hence UNDEFINED.
    imageBarrier(commands, picture_, kComputeWrite, VK_IMAGE_LAYOUT_UNDEFINED, kComputeWrite, VK_IMAGE_LAYOUT_GENERAL);
    // Lists, visibility and the indirect command need no barrier: recordGenerateShadows() ends with it.
    using gnomon::Phase, gnomon::RowKind;
    const VkDescriptorSet sets[] = {view.listsSet(), view.receiversSet(), ownSet_};
    const VkDescriptorSet shadowmaps = view.shadowmapsSet();
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, evaluateLayout_, kFirstSet, 3, sets, 0, nullptr);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, evaluateLayout_, kShadowmapsSet, 1, &shadowmaps,
                            0, nullptr);

    gnomon::Timeline::Row row = timeline.begin(commands, "lighting", Phase::Lighting, RowKind::Compute);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, allTiles_);
    vkCmdDispatch(commands, view.tileCounts().width, view.tileCounts().height, 1);
    timeline.end(commands, row);

    // In every frame: the command covers no tile where nothing overflowed. Every pixel is written by one of the two, so
    // no barrier stands between them.
    row = timeline.begin(commands, "lighting_evaluate", Phase::Lighting, RowKind::Compute);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, evaluate_);
    vkCmdDispatchIndirect(commands, view.evaluateTilesBuffer(), view.evaluateCommandOffset());
    timeline.end(commands, row);
}

void Lighting::recordReadback(VkCommandBuffer commands) {
    imageBarrier(commands, picture_, kComputeWrite, VK_IMAGE_LAYOUT_GENERAL, kCopyRead,
                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    VkBufferImageCopy all = {};
    all.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    all.imageExtent = {extent_.width, extent_.height, 1};
    vkCmdCopyImageToBuffer(commands, picture_.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, readback_.handle, 1, &all);
    VkMemoryBarrier2 toHost = {VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    toHost.srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
    toHost.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    toHost.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
    toHost.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
    VkDependencyInfo info = {VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &toHost;
    vkCmdPipelineBarrier2(commands, &info);
}

}  // namespace host
