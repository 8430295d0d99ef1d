#include "renderer/rates/texture_rate.h"

#include <algorithm>
#include <cstring>

#include "renderer/rates/sample_pattern.h"

namespace gnomon::renderer {
namespace {

constexpr std::uint32_t kTextureSpirv[] = {
#include "texture_rate.spv.h"
};

constexpr double kLongEnoughMs = 4.0;
// 65,536 samples, which no software device is long at.
constexpr SampleAmount kFirstAmount = {16, 16};
constexpr std::uint32_t kMostRounds = 1u << 16;

constexpr VkDescriptorType kTextureTypes[] = {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_SAMPLER,
                                              VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};

GpuImage makeAtlas(const Device& device) {
    GpuImage atlas(device, {.name = "rate_atlas",
                            .format = VK_FORMAT_D32_SFLOAT,
                            .width = kRateAtlasSizePx,
                            .height = kRateAtlasSizePx,
                            .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                     VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                            .arrayView = true});
    const std::vector<float> depths = TextureRate::depths();
    Uploader uploader(device);
    uploader.image(atlas, {reinterpret_cast<const std::uint8_t*>(depths.data()), depths.size() * sizeof(float)});
    uploader.finish();
    return atlas;
}

double samplesOf(SampleAmount amount) {
    return double{gpu::kWorkGroupSize} * amount.groups * kRateSamplesPerRound * amount.rounds;
}

}  // namespace

std::vector<float> TextureRate::depths() {
    std::vector<float> depths(std::size_t{kRateAtlasSizePx} * kRateAtlasSizePx);
    std::uint32_t state = 1;
    for (float& depth : depths) {
        state = state * 1664525u + 1013904223u;
        depth = static_cast<float>(state >> 8u) * (1.0f / 16777216.0f);
    }
    return depths;
}

TextureRate::TextureRate(const Device& device)
    : device_(device),
      atlas_(makeAtlas(device)),
      sampler_(device, {.repeatU = false, .repeatV = false, .linear = false, .mips = false}),
      result_(device, "rate_result", VkDeviceSize{kMostSampleGroups} * gpu::kWorkGroupSize * sizeof(std::uint32_t),
              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT),
      setLayout_(makeSetLayout(device, kTextureTypes, VK_SHADER_STAGE_COMPUTE_BIT)) {
    const VkDescriptorSetLayout sets[] = {setLayout_};
    layout_ = makePipelineLayout(device, sets, VK_SHADER_STAGE_COMPUTE_BIT, sizeof(SampleAmount::rounds));
    pool_ = makeDescriptorPool(device, 1, kTextureTypes);
    set_ = allocateSet(device, pool_, setLayout_);
    writeImage(device, set_, 0, kTextureTypes[0], atlas_.view(), VK_NULL_HANDLE);
    writeImage(device, set_, 1, kTextureTypes[1], VK_NULL_HANDLE, sampler_.handle());
    writeBuffer(device, set_, 2, kTextureTypes[2], result_.handle());
}

double TextureRate::measure(const Stopwatch& watch, SampleKind kind) const {
    const Pipeline pipeline = makePipeline(kind);
    SampleAmount amount = kFirstAmount;
    const auto run = [&](VkCommandBuffer commands) { record(commands, pipeline, amount); };
    (void)watch.milliseconds(run);  // the first one may compile
    // More groups until there are enough for any device, then more rounds.
    while (watch.milliseconds(run) < kLongEnoughMs && amount.rounds < kMostRounds)
        (amount.groups < kMostSampleGroups ? amount.groups : amount.rounds) *= 2;
    return samplesOf(amount) / (watch.best(run) * 1e-3);
}

std::vector<std::uint32_t> TextureRate::results(SampleKind kind, SampleAmount amount) const {
    amount.groups = std::min(amount.groups, kMostSampleGroups);
    const Pipeline pipeline = makePipeline(kind);
    device_.submitAndWait([&](VkCommandBuffer commands) { record(commands, pipeline, amount); });
    std::vector<std::uint32_t> out(std::size_t{amount.groups} * gpu::kWorkGroupSize);
    const std::vector<std::uint8_t> bytes = readBuffer(device_, result_.handle(), out.size() * sizeof(out[0]));
    std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
}

Pipeline TextureRate::makePipeline(SampleKind kind) const {
    const DeviceInfo& info = device_.info();
    const std::uint32_t lanes = std::min(info.subgroupSize, gpu::kWorkGroupSize);
    std::vector<std::uint32_t> constants(kSpecRateScattered + 1, 0u);
    constants[gpu::kSpecSubgroupSize] = lanes;
    constants[kSpecRateGathers] = kind.gathers ? 1u : 0u;
    constants[kSpecRateScattered] = kind.scattered ? 1u : 0u;
    return makeComputePipeline(device_, kTextureSpirv, layout_, constants,
                               info.minSubgroupSize == info.maxSubgroupSize ? 0 : lanes);
}

void TextureRate::record(VkCommandBuffer commands, VkPipeline pipeline, SampleAmount amount) const {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &set_, 0, nullptr);
    vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(amount.rounds), &amount.rounds);
    vkCmdDispatch(commands, amount.groups, 1, 1);
}

}  // namespace gnomon::renderer
