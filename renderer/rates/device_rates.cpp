// The copy: the better of a compute shader's and vkCmdCopyBuffer's, since drivers differ in which is the faster one.
// The samples: as many work groups as take some milliseconds, found by doubling.
#include "renderer/rates/device_rates.h"

#include <algorithm>
#include <functional>

#include "gpu_interface/numbers.h"
#include "renderer/gpu/pipeline.h"
#include "renderer/gpu/resources.h"

namespace gnomon::renderer {
namespace {

constexpr std::uint32_t kCopySpirv[] = {
#include "copy_rate.spv.h"
};
constexpr std::uint32_t kTextureSpirv[] = {
#include "texture_rate.spv.h"
};

constexpr int kRepetitions = 8;
constexpr double kLongEnoughMs = 2.0;
constexpr std::uint32_t kMostGroups = 32768;  // below every device's limit of 65535
constexpr std::uint32_t kSamplesPerLane = 256;
constexpr std::uint32_t kAtlasSizePx = 1024;                      // as in texture_rate.comp
constexpr VkDeviceSize kCopyGroupBytes = VkDeviceSize{256} * 64;  // of a work group of copy_rate.comp

void recordWait(VkCommandBuffer commands) {
    VkMemoryBarrier2 all = {VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    all.srcStageMask = all.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    all.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    all.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    VkDependencyInfo dependency = {VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &all;
    vkCmdPipelineBarrier2(commands, &dependency);
}

class Stopwatch {
public:
    explicit Stopwatch(const Device& device) : device_(device) {
        if (device.timestampPeriodNs() == 0.0)
            throw GpuError("'" + device.info().name + "' has no timestamps to measure with.");
        VkQueryPoolCreateInfo info = {VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
        info.queryType = VK_QUERY_TYPE_TIMESTAMP;
        info.queryCount = 2;
        check(vkCreateQueryPool(device.handle(), &info, nullptr, &queries_), "creating a query pool");
    }
    ~Stopwatch() { vkDestroyQueryPool(device_.handle(), queries_, nullptr); }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

    double milliseconds(const std::function<void(VkCommandBuffer)>& record) {
        constexpr VkPipelineStageFlags2 kAll = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        device_.submitAndWait([&](VkCommandBuffer commands) {
            vkCmdResetQueryPool(commands, queries_, 0, 2);
            vkCmdWriteTimestamp2(commands, kAll, queries_, 0);
            // A software device may put timestamps off until something waits.
            recordWait(commands);
            record(commands);
            recordWait(commands);
            vkCmdWriteTimestamp2(commands, kAll, queries_, 1);
        });
        std::uint64_t ticks[2] = {};
        check(vkGetQueryPoolResults(device_.handle(), queries_, 0, 2, sizeof(ticks), ticks, sizeof(ticks[0]),
                                    VK_QUERY_RESULT_64_BIT),
              "reading timestamps");
        return static_cast<double>((ticks[1] - ticks[0]) & device_.timestampMask()) * device_.timestampPeriodNs() *
               1e-6;
    }
    double best(const std::function<void(VkCommandBuffer)>& record) {
        double least = milliseconds(record);
        for (int i = 1; i < kRepetitions; ++i) least = std::min(least, milliseconds(record));
        return least;
    }

private:
    const Device& device_;
    VkQueryPool queries_ = VK_NULL_HANDLE;
};

// Some times any cache, but little enough for a software device, whose memory is everybody's.
VkDeviceSize copyBytes(const Device& device) {
    const bool software = device.info().properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    const VkDeviceSize wanted = VkDeviceSize{software ? 64u : 512u} << 20;
    const VkDeviceSize most = device.limits().maxStorageBufferRange;
    const VkDeviceSize groups = std::min<VkDeviceSize>(std::min(wanted, most) / kCopyGroupBytes, kMostGroups);
    return groups * kCopyGroupBytes;
}

double measureCopy(const Device& device, Stopwatch& watch) {
    const VkDeviceSize bytes = copyBytes(device);
    constexpr VkBufferUsageFlags kUsage =
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const Buffer source(device, "rate_source", bytes, kUsage), target(device, "rate_target", bytes, kUsage);
    // Memory that was never written may be read from nowhere.
    device.submitAndWait([&](VkCommandBuffer c) { vkCmdFillBuffer(c, source.handle(), 0, bytes, 0x9E3779B9u); });
    const VkDescriptorType types[] = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    const SetLayout setLayout = makeSetLayout(device, types, VK_SHADER_STAGE_COMPUTE_BIT);
    const VkDescriptorSetLayout sets[] = {setLayout};
    const PipelineLayout layout = makePipelineLayout(device, sets);
    const DescriptorPool pool = makeDescriptorPool(device, 1, types);
    VkDescriptorSet set = allocateSet(device, pool, setLayout);
    writeBuffer(device, set, 0, types[0], source.handle());
    writeBuffer(device, set, 1, types[1], target.handle());
    const Pipeline pipeline = makeComputePipeline(device, kCopySpirv, layout);
    const double byShader = watch.best([&](VkCommandBuffer c) {
        vkCmdBindPipeline(c, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
        vkCmdBindDescriptorSets(c, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, nullptr);
        vkCmdDispatch(c, static_cast<std::uint32_t>(bytes / kCopyGroupBytes), 1, 1);
    });
    const double byCommand = watch.best([&](VkCommandBuffer c) {
        const VkBufferCopy whole = {0, 0, bytes};
        vkCmdCopyBuffer(c, source.handle(), target.handle(), 1, &whole);
    });
    return 2.0 * static_cast<double>(bytes) / (std::min(byShader, byCommand) * 1e-3);
}

// Depths without a pattern that a device could compress.
GpuImage makeAtlas(const Device& device) {
    GpuImage atlas(device, {.name = "rate_atlas",
                            .format = VK_FORMAT_D32_SFLOAT,
                            .width = kAtlasSizePx,
                            .height = kAtlasSizePx,
                            .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                     VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                            .arrayView = true});
    std::vector<float> depths(std::size_t{kAtlasSizePx} * kAtlasSizePx);
    std::uint32_t state = 1;
    for (float& depth : depths) {
        state = state * 1664525u + 1013904223u;
        depth = static_cast<float>(state >> 8u) * (1.0f / 16777216.0f);
    }
    Uploader uploader(device);
    uploader.image(atlas, {reinterpret_cast<const std::uint8_t*>(depths.data()), depths.size() * sizeof(float)});
    uploader.finish();
    return atlas;
}

class TextureRate {
public:
    explicit TextureRate(const Device& device)
        : device_(device),
          atlas_(makeAtlas(device)),
          sampler_(device, {.repeatU = false, .repeatV = false, .linear = false, .mips = false}),
          result_(device, "rate_result", 16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) {
        constexpr VkDescriptorType kTypes[] = {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_SAMPLER,
                                               VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
        setLayout_ = makeSetLayout(device, kTypes, VK_SHADER_STAGE_COMPUTE_BIT);
        const VkDescriptorSetLayout sets[] = {setLayout_};
        layout_ = makePipelineLayout(device, sets);
        pool_ = makeDescriptorPool(device, 1, kTypes);
        set_ = allocateSet(device, pool_, setLayout_);
        writeImage(device, set_, 0, kTypes[0], atlas_.view(), VK_NULL_HANDLE);
        writeImage(device, set_, 1, kTypes[1], VK_NULL_HANDLE, sampler_.handle());
        writeBuffer(device, set_, 2, kTypes[2], result_.handle());
    }

    double samplesPerSecond(Stopwatch& watch, bool gather) {
        const DeviceInfo& info = device_.info();
        const std::uint32_t lanes = std::min(info.subgroupSize, gpu::kWorkGroupSize);
        std::vector<std::uint32_t> constants(gpu::kSpecFirstFree + 2, 0u);
        constants[gpu::kSpecSubgroupSize] = lanes;
        constants[gpu::kSpecFirstFree] = gather ? 1u : 0u;
        constants[gpu::kSpecFirstFree + 1] = kSamplesPerLane;
        const Pipeline pipeline = makeComputePipeline(device_, kTextureSpirv, layout_, constants,
                                                      info.minSubgroupSize == info.maxSubgroupSize ? 0 : lanes);
        std::uint32_t groups = 64;
        const auto record = [&](VkCommandBuffer c) {
            vkCmdBindPipeline(c, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
            vkCmdBindDescriptorSets(c, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &set_, 0, nullptr);
            vkCmdDispatch(c, groups, 1, 1);
        };
        watch.milliseconds(record);  // the first one may compile
        while (groups < kMostGroups && watch.milliseconds(record) < kLongEnoughMs) groups *= 2;
        return double{gpu::kWorkGroupSize} * groups * kSamplesPerLane / (watch.best(record) * 1e-3);
    }

private:
    const Device& device_;
    GpuImage atlas_;
    Sampler sampler_;
    Buffer result_;
    SetLayout setLayout_;
    PipelineLayout layout_;
    DescriptorPool pool_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};

}  // namespace

DeviceRates measureDeviceRates(const Device& device) {
    Stopwatch watch(device);
    DeviceRates rates;
    rates.bytesPerSecond = measureCopy(device, watch);
    TextureRate texture(device);
    rates.fetchesPerSecond = texture.samplesPerSecond(watch, false);
    rates.gathersPerSecond = texture.samplesPerSecond(watch, true);
    return rates;
}

}  // namespace gnomon::renderer
