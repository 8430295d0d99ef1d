#pragma once
// The lighting pipelines and their layouts, apart from the images they work on. So they can also be made, and looked
// at, on a device that can only compile.

#include <compare>
#include <map>
#include <vector>

#include "gnomon/context.h"
#include "renderer/gpu/pipeline.h"

namespace gnomon::renderer {

/// The lighting passes' own set: see renderer/lighting/lighting_set.glsl.
inline constexpr VkDescriptorType kLightingSetTypes[] = {
    VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
    VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
    VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER};

enum class LightingKind : std::uint8_t {
    Deferred,    ///< reads final lists and slots; no shadowmap
    Evaluate,    ///< the second pipeline, for tiles in which a slot or list space was missing
    Inline,      ///< the paper's "before": shadows evaluated in the lighting shader
    Unshadowed,  ///< every light lit
};

/// What the picture's channels are.
enum class PictureFormat : std::uint8_t { Half, Float };

/// How the inline pipeline is compiled.
struct InlineVariant {
    bool quantises = true;  ///< visibility has the bits of a slot; off: to measure what they cost
    /// Tiles without list space are shaded too, which costs registers. Off: their lights are left out
    /// (FrameStatistics::listOverflowTiles counts them), for measurements of the fastest inline shading.
    bool walksMasks = true;
    bool operator==(const InlineVariant&) const = default;
};

/// Pipelines are made when they are first needed, and kept. Not thread safe.
class LightingPipelines {
public:
    /// The context must outlive this. Throws GpuError.
    LightingPipelines(const Device& device, const Context& context);

    /// Throws GpuError.
    VkPipeline get(LightingKind kind, const ShadowSettings& settings, const InlineVariant& variant = {},
                   PictureFormat format = PictureFormat::Half);
    [[nodiscard]] VkPipelineLayout layoutOf(LightingKind kind) const {
        return kind == LightingKind::Deferred ? mainLayout_ : evaluateLayout_;
    }
    [[nodiscard]] VkDescriptorSetLayout ownSet() const { return ownSet_; }
    [[nodiscard]] std::size_t count() const { return pipelines_.size(); }

private:
    const Device& device_;
    const Context& context_;
    SetLayout ownSet_, emptySet_;
    PipelineLayout mainLayout_;      // without the set of the shadowmaps
    PipelineLayout evaluateLayout_;  // with it
    struct Key {
        LightingKind kind;
        PictureFormat format;
        std::vector<std::uint32_t> constants;
        auto operator<=>(const Key&) const = default;
    };
    std::map<Key, Pipeline> pipelines_;
};

/// The subgroup size that pipelines with the library's shaders ask for. 0: they do not ask. Then the device has one
/// size only, and perhaps cannot be asked for it.
std::uint32_t requiredSubgroupSize(const Device& device, const Context& context);

}  // namespace gnomon::renderer
