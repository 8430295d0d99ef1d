#pragma once
// The Vulkan instance, the devices it knows, and the choice among them.

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/gpu/error.h"

namespace gnomon::renderer {

/// Validation messages (warnings and errors) in the order they came. Thread safe.
class MessageLog {
public:
    void add(std::string message);
    [[nodiscard]] std::size_t count() const;
    [[nodiscard]] std::vector<std::string> messages() const;
    void clear();

private:
    mutable std::mutex mutex_;
    std::vector<std::string> messages_;
};

struct InstanceDesc {
    bool validation = false;    ///< the Khronos layer with synchronization validation; an error if it is not installed
    bool debugLabels = true;    ///< names and labels for frame captures, where the loader offers VK_EXT_debug_utils
    bool printMessages = true;  ///< validation messages also go to stderr
    /// Instance extensions of a window system, all of which must exist.
    std::vector<const char*> extensions;
};

/// What is known of a physical device before it is used.
struct DeviceInfo {
    VkPhysicalDevice handle = VK_NULL_HANDLE;
    std::string name;
    std::string typeName;  ///< "discrete GPU", "integrated GPU", "virtual GPU", "CPU" or "other"
    std::string driver;    ///< name and version as the driver tells them
    std::uint32_t apiVersion = 0;
    std::uint32_t subgroupSize = 0, minSubgroupSize = 0, maxSubgroupSize = 0;
    std::uint32_t queueFamily = 0;  ///< graphics and compute
    bool suitable = false;
    std::string missing;  ///< one sentence if not suitable, else empty
    int rank = 0;         ///< higher is preferred
    VkPhysicalDeviceProperties properties{};
};

/// Functions of VK_EXT_debug_utils, null without it. Per instance: volk's globals hold those of the instance made last,
/// which may be null.
struct DebugFunctions {
    PFN_vkCreateDebugUtilsMessengerEXT createMessenger = nullptr;
    PFN_vkDestroyDebugUtilsMessengerEXT destroyMessenger = nullptr;
    PFN_vkSetDebugUtilsObjectNameEXT setObjectName = nullptr;
    PFN_vkCmdBeginDebugUtilsLabelEXT beginLabel = nullptr;
    PFN_vkCmdEndDebugUtilsLabelEXT endLabel = nullptr;
};

class VulkanInstance {
public:
    /// Throws GpuError if there is no Vulkan loader, no Vulkan 1.3 or no validation layer although one was asked for.
    explicit VulkanInstance(const InstanceDesc& desc = {});
    ~VulkanInstance();
    VulkanInstance(const VulkanInstance&) = delete;
    VulkanInstance& operator=(const VulkanInstance&) = delete;

    [[nodiscard]] VkInstance handle() const { return instance_; }
    [[nodiscard]] bool debugLabels() const { return debugUtils_; }
    [[nodiscard]] const DebugFunctions& debug() const { return debug_; }
    [[nodiscard]] MessageLog& messages() const { return *log_; }

    /// Every physical device in the loader's order, suitable or not.
    [[nodiscard]] std::vector<DeviceInfo> listDevices() const;

    /// Empty: the best suitable device. Else an index into listDevices() or a part of a name in any case. Throws
    /// GpuError with a sentence that lists the known names if nothing matches or the match lacks something.
    [[nodiscard]] DeviceInfo chooseDevice(std::string_view wanted = {}) const;

private:
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    DebugFunctions debug_;
    bool debugUtils_ = false;
    std::unique_ptr<MessageLog> log_;
};

}  // namespace gnomon::renderer
