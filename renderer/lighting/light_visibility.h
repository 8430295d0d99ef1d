#pragma once
// Reads the visibility of single lights back: what the lighting passes of the last frame multiplied each light with.

#include <cstdint>
#include <vector>

#include <array>
#include <map>

#include "gnomon/view.h"
#include "renderer/gpu/pipeline.h"
#include "renderer/gpu/resources.h"

namespace gnomon::renderer {

/// Stands for a pixel that the light does not reach (range, cone, background), or a light that is not in view.
inline constexpr float kNotReached = -1.0f;

/// Made when they are first needed, and kept. Not thread safe.
class LightVisibilityPipelines {
public:
    /// The context must outlive this. Throws GpuError.
    LightVisibilityPipelines(const Device& device, const Context& context);

    /// Throws GpuError.
    VkPipeline get(const ShadowSettings& settings);
    [[nodiscard]] VkDescriptorSetLayout ownSet() const { return ownSet_; }
    [[nodiscard]] VkPipelineLayout layout() const { return layout_; }

private:
    const Device& device_;
    const Context& context_;
    SetLayout ownSet_;
    PipelineLayout layout_;
    std::map<std::array<std::uint32_t, SpecializationValues::kCount>, Pipeline> pipelines_;
};

/// Not thread safe.
class LightVisibility {
public:
    /// The pipelines must outlive this. Throws GpuError.
    LightVisibility(const Device& device, LightVisibilityPipelines& pipelines, std::uint32_t widthPx,
                    std::uint32_t heightPx);

    /// Of the light with this index among those given to the view's last frame, which must have had phase 4 and have
    /// finished. Per pixel 0 to 1 or kNotReached. Waits for the device.
    /// `settings`: that frame's. `widthPx` and `heightPx`: its active extent, at most what this was made for.
    [[nodiscard]] std::vector<float> read(const View& view, const ShadowSettings& settings, std::uint32_t light,
                                          std::uint32_t widthPx, std::uint32_t heightPx);

private:
    const Device& device_;
    LightVisibilityPipelines& pipelines_;
    DescriptorPool pool_;
    VkDescriptorSet ownSet_ = VK_NULL_HANDLE;
    GpuImage picture_;
    Commands commands_;
};

}  // namespace gnomon::renderer
