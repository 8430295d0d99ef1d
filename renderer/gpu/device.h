#pragma once
// One logical device with one queue for graphics and compute.

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "renderer/gpu/instance.h"
#include "renderer/gpu/memory.h"

namespace gnomon::renderer {

/// Creates the device with synchronization2, dynamicRendering, computeFullSubgroups and subgroupSizeControl, and with
/// samplerAnisotropy where present; robustBufferAccess stays off. Not thread safe.
class Device {
public:
    /// The instance must outlive the device. `extensions` (for example VK_KHR_swapchain) must exist; `moreFeatures` is
    /// a chain of feature structures that they need. Throws GpuError.
    Device(const VulkanInstance& instance, const DeviceInfo& info, const std::vector<const char*>& extensions = {},
           void* moreFeatures = nullptr);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    [[nodiscard]] VkDevice handle() const { return device_; }
    [[nodiscard]] VkPhysicalDevice physical() const { return info_.handle; }
    [[nodiscard]] const VulkanInstance& instance() const { return instance_; }
    [[nodiscard]] const DeviceInfo& info() const { return info_; }
    [[nodiscard]] const VkPhysicalDeviceLimits& limits() const { return info_.properties.limits; }
    [[nodiscard]] const VkPhysicalDeviceFeatures& features() const { return features_; }  ///< those enabled
    [[nodiscard]] VkQueue queue() const { return queue_; }
    [[nodiscard]] std::uint32_t queueFamily() const { return info_.queueFamily; }
    [[nodiscard]] VkPipelineCache pipelineCache() const { return pipelineCache_; }
    [[nodiscard]] MemoryPool& memory() const { return *memory_; }

    /// Nanoseconds of a timestamp's step; 0 where the queue has no timestamps.
    [[nodiscard]] double timestampPeriodNs() const { return timestampPeriodNs_; }
    /// The bits of a timestamp that count.
    [[nodiscard]] std::uint64_t timestampMask() const { return timestampMask_; }

    [[nodiscard]] bool supports(VkFormat format, VkFormatFeatureFlags optimalTilingFeatures) const;

    /// Records into a fresh command buffer, submits it and waits for it. Throws GpuError.
    void submitAndWait(const std::function<void(VkCommandBuffer)>& record) const;
    void waitIdle() const;

    /// For frame captures and validation messages; nothing without debug labels.
    void name(VkObjectType type, std::uint64_t object, const std::string& name) const;
    void beginLabel(VkCommandBuffer commands, const char* name) const;
    void endLabel(VkCommandBuffer commands) const;

private:
    void create(const std::vector<const char*>& extensions, void* moreFeatures);
    const VulkanInstance& instance_;
    DeviceInfo info_;
    VkPhysicalDeviceFeatures features_{};
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    VkCommandPool immediatePool_ = VK_NULL_HANDLE;
    VkPipelineCache pipelineCache_ = VK_NULL_HANDLE;
    double timestampPeriodNs_ = 0.0;
    std::uint64_t timestampMask_ = 0;
    std::unique_ptr<MemoryPool> memory_;
};

/// A command buffer with a fence: what a frame in flight needs.
class Commands {
public:
    explicit Commands(const Device& device);
    ~Commands();  ///< waits
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;

    /// Waits for the previous submission, then begins recording.
    VkCommandBuffer begin();
    /// Ends recording and submits.
    void submit();
    void wait();

private:
    const Device& device_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
    bool submitted_ = false;
};

}  // namespace gnomon::renderer
