#include "renderer/frame/shadowmaps.h"

#include <algorithm>

#include "gpu_interface/numbers.h"
#include "renderer/gpu/error.h"

namespace gnomon::renderer {

Shadowmaps::Shadowmaps(const Device& device, const Context& context, const GpuScene& scene, const RendererDesc& desc,
                       std::uint32_t atlasSizePx, std::uint32_t framesInFlight)
    : device_(device),
      context_(context),
      scene_(scene),
      atlasSizePx_(atlasSizePx),
      mostPairs_(std::max(desc.keptDrawings, 1u)) {
    viewDesc_.maxWidthPx = desc.frame.widthPx;
    viewDesc_.maxHeightPx = desc.frame.heightPx;
    viewDesc_.framesInFlight = framesInFlight;
    viewDesc_.listEntries = desc.listEntries;
    viewDesc_.visibilitySlots = desc.visibilitySlots;
    viewDesc_.visibilityBits = desc.frame.shadows.visibilityBits;
    viewDesc_.mostListEntries = desc.mostListEntries;
    viewDesc_.mostVisibilitySlots = desc.mostVisibilitySlots;
    viewDesc_.shadowBoundsTexels = std::uint64_t{atlasSizePx} * atlasSizePx;
    viewDesc_.maxShadowViews = gpu::kMaxLightsPerView * gpu::kPointLightFaces;
    addPair(desc.frame.drawing);
    current_ = pairs_.front().get();
}

void Shadowmaps::addPair(const ShadowDrawing& drawing) {
    std::unique_ptr<View> view;
    require(View::create(context_, viewDesc_, view));
    pairs_.push_back(
        std::make_unique<Pair>(ShadowAtlasImage(device_, scene_, atlasSizePx_, 1, drawing), std::move(view)));
}

Shadowmaps::Pair& Shadowmaps::pairFor(const ShadowDrawing& drawing) {
    const auto same = std::ranges::find_if(pairs_, [&](const auto& p) { return p->atlas.drawing() == drawing; });
    if (same != pairs_.end()) {
        current_ = same->get();
    } else if (pairs_.size() < mostPairs_) {
        addPair(drawing);
        current_ = pairs_.back().get();
    } else {
        current_ = std::ranges::min_element(pairs_, {}, [](const auto& p) { return p->lastUsed; })->get();
        current_->atlas.setDrawing(drawing);
    }
    current_->lastUsed = ++uses_;
    return *current_;
}

void Shadowmaps::growTo(std::uint32_t widthPx, std::uint32_t heightPx) {
    if (widthPx <= viewDesc_.maxWidthPx && heightPx <= viewDesc_.maxHeightPx) return;
    ViewDesc larger = viewDesc_;
    larger.maxWidthPx = std::max(larger.maxWidthPx, widthPx);
    larger.maxHeightPx = std::max(larger.maxHeightPx, heightPx);
    for (const auto& pair : pairs_) require(pair->view->resize(larger));
    viewDesc_ = larger;
}

}  // namespace gnomon::renderer
