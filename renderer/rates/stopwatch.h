#pragma once
// The device's time for what a command buffer does, apart from everything else.

#include <functional>

#include "renderer/gpu/device.h"

namespace gnomon::renderer {

/// The device must outlive it. Not thread safe.
class Stopwatch {
public:
    using Record = std::function<void(VkCommandBuffer)>;

    /// Throws GpuError where the device has no timestamps.
    explicit Stopwatch(const Device& device);
    ~Stopwatch() { vkDestroyQueryPool(device_.handle(), queries_, nullptr); }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

    /// Waits for the device. What is recorded may follow other commands without a barrier of its own.
    [[nodiscard]] double milliseconds(const Record& record) const;
    /// The least of eight times, or of as many as fill a quarter of a second.
    [[nodiscard]] double best(const Record& record) const;

private:
    const Device& device_;
    VkQueryPool queries_ = VK_NULL_HANDLE;
};

}  // namespace gnomon::renderer
