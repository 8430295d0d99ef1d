#pragma once
// The shadow atlas: one D32 image with layers, and the pass that draws those shadow views whose content changed.
//
// By default everything is drawn in reversed Z and without hardware bias, since the library's oriented bias does the
// rest. Faces are not culled, so cloth without thickness casts from both sides. Subsurface casters are the exception:
// see ShadowDrawing::subsurfaceFronts.

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "gnomon/view.h"
#include "renderer/gpu/gpu_scene.h"
#include "renderer/shadow_atlas/drawing.h"
#include "renderer/shadow_atlas/plan.h"

namespace gnomon::renderer {

struct ShadowAtlasStatistics {
    std::uint32_t viewsDrawn = 0, viewsCached = 0;
    std::vector<std::uint32_t> drawnViews;  ///< indices into ShadowPlan::views
    std::uint32_t draws = 0;
    std::uint64_t triangles = 0;
};

/// Not thread safe. Layout outside of record(): SHADER_READ_ONLY_OPTIMAL.
class ShadowAtlasImage {
public:
    static constexpr VkFormat kFormat = VK_FORMAT_D32_SFLOAT;

    /// 4096 for up to 1080p, 8192 above; never more than the device draws, always a power of two.
    static std::uint32_t defaultSizePx(const Device& device, std::uint32_t screenHeightPx);

    /// Creates the image, wholly unoccluded. The scene gives the set layouts. Throws GpuError.
    ShadowAtlasImage(const Device& device, const GpuScene& scene, std::uint32_t sizePx, std::uint32_t layers = 1,
                     const ShadowDrawing& drawing = {});

    /// How casters are drawn from now on; if that is another way than before, everything is drawn again. Throws
    /// GpuError where the device cannot.
    void setDrawing(const ShadowDrawing& drawing);
    [[nodiscard]] const ShadowDrawing& drawing() const { return drawing_; }
    /// Finds what changed, and says it in the plan's views as ShadowView::changed. A shadow view is drawn again if its
    /// light or its rectangle changed, or if something moved in its volume. `lights` is what the plan was made from. To
    /// be called after GpuScene::recordTransforms() with the plan's origin. The plan must stay where it is until
    /// record().
    void prepare(const GpuScene& scene, std::span<const ShadowLight> lights, ShadowPlan& plan);
    /// Draws what prepare() found, outside of rendering. Afterwards visible to sampled reads of compute and fragment
    /// shaders.
    ShadowAtlasStatistics record(VkCommandBuffer commands, const GpuScene& scene);

    [[nodiscard]] const GpuImage& image() const { return image_; }
    /// For FrameDesc::atlases.
    [[nodiscard]] ShadowAtlas atlas() const { return {image_.view(), sizePx_, sizePx_, image_.desc().layers}; }
    [[nodiscard]] std::vector<MemoryRow> memoryRows() const { return {{"shadow atlas", image_.bytes()}}; }

private:
    // What a square shows; equal keys, equal contents.
    struct Key {
        glm::dvec3 position;
        glm::vec3 direction;
        float range, angle;
        LightKind kind;
        glm::dvec3 cascadeCentre;
        double cascadeExtent, cascadeDepth;
        std::uint32_t face, x, y, layer, size, guardTexels;
        bool operator==(const Key&) const = default;
    };
    struct Drawn {
        Key key;
        std::uint64_t castersRevision;  // up to which the square is known to be right
    };
    struct Task {
        const PlannedView* view;
        std::uint32_t firstRange, rangeCount;
    };
    [[nodiscard]] static Key keyOf(const ShadowLight& light, const PlannedView& view);
    void drawLayer(VkCommandBuffer commands, const GpuScene& scene, std::uint32_t layer,
                   ShadowAtlasStatistics& statistics) const;
    void drawView(VkCommandBuffer commands, const GpuScene& scene, const Task& task,
                  ShadowAtlasStatistics& statistics) const;

    const Device& device_;
    std::uint32_t sizePx_;
    ShadowDrawing drawing_;
    GpuImage image_;
    PipelineLayout layout_;
    Pipeline opaque_, masked_;
    std::unordered_map<std::uint64_t, Drawn> drawn_;    // per light * 8 + face
    std::unordered_map<std::uint64_t, Drawn> planned_;  // what drawn_ will be when this frame is recorded
    std::vector<Task> tasks_;
    ShadowAtlasStatistics statistics_;  // of the plan prepared last
    std::vector<DrawRange> ranges_;
    std::vector<GpuScene::Candidate> candidates_;
};

}  // namespace gnomon::renderer
