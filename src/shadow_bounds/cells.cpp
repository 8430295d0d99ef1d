#include "shadow_bounds/cells.h"

#include <algorithm>

#include "gpu_interface/packing.h"

namespace gnomon {
namespace {

using namespace gpu;

// Calls `use` with the index of every cell of an atlas layer that the view touches, and its place.
template <typename Use>
void forEachCell(const ShadowView& view, std::uint32_t layerCell, std::uint32_t columns, const Use& use) {
    const std::uint32_t lastX = (view.xPx + view.widthPx - 1) / kShadowBoundsCellPx;
    const std::uint32_t lastY = (view.yPx + view.heightPx - 1) / kShadowBoundsCellPx;
    for (std::uint32_t y = view.yPx / kShadowBoundsCellPx; y <= lastY; ++y) {
        for (std::uint32_t x = view.xPx / kShadowBoundsCellPx; x <= lastX; ++x) use(layerCell + y * columns + x, x, y);
    }
}

bool sameAtlas(const ShadowAtlas& a, const ShadowAtlas& b) {
    return a.view == b.view && a.widthPx == b.widthPx && a.heightPx == b.heightPx && a.layers == b.layers;
}

}  // namespace

std::uint32_t shadowBoundsCellsFor(std::uint64_t texels) noexcept {
    const std::uint64_t perCell = std::uint64_t(kShadowBoundsCellPx) * kShadowBoundsCellPx;
    const std::uint64_t cells = texels / perCell + (texels % perCell != 0 ? 1 : 0);
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(cells, 1u << 20));
}

std::uint64_t shadowBoundsBytes(std::uint32_t cells) noexcept {
    return std::uint64_t(cells) * kShadowBoundsCellEntries * sizeof(vec2);
}

void ShadowBoundsCells::create(std::uint32_t capacity) {
    capacity_ = capacity;
    state_.assign(capacity, Cell::Unknown);
}

// Where each atlas' cells lie; false if they do not fit. Other atlases than last frame's start afresh.
bool ShadowBoundsCells::layOut(std::span<const ShadowAtlas> atlases) noexcept {
    const bool same = atlases.size() == atlasCount_ && std::equal(atlases.begin(), atlases.end(), atlases_, sameAtlas);
    std::uint64_t cells = 0;
    for (std::size_t i = 0; i < atlases.size(); ++i) {
        Grid& grid = grids_[i];
        grid.columns = divideRoundingUp(atlases[i].widthPx, kShadowBoundsCellPx);
        grid.rows = divideRoundingUp(atlases[i].heightPx, kShadowBoundsCellPx);
        grid.firstCell = static_cast<std::uint32_t>(std::min<std::uint64_t>(cells, 0xFFFFFFFFu));
        cells += std::uint64_t(grid.columns) * grid.rows * atlases[i].layers;
    }
    const bool fits = cells <= capacity_;
    if (!same || !fits) std::fill(state_.begin(), state_.end(), Cell::Unknown);
    atlasCount_ = static_cast<std::uint32_t>(atlases.size());
    std::copy(atlases.begin(), atlases.end(), atlases_);
    return fits && capacity_ != 0;
}

std::uint32_t ShadowBoundsCells::list(std::span<const ShadowView> views, std::span<const ShadowAtlas> atlases,
                                      GpuShadowView* gpuViews, GpuShadowBoundsCell* out) noexcept {
    if (!layOut(atlases)) return 0;
    std::replace(state_.begin(), state_.end(), Cell::Listed, Cell::Unknown);
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < views.size(); ++i) {
        const ShadowView& view = views[i];
        const ShadowAtlas& atlas = atlases[view.atlas];
        const Grid& grid = grids_[view.atlas];
        const std::uint32_t layerCell = grid.firstCell + view.layer * grid.columns * grid.rows;
        const std::uint32_t row = grid.columns * kShadowBoundsCellBlocks;
        const std::uint32_t blocks = row * grid.rows * kShadowBoundsCellBlocks;
        gpuViews[i].boundsFirst = layerCell * kShadowBoundsCellEntries;
        gpuViews[i].boundsRow = row;
        gpuViews[i].boundsBlocks = blocks;
        forEachCell(view, layerCell, grid.columns, [&](std::uint32_t cell, std::uint32_t x, std::uint32_t y) {
            if (state_[cell] == Cell::Listed || (state_[cell] == Cell::Made && !view.changed)) return;
            state_[cell] = Cell::Listed;
            out[count++] = {view.atlas | view.layer << 8,
                            x,
                            y,
                            layerCell * kShadowBoundsCellEntries,
                            row,
                            blocks,
                            1.0f / static_cast<float>(atlas.widthPx),
                            1.0f / static_cast<float>(atlas.heightPx)};
        });
    }
    return count;
}

void ShadowBoundsCells::made() noexcept {
    std::replace(state_.begin(), state_.end(), Cell::Listed, Cell::Made);
}

void ShadowBoundsCells::skip(std::span<const ShadowView> views, std::span<const ShadowAtlas> atlases) noexcept {
    if (capacity_ == 0 || !layOut(atlases)) return;
    for (const ShadowView& view : views) {
        if (!view.changed) continue;
        const Grid& grid = grids_[view.atlas];
        const std::uint32_t layerCell = grid.firstCell + view.layer * grid.columns * grid.rows;
        forEachCell(view, layerCell, grid.columns,
                    [&](std::uint32_t cell, std::uint32_t, std::uint32_t) { state_[cell] = Cell::Unknown; });
    }
}

}  // namespace gnomon
