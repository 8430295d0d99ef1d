#pragma once
// GPU times of named scopes, read when the frame is known to have finished: never a wait.

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/gpu/device.h"

namespace gnomon::renderer {

struct GpuTime {
    std::string name;
    double milliseconds = 0.0;
};

/// Scopes of up to `framesInFlight` frames. Without timestamps on the queue it records nothing and returns no rows.
class GpuTimer {
public:
    GpuTimer(const Device& device, std::uint32_t framesInFlight, std::uint32_t maxScopes = 32);
    ~GpuTimer();
    GpuTimer(const GpuTimer&) = delete;
    GpuTimer& operator=(const GpuTimer&) = delete;

    /// First thing in a frame's first command buffer, outside of rendering. The frame that is reused must have
    /// finished.
    void beginFrame(VkCommandBuffer commands, std::uint64_t frameNumber);
    /// Scopes may nest; each also makes a debug label. Outside of rendering or wholly within one.
    std::uint32_t begin(VkCommandBuffer commands, const std::string& name);
    void end(VkCommandBuffer commands, std::uint32_t scope);

    /// Rows in order of begin(); empty if the frame is not known any more or not finished yet.
    [[nodiscard]] std::vector<GpuTime> times(std::uint64_t frameNumber) const;

private:
    struct Frame {
        std::uint64_t number = ~std::uint64_t{0};
        std::vector<std::string> names;
    };
    const Device& device_;
    std::uint32_t maxScopes_;
    VkQueryPool pool_ = VK_NULL_HANDLE;
    std::vector<Frame> frames_;
    std::uint32_t current_ = 0;
};

/// Times the block it lives in. A null timer is fine.
class GpuScope {
public:
    GpuScope(GpuTimer* timer, VkCommandBuffer commands, const char* name)
        : timer_(timer), commands_(commands), scope_(timer != nullptr ? timer->begin(commands, name) : 0) {}
    ~GpuScope() {
        if (timer_ != nullptr) timer_->end(commands_, scope_);
    }
    GpuScope(const GpuScope&) = delete;
    GpuScope& operator=(const GpuScope&) = delete;

private:
    GpuTimer* timer_;
    VkCommandBuffer commands_;
    std::uint32_t scope_;
};

}  // namespace gnomon::renderer
