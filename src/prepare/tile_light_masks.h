#pragma once
// Tile light masks: one bit per light for every 32x32 pixels.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gpu_interface/numbers.h"
#include "prepare/cull_and_sort.h"
#include "prepare/screen_bounds.h"

namespace gnomon::prepare {

class TileLightMasks {
public:
    /// May throw std::bad_alloc.
    void create(std::uint32_t maxColumns, std::uint32_t maxRows);

    /// Finds which tiles each light covers.
    void cover(const ScreenGrid& grid, std::span<const VisibleLight> lights) noexcept;
    /// Share of the grid's tiles that a light covers, 0 to 1; directional lights cover all.
    [[nodiscard]] float share(const ScreenGrid& grid, std::uint32_t light) const noexcept;
    /// Writes grid.columns * grid.rows entries of what cover() found, row by row, front to back, without reading any
    /// back.
    void write(const ScreenGrid& grid, void* destination) noexcept;

private:
    static constexpr std::uint32_t kWords = gpu::kLightGroupCount;
    void markRow(std::uint32_t row) noexcept;
    unsigned char* writeRow(const ScreenGrid& grid, unsigned char* destination) noexcept;

    ScreenBounds bounds_;
    std::array<std::uint32_t, kWords> everywhere_{};  // lights that cover the whole screen
    std::vector<std::uint32_t> spans_;                // up to 1024 per row, packed
    std::vector<std::uint32_t> spanCounts_;           // by row
    std::vector<std::uint32_t> tileCounts_;           // by light
    std::vector<std::uint32_t> changes_;              // of one row: bits that flip at each column's left edge
    std::vector<std::uint32_t> changedWords_;         // of one row: a bit per word of changes_ that is not zero
};

}  // namespace gnomon::prepare
