#include "renderer/gpu/timer.h"

namespace gnomon::renderer {

GpuTimer::GpuTimer(const Device& device, std::uint32_t framesInFlight, std::uint32_t maxScopes)
    : device_(device), maxScopes_(maxScopes), frames_(framesInFlight) {
    if (device.timestampPeriodNs() == 0.0) return;
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = framesInFlight * maxScopes * 2;
    check(vkCreateQueryPool(device.handle(), &info, nullptr, &pool_), "creating a query pool");
}

GpuTimer::~GpuTimer() {
    if (pool_ != VK_NULL_HANDLE) vkDestroyQueryPool(device_.handle(), pool_, nullptr);
}

void GpuTimer::beginFrame(VkCommandBuffer commands, std::uint64_t frameNumber) {
    current_ = static_cast<std::uint32_t>(frameNumber % frames_.size());
    frames_[current_].number = frameNumber;
    frames_[current_].names.clear();
    if (pool_ != VK_NULL_HANDLE) vkCmdResetQueryPool(commands, pool_, current_ * maxScopes_ * 2, maxScopes_ * 2);
}

std::uint32_t GpuTimer::begin(VkCommandBuffer commands, const std::string& name) {
    device_.beginLabel(commands, name.c_str());
    Frame& frame = frames_[current_];
    const auto scope = static_cast<std::uint32_t>(frame.names.size());
    if (scope >= maxScopes_) return maxScopes_;
    frame.names.push_back(name);
    if (pool_ != VK_NULL_HANDLE) {
        vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_,
                             (current_ * maxScopes_ + scope) * 2);
    }
    return scope;
}

void GpuTimer::end(VkCommandBuffer commands, std::uint32_t scope) {
    if (scope < maxScopes_ && pool_ != VK_NULL_HANDLE) {
        vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_,
                             (current_ * maxScopes_ + scope) * 2 + 1);
    }
    device_.endLabel(commands);
}

std::vector<GpuTime> GpuTimer::times(std::uint64_t frameNumber) const {
    const auto slot = static_cast<std::uint32_t>(frameNumber % frames_.size());
    const Frame& frame = frames_[slot];
    if (pool_ == VK_NULL_HANDLE || frame.number != frameNumber || frame.names.empty()) return {};
    std::vector<std::uint64_t> stamps(frame.names.size() * 2);
    const VkResult result = vkGetQueryPoolResults(
        device_.handle(), pool_, slot * maxScopes_ * 2, static_cast<std::uint32_t>(stamps.size()),
        stamps.size() * sizeof(std::uint64_t), stamps.data(), sizeof(std::uint64_t), VK_QUERY_RESULT_64_BIT);
    if (result != VK_SUCCESS) return {};
    std::vector<GpuTime> rows;
    for (std::size_t s = 0; s < frame.names.size(); ++s) {
        const std::uint64_t ticks = (stamps[2 * s + 1] - stamps[2 * s]) & device_.timestampMask();
        rows.push_back({frame.names[s], static_cast<double>(ticks) * device_.timestampPeriodNs() * 1e-6});
    }
    return rows;
}

}  // namespace gnomon::renderer
