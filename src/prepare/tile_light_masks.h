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
    void coverRows(const ScreenGrid& grid, Coverage coverage, std::uint32_t light) noexcept;
    void markRow(std::uint32_t row) noexcept;
    unsigned char* writeRow(const ScreenGrid& grid, std::uint32_t row, unsigned char* destination) noexcept;

    ScreenBounds bounds_;
    std::array<std::uint32_t, kWords> everywhere_{};  // lights that cover the whole screen
    // By light group and row. Of the group's 32 lights, which have a span of all columns, and which a shorter one. The
    // spans of the latter, packed: 32 per group and row.
    std::uint32_t maxRows_ = 0, groupCount_ = 0;
    std::vector<std::uint32_t> wholeRows_, partOfRows_, spans_;
    std::vector<std::uint32_t> tileCounts_;  // by light
    std::vector<std::uint32_t> changes_;     // of one row: bits that flip at each column's left edge
    std::vector<std::uint8_t> changed_;      // of one row: whether any does
};

}  // namespace gnomon::prepare
