#pragma once
// The device, as the library sees it: layouts, and a store of pipelines that all views share.

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "gnomon/export.h"
#include "gnomon/result.h"
#include "gnomon/settings.h"

namespace gnomon {

/// Needs Vulkan 1.3 with synchronization2, and computeFullSubgroups and subgroupSizeControl enabled; subgroup
/// operations (basic, arithmetic) in compute shaders; 21 storage buffers per stage; for debugLabels VK_EXT_debug_utils
/// on the instance.
struct ContextDesc {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;
    /// Optional; used as long as the context lives, by several threads at once (so not externally synchronized).
    VkPipelineCache pipelineCache = VK_NULL_HANDLE;
    /// Families of all queues that the recorded commands will be submitted to: one, or several where phases run on an
    /// async compute queue (buffers are then shared concurrently, and no ownership transfer is needed). Up to 8.
    std::span<const std::uint32_t> queueFamilies;
    bool debugLabels = false;
    /// 0: the device's own choice. Else 4, 8, 16, 32 or 64, which the device must support.
    std::uint32_t subgroupSize = 0;
    /// 1 to 4: atlases that a frame may have. With one, shaders need not choose at every tap.
    std::uint32_t maxShadowAtlases = 4;
    /// Optional SPIR-V of src/generate_shadows/filter_pairs.comp, compiled by the host with
    /// -DGNOMON_HOST_PROVIDER and a gnomon_host_provider.glsl on the include path, for lights with Filter::Host: see
    /// docs/integration.md. Copied.
    std::span<const std::uint32_t> filterPairsSpirv;
};

/// Values of the library's specialization constants. Constant `id` has the id-th value, four bytes.
struct SpecializationValues {
    static constexpr std::uint32_t kCount = 12;
    std::array<std::uint32_t, kCount> values = {};
    bool operator==(const SpecializationValues&) const = default;
};

/// create() and the destructor: one thread at a time per device. All else is thread safe.
class GNOMON_API Context {
public:
    static Result create(const ContextDesc& desc, std::unique_ptr<Context>& out) noexcept;
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Makes the pipelines of these settings that do not exist yet, so that no frame has to. May take seconds; may run
    /// on a thread of its own while frames are recorded. Fails with a sentence on bad settings. Pipelines live as long
    /// as the context.
    Result prepare(const ShadowSettings& settings) const noexcept;
    /// Pipelines made so far.
    [[nodiscard]] std::uint32_t pipelineCount() const noexcept;

    /// Layouts of sets 0, 1 and 2 for the host's pipelines; valid as long as the context.
    [[nodiscard]] VkDescriptorSetLayout listsSetLayout() const noexcept;
    [[nodiscard]] VkDescriptorSetLayout receiversSetLayout() const noexcept;
    [[nodiscard]] VkDescriptorSetLayout shadowmapsSetLayout() const noexcept;
    [[nodiscard]] std::uint32_t subgroupSize() const noexcept;
    /// For pipelines of the host that include src/shading. Pipelines with equal values may be shared.
    [[nodiscard]] SpecializationValues specialization(const ShadowSettings& settings) const noexcept;

    struct State;
    [[nodiscard]] State& state() const noexcept { return *state_; }  ///< for the library itself

private:
    explicit Context(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

}  // namespace gnomon
