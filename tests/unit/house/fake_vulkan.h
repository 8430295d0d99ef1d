#pragma once
// A Vulkan driver that only writes down what it is asked: for tests of what the library asks for and how it refuses a
// device, without any device. One at a time per process; not thread safe.

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "gnomon/gnomon.h"

namespace gnomon::house {

class FakeVulkan {
public:
    FakeVulkan();
    ~FakeVulkan();
    FakeVulkan(const FakeVulkan&) = delete;
    FakeVulkan& operator=(const FakeVulkan&) = delete;

    /// A description with non-null handles and this driver's vkGetInstanceProcAddr.
    [[nodiscard]] ContextDesc desc() const;

    // What the device says. Starts as a device that the library accepts.
    VkPhysicalDeviceProperties properties{};
    VkSubgroupFeatureFlags subgroupOperations = 0;
    std::uint32_t storageBuffersPerStage = 64;
    VkShaderStageFlags subgroupStages = VK_SHADER_STAGE_ALL;
    VkShaderStageFlags requiredSubgroupSizeStages = VK_SHADER_STAGE_COMPUTE_BIT;
    std::uint32_t subgroupSize = 32, minSubgroupSize = 32, maxSubgroupSize = 64;
    std::uint32_t timestampBits = 64;
    std::set<std::string> hidden;   // functions that it has not, by their whole names
    std::uint32_t failAfter = ~0u;  // so many objects are made, then making one runs out of memory

    // What it was asked.
    struct Binding {
        std::uint32_t binding;
        VkDescriptorType type;
        std::uint32_t count;
    };
    struct SetLayout {
        VkDescriptorSetLayout handle;
        std::vector<Binding> bindings;
    };
    struct Pipeline {
        VkPipelineShaderStageCreateFlags stageFlags = 0;
        std::uint32_t requiredSubgroupSize = 0;            // 0: not asked for
        std::size_t spirvBytes = 0;                        // of its shader
        std::map<std::uint32_t, std::uint32_t> constants;  // by id
    };
    std::vector<SetLayout> setLayouts;
    std::map<VkShaderModule, std::size_t> modules;  // bytes of all that were made
    std::map<VkBuffer, VkBufferUsageFlags> usages;  // likewise
    std::vector<Pipeline> pipelines;
    std::map<VkDeviceMemory, std::vector<std::byte>> memory;  // all that was allocated and not freed
    std::uint32_t made = 0, destroyed = 0;                    // memory included
    std::uint32_t callsWithoutDevice = 0;                     // with a null VkDevice: a real driver crashes

    [[nodiscard]] const SetLayout* find(VkDescriptorSetLayout handle) const;
};

}  // namespace gnomon::house
