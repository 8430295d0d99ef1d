#pragma once
// Atlases and views, one pair per way of drawing shadowmaps: what one way has drawn stays while another is measured.

#include <memory>
#include <vector>

#include "gnomon/view.h"
#include "renderer/frame/renderer_desc.h"
#include "renderer/shadow_atlas/shadow_atlas.h"

namespace gnomon::renderer {

/// Not thread safe.
class Shadowmaps {
public:
    struct Pair {
        ShadowAtlasImage atlas;
        std::unique_ptr<View> view;
        std::uint64_t lastUsed = 0;
    };

    /// Makes the first pair. All must outlive this. Throws GpuError.
    Shadowmaps(const Device& device, const Context& context, const GpuScene& scene, const RendererDesc& desc,
               std::uint32_t atlasSizePx, std::uint32_t framesInFlight);

    /// The pair for a frame. A way of drawing that is new gets a pair of its own, or the one unused for longest. Throws
    /// GpuError.
    Pair& pairFor(const ShadowDrawing& drawing);
    /// The pair last asked for.
    [[nodiscard]] Pair& current() { return *current_; }
    [[nodiscard]] const Pair& current() const { return *current_; }
    /// All views for an extent of at least this. Throws GpuError.
    void growTo(std::uint32_t widthPx, std::uint32_t heightPx);
    [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(pairs_.size()); }

private:
    void addPair(const ShadowDrawing& drawing);

    const Device& device_;
    const Context& context_;
    const GpuScene& scene_;
    std::uint32_t atlasSizePx_, mostPairs_;
    ViewDesc viewDesc_;
    std::vector<std::unique_ptr<Pair>> pairs_;
    Pair* current_ = nullptr;
    std::uint64_t uses_ = 0;
};

}  // namespace gnomon::renderer
