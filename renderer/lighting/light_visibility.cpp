#include "renderer/lighting/light_visibility.h"

#include <cstring>

#include "renderer/lighting/lighting_pipelines.h"

namespace gnomon::renderer {
namespace {

constexpr std::uint32_t kSpirv[] = {
#include "light_visibility.spv.h"
};
constexpr VkDescriptorType kOwnTypes[] = {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};

}  // namespace

LightVisibilityPipelines::LightVisibilityPipelines(const Device& device, const Context& context)
    : device_(device), context_(context), ownSet_(makeSetLayout(device, kOwnTypes, VK_SHADER_STAGE_COMPUTE_BIT)) {
    const VkDescriptorSetLayout sets[] = {context.listsSetLayout(), context.receiversSetLayout(),
                                          context.shadowmapsSetLayout(), ownSet_};
    layout_ = makePipelineLayout(device, sets, VK_SHADER_STAGE_COMPUTE_BIT, sizeof(std::uint32_t));
}

VkPipeline LightVisibilityPipelines::get(const ShadowSettings& settings) {
    const auto values = context_.specialization(settings).values;
    Pipeline& pipeline = pipelines_[values];
    if (pipeline == VK_NULL_HANDLE)
        pipeline = makeComputePipeline(device_, kSpirv, layout_, values, requiredSubgroupSize(device_, context_));
    return pipeline;
}

LightVisibility::LightVisibility(const Device& device, LightVisibilityPipelines& pipelines, std::uint32_t widthPx,
                                 std::uint32_t heightPx)
    : device_(device),
      pipelines_(pipelines),
      pool_(makeDescriptorPool(device, 1, kOwnTypes)),
      ownSet_(allocateSet(device, pool_, pipelines.ownSet())),
      picture_(device, {.name = "light visibility",
                        .format = VK_FORMAT_R32_SFLOAT,
                        .width = widthPx,
                        .height = heightPx,
                        .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT}),
      commands_(device) {
    writeImage(device, ownSet_, 0, kOwnTypes[0], picture_.view(), VK_NULL_HANDLE, VK_IMAGE_LAYOUT_GENERAL);
}

std::vector<float> LightVisibility::read(const View& view, const ShadowSettings& settings, std::uint32_t light,
                                         std::uint32_t widthPx, std::uint32_t heightPx) {
    const VkPipeline pipeline = pipelines_.get(settings);
    const VkPipelineLayout layout = pipelines_.layout();
    const VkCommandBuffer c = commands_.begin();
    const VkImageMemoryBarrier2 barrier =
        imageBarrier(picture_, VK_IMAGE_LAYOUT_UNDEFINED, {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_NONE},
                     VK_IMAGE_LAYOUT_GENERAL, access::kComputeWrite);
    recordBarriers(c, std::span(&barrier, 1));
    const VkDescriptorSet sets[] = {view.listsSet(), view.receiversSet(), view.shadowmapsSet(), ownSet_};
    vkCmdBindPipeline(c, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vkCmdBindDescriptorSets(c, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 4, sets, 0, nullptr);
    vkCmdPushConstants(c, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(light), &light);
    const VkExtent2D tiles = view.tileCounts();
    vkCmdDispatch(c, tiles.width, tiles.height, 1);
    commands_.submit();
    commands_.wait();
    const std::vector<std::uint8_t> bytes = readImage(device_, picture_, VK_IMAGE_LAYOUT_GENERAL);
    const std::size_t row = picture_.desc().width;
    std::vector<float> visibility(std::size_t{widthPx} * heightPx);
    for (std::size_t y = 0; y < heightPx; ++y)
        std::memcpy(&visibility[y * widthPx], bytes.data() + y * row * sizeof(float), widthPx * sizeof(float));
    return visibility;
}

}  // namespace gnomon::renderer
