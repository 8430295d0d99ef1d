// Tile light masks. Source: the paper, section 2.1.2 and figure 4. Its bit field of 1024 lights is 128 bytes, not 32;
// the 132-byte entry of its glossary is right.
//
// Problem: fill 8,160 entries of 33 words (at 3840x2160) from up to 1024 lights.
// Plain way: set a bit in every tile that a light covers. A thousand lights that each cover the screen set eight
// million bits, spread over a megabyte, and read them back. That is no use on write-combined memory.
// What we do: a light covers one span of columns per row of tiles (screen_bounds.cpp). So a row of tiles is told by
// where spans begin and end.
// - Both ends flip the light's bit. Along a row, an entry is the one to its left with those bits flipped. Only words in
//   which something flips are touched.
// - The cost is two marks per span, and one copy of 132 bytes per tile, streamed once in order.
// - Lights that cover the whole screen are set once for all rows.
// Limits: the row's marks take 132 bytes per column (16 KB at 3840), which should stay in the nearest cache.

#include "prepare/tile_light_masks.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace gnomon::prepare {
namespace {

// A span in one word: light : 10, first column : 11, column after the last : 11.
static_assert(gpu::kMaxExtentPx / gpu::kMaskTileSizePx < 2048);
constexpr std::uint32_t packSpan(std::uint32_t light, TileSpan span) {
    return light | (static_cast<std::uint32_t>(span.first) << 10) | (static_cast<std::uint32_t>(span.last) << 21);
}

}  // namespace

void TileLightMasks::create(std::uint32_t maxColumns, std::uint32_t maxRows) {
    bounds_.create(maxRows);
    spans_.resize(static_cast<std::size_t>(maxRows) * gpu::kMaxLightsPerView);
    spanCounts_.resize(maxRows);
    tileCounts_.resize(gpu::kMaxLightsPerView);
    changes_.assign((static_cast<std::size_t>(maxColumns) + 1) * kWords, 0);
    changedWords_.assign(maxColumns + 1, 0);
}

void TileLightMasks::write(const ScreenGrid& grid, void* destination) noexcept {
    auto* out = static_cast<unsigned char*>(destination);
    for (std::uint32_t row = 0; row < grid.rows; ++row) {
        markRow(row);
        out = writeRow(grid, out);
    }
}

float TileLightMasks::share(const ScreenGrid& grid, std::uint32_t light) const noexcept {
    return static_cast<float>(tileCounts_[light]) / static_cast<float>(grid.columns * grid.rows);
}

void TileLightMasks::cover(const ScreenGrid& grid, std::span<const VisibleLight> lights) noexcept {
    everywhere_.fill(0);
    std::fill_n(spanCounts_.begin(), grid.rows, 0u);
    for (std::uint32_t light = 0; light < lights.size(); ++light) {
        tileCounts_[light] = grid.columns * grid.rows;
        if (lights[light].directional) continue;
        const Coverage coverage = bounds_.cover(grid, lights[light].volume);
        if (coverage.everywhere) {
            everywhere_[light / gpu::kLightGroupSize] |= 1u << (light % gpu::kLightGroupSize);
            continue;
        }
        const TileSpan* spans = bounds_.spans();
        tileCounts_[light] = 0;
        for (std::uint32_t row = coverage.firstRow; row < coverage.lastRow; ++row) {
            if (spans[row].first >= spans[row].last) continue;
            spans_[static_cast<std::size_t>(row) * gpu::kMaxLightsPerView + spanCounts_[row]++] =
                packSpan(light, spans[row]);
            tileCounts_[light] += std::uint32_t(spans[row].last) - spans[row].first;
        }
    }
}

void TileLightMasks::markRow(std::uint32_t row) noexcept {
    const std::uint32_t* spans = spans_.data() + static_cast<std::size_t>(row) * gpu::kMaxLightsPerView;
    std::uint32_t *changes = changes_.data(), *changedWords = changedWords_.data();
    for (std::uint32_t i = 0; i < spanCounts_[row]; ++i) {
        const std::uint32_t light = spans[i] & 1023u, first = (spans[i] >> 10) & 2047u, last = spans[i] >> 21;
        const std::uint32_t word = light / gpu::kLightGroupSize, bit = 1u << (light % gpu::kLightGroupSize);
        changes[first * kWords + word] ^= bit;
        changes[last * kWords + word] ^= bit;
        changedWords[first] |= 1u << word;
        changedWords[last] |= 1u << word;
    }
}

unsigned char* TileLightMasks::writeRow(const ScreenGrid& grid, unsigned char* destination) noexcept {
    std::uint32_t entry[gpu::kLightMaskEntryWords] = {};
    for (std::uint32_t word = 0; word < kWords; ++word) {
        entry[1 + word] = everywhere_[word];
        entry[0] |= (everywhere_[word] != 0 ? 1u : 0u) << word;
    }
    // One column past the last: marks there are cleared for the next row.
    for (std::uint32_t column = 0; column <= grid.columns; ++column) {
        std::uint32_t* changes = changes_.data() + static_cast<std::size_t>(column) * kWords;
        for (std::uint32_t left = changedWords_[column]; left != 0; left &= left - 1) {
            const auto word = static_cast<std::uint32_t>(std::countr_zero(left));
            entry[1 + word] ^= changes[word];
            changes[word] = 0;
            entry[0] = (entry[0] & ~(1u << word)) | ((entry[1 + word] != 0 ? 1u : 0u) << word);
        }
        changedWords_[column] = 0;
        if (column == grid.columns) break;
        std::memcpy(destination, entry, sizeof(entry));
        destination += sizeof(entry);
    }
    return destination;
}

}  // namespace gnomon::prepare
