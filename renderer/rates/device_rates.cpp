// The copy: the better of a compute shader's and vkCmdCopyBuffer's, since drivers differ in which is the faster one.
// Samples: see texture_rate.comp.
#include "renderer/rates/device_rates.h"

#include <algorithm>

#include "renderer/rates/texture_rate.h"

namespace gnomon::renderer {
namespace {

constexpr std::uint32_t kCopySpirv[] = {
#include "copy_rate.spv.h"
};
constexpr std::uint32_t kMostGroups = 32768;                      // below every device's limit of 65535
constexpr VkDeviceSize kCopyGroupBytes = VkDeviceSize{256} * 64;  // of a work group of copy_rate.comp

// Some times any cache, but little enough for a software device, whose memory is everybody's.
VkDeviceSize copyBytes(const Device& device) {
    const bool software = device.info().properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    const VkDeviceSize wanted = VkDeviceSize{software ? 64u : 512u} << 20;
    const VkDeviceSize most = device.limits().maxStorageBufferRange;
    const VkDeviceSize groups = std::min<VkDeviceSize>(std::min(wanted, most) / kCopyGroupBytes, kMostGroups);
    return groups * kCopyGroupBytes;
}

double measureCopy(const Device& device, const Stopwatch& watch) {
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

}  // namespace

DeviceRates measureDeviceRates(const Device& device) {
    const Stopwatch watch(device);
    DeviceRates rates;
    rates.bytesPerSecond = measureCopy(device, watch);
    const TextureRate texture(device);
    const auto ratesOf = [&](bool gathers) {
        return SampleRates{texture.measure(watch, {.gathers = gathers, .scattered = false}),
                           texture.measure(watch, {.gathers = gathers, .scattered = true})};
    };
    rates.fetches = ratesOf(false);
    rates.gathers = ratesOf(true);
    return rates;
}

}  // namespace gnomon::renderer
