// Tile light masks. Source: the paper, section 2.1.2 and figure 4. Its bit field of 1024 lights is 128 bytes, not 32;
// the 132-byte entry of its glossary is right.
//
// Problem: fill 8,160 entries of 33 words (at 3840x2160) from up to 1024 lights.
// Plain way: set a bit in every tile that a light covers. A thousand lights that each cover the screen set eight
// million bits, spread over a megabyte, and read them back. That is no use on write-combined memory.
// What we do: a light covers one span of columns per row of tiles (screen_bounds.cpp). So a row of tiles is told by
// where spans begin and end.
// - Both ends flip the light's bit. Along a row, an entry is the one to its left with those bits flipped.
// - Where something flips, the entry flips as a whole, 32 words at once. That has no branches and is vectorised.
// Looking
//   for the words in which something flips costs more. So does a flip in every column, unless there are many lights.
// - A span of all columns has no ends in the row. Its bit is set where the row begins.
// - The cost is two marks per shorter span, and one entry of 132 bytes per tile, streamed once in order.
// - Lights that cover the whole screen are set once for all rows.
// Limits: the row's marks take 128 bytes per column (15 KB at 3840), which should stay in the nearest cache.

#include "prepare/tile_light_masks.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "gpu_interface/packing.h"

namespace gnomon::prepare {
namespace {

// A span in one word: first column : 16, column after the last : 16.
static_assert(gpu::kMaxExtentPx / gpu::kMaskTileSizePx <= 0xFFFFu);
constexpr std::uint32_t packSpan(std::int32_t first, std::int32_t end) {
    return static_cast<std::uint32_t>(first) | static_cast<std::uint32_t>(end) << 16;
}

constexpr std::array<std::uint32_t, gpu::kLightGroupCount> makeGroupBits() {
    std::array<std::uint32_t, gpu::kLightGroupCount> bits{};
    for (std::uint32_t group = 0; group < gpu::kLightGroupCount; ++group) bits[group] = 1u << group;
    return bits;
}
constexpr auto kGroupBits = makeGroupBits();

// A bit per word that is not zero. All ones or zero, and a table of bits: written so, the loop is vectorised.
std::uint32_t groupMaskOf(const std::array<std::uint32_t, gpu::kLightGroupCount>& words) {
    std::uint32_t mask = 0;
    for (std::uint32_t group = 0; group < gpu::kLightGroupCount; ++group) {
        const std::uint32_t present = words[group] != 0 ? ~0u : 0u;
        mask |= present & kGroupBits[group];
    }
    return mask;
}

}  // namespace

void TileLightMasks::create(std::uint32_t maxColumns, std::uint32_t maxRows) {
    maxRows_ = maxRows;
    const std::size_t groupRows = static_cast<std::size_t>(kWords) * maxRows;
    wholeRows_.resize(groupRows);
    partOfRows_.resize(groupRows);
    spans_.resize(groupRows * gpu::kLightGroupSize);
    tileCounts_.resize(gpu::kMaxLightsPerView);
    changes_.assign((static_cast<std::size_t>(maxColumns) + 1) * kWords, 0);
    changed_.assign(maxColumns + 1, 0);
}

void TileLightMasks::write(const ScreenGrid& grid, void* destination) noexcept {
    auto* out = static_cast<unsigned char*>(destination);
    for (std::uint32_t row = 0; row < grid.rows; ++row) {
        markRow(row);
        out = writeRow(grid, row, out);
    }
}

float TileLightMasks::share(const ScreenGrid& grid, std::uint32_t light) const noexcept {
    return static_cast<float>(tileCounts_[light]) / static_cast<float>(grid.columns * grid.rows);
}

void TileLightMasks::cover(const ScreenGrid& grid, std::span<const VisibleLight> lights) noexcept {
    everywhere_.fill(0);
    groupCount_ = gpu::divideRoundingUp(static_cast<std::uint32_t>(lights.size()), gpu::kLightGroupSize);
    for (std::uint32_t group = 0; group < groupCount_; ++group) {
        std::fill_n(wholeRows_.begin() + group * maxRows_, grid.rows, 0u);
        std::fill_n(partOfRows_.begin() + group * maxRows_, grid.rows, 0u);
    }
    for (std::uint32_t light = 0; light < lights.size(); ++light) {
        tileCounts_[light] = grid.columns * grid.rows;
        if (lights[light].directional) continue;
        const Coverage coverage = bounds_.cover(grid, lights[light].volume, lights[light].depth);
        if (coverage.everywhere) {
            everywhere_[light / gpu::kLightGroupSize] |= 1u << (light % gpu::kLightGroupSize);
        } else {
            coverRows(grid, coverage, light);
        }
    }
}

void TileLightMasks::coverRows(const ScreenGrid& grid, Coverage coverage, std::uint32_t light) noexcept {
    const std::uint32_t lane = light % gpu::kLightGroupSize, bit = 1u << lane;
    const std::size_t groupRow = static_cast<std::size_t>(light / gpu::kLightGroupSize) * maxRows_;
    std::uint32_t *wholeRows = wholeRows_.data() + groupRow, *partOfRows = partOfRows_.data() + groupRow;
    std::uint32_t* spans = spans_.data() + groupRow * gpu::kLightGroupSize + lane;
    const std::int32_t *firsts = bounds_.firstColumns(), *ends = bounds_.endColumns();
    const auto columns = static_cast<std::int32_t>(grid.columns);
    std::uint32_t tiles = 0;
    for (std::uint32_t row = coverage.firstRow; row < coverage.lastRow; ++row) {
        const std::int32_t width = ends[row] - firsts[row];
        // All ones or zero: arithmetic on them has no branches, so that compilers vectorise it.
        const std::uint32_t some = width > 0 ? ~0u : 0u, whole = width == columns ? ~0u : 0u;
        tiles += some & static_cast<std::uint32_t>(width);
        wholeRows[row] |= whole & bit;
        partOfRows[row] |= some & ~whole & bit;
    }
    for (std::uint32_t row = coverage.firstRow; row < coverage.lastRow; ++row) {
        spans[row * gpu::kLightGroupSize] = packSpan(firsts[row], ends[row]);
    }
    tileCounts_[light] = tiles;
}

void TileLightMasks::markRow(std::uint32_t row) noexcept {
    std::uint32_t* changes = changes_.data();
    std::uint8_t* changed = changed_.data();
    for (std::uint32_t group = 0; group < groupCount_; ++group) {
        const std::size_t groupRow = static_cast<std::size_t>(group) * maxRows_ + row;
        const std::uint32_t* spans = spans_.data() + groupRow * gpu::kLightGroupSize;
        for (std::uint32_t left = partOfRows_[groupRow]; left != 0; left &= left - 1) {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
            const std::uint32_t bit = 1u << lane, first = spans[lane] & 0xFFFFu, end = spans[lane] >> 16;
            changes[first * kWords + group] ^= bit;
            changes[end * kWords + group] ^= bit;
            changed[first] = 1;
            changed[end] = 1;
        }
    }
}

unsigned char* TileLightMasks::writeRow(const ScreenGrid& grid, std::uint32_t row,
                                        unsigned char* destination) noexcept {
    std::array<std::uint32_t, kWords> words = {};
    for (std::uint32_t group = 0; group < groupCount_; ++group) {
        words[group] = everywhere_[group] | wholeRows_[static_cast<std::size_t>(group) * maxRows_ + row];
    }
    std::uint32_t groupMask = groupMaskOf(words);
    // One column past the last: marks there are cleared for the next row.
    for (std::uint32_t column = 0; column <= grid.columns; ++column) {
        if (changed_[column] != 0) {
            std::uint32_t* changes = changes_.data() + static_cast<std::size_t>(column) * kWords;
            for (std::uint32_t word = 0; word < kWords; ++word) {
                words[word] ^= changes[word];
                changes[word] = 0;
            }
            groupMask = groupMaskOf(words);
            changed_[column] = 0;
        }
        if (column == grid.columns) break;
        std::memcpy(destination, &groupMask, sizeof(groupMask));
        std::memcpy(destination + sizeof(groupMask), words.data(), sizeof(words));
        destination += sizeof(groupMask) + sizeof(words);
    }
    return destination;
}

}  // namespace gnomon::prepare
