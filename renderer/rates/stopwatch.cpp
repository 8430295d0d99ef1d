#include "renderer/rates/stopwatch.h"

#include <algorithm>

namespace gnomon::renderer {
namespace {

constexpr int kRepetitions = 8;
constexpr double kEnoughMs = 250.0;  // software devices copy slowly, and steadily

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

}  // namespace

Stopwatch::Stopwatch(const Device& device) : device_(device) {
    if (device.timestampPeriodNs() == 0.0)
        throw GpuError("'" + device.info().name + "' has no timestamps to measure with.");
    VkQueryPoolCreateInfo info = {VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = 2;
    check(vkCreateQueryPool(device.handle(), &info, nullptr, &queries_), "creating a query pool");
}

double Stopwatch::milliseconds(const Record& record) const {
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
    return static_cast<double>((ticks[1] - ticks[0]) & device_.timestampMask()) * device_.timestampPeriodNs() * 1e-6;
}

double Stopwatch::best(const Record& record) const {
    double least = milliseconds(record), spent = least;
    for (int i = 1; i < kRepetitions && spent < kEnoughMs; ++i) {
        const double time = milliseconds(record);
        least = std::min(least, time);
        spent += time;
    }
    return least;
}

}  // namespace gnomon::renderer
