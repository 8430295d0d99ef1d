#include "renderer/shadow_atlas/pack.h"

#include <algorithm>
#include <bit>

namespace gnomon::renderer {

namespace {
std::uint32_t compact(std::uint32_t v) {
    v &= 0x55555555u;
    v = (v | (v >> 1)) & 0x33333333u;
    v = (v | (v >> 2)) & 0x0F0F0F0Fu;
    v = (v | (v >> 4)) & 0x00FF00FFu;
    return (v | (v >> 8)) & 0x0000FFFFu;
}
std::uint32_t spread(std::uint32_t v) {
    v &= 0x0000FFFFu;
    v = (v | (v << 8)) & 0x00FF00FFu;
    v = (v | (v << 4)) & 0x0F0F0F0Fu;
    v = (v | (v << 2)) & 0x33333333u;
    return (v | (v << 1)) & 0x55555555u;
}
}  // namespace

std::uint32_t MortonSpace::cellOf(std::uint32_t x, std::uint32_t y) {
    return spread(x) | (spread(y) << 1);
}
void MortonSpace::placeOf(std::uint32_t cell, std::uint32_t& x, std::uint32_t& y) {
    x = compact(cell);
    y = compact(cell >> 1);
}

MortonSpace::MortonSpace(std::uint32_t sideCells, std::uint32_t layers)
    : cellsPerLayer_(std::uint64_t{sideCells} * sideCells), cells_(cellsPerLayer_ * layers) {}

void MortonSpace::reserve(std::uint32_t firstCell, std::uint32_t sideCells) {
    taken_.emplace_back(firstCell, sideCells * sideCells);
}

void MortonSpace::buildFreeLists() {
    built_ = true;
    std::sort(taken_.begin(), taken_.end());
    taken_.emplace_back(static_cast<std::uint32_t>(cells_), 0u);
    std::uint64_t at = 0;
    for (const auto& [first, count] : taken_) {
        while (at < first) {
            // The largest aligned square that begins here and ends before the next taken one.
            std::uint64_t square = cellsPerLayer_;
            while (at % square != 0 || at + square > first) square /= 4;
            free_[static_cast<std::size_t>(std::countr_zero(square)) / 2].push_back(static_cast<std::uint32_t>(at));
            at += square;
        }
        at = std::uint64_t{first} + count;
    }
    for (auto& list : free_) std::reverse(list.begin(), list.end());
}

bool MortonSpace::take(std::uint32_t sideCells, std::uint32_t& firstCell) {
    if (!built_) buildFreeLists();
    const auto level = static_cast<std::size_t>(std::countr_zero(sideCells));
    for (std::size_t l = level; l < kLevels; ++l) {
        if (free_[l].empty()) continue;
        firstCell = free_[l].back();
        free_[l].pop_back();
        for (std::size_t split = l; split > level; --split) {
            const std::uint32_t quarter = 1u << (2 * (split - 1));
            for (std::uint32_t q = 3; q >= 1; --q) free_[split - 1].push_back(firstCell + q * quarter);
        }
        return true;
    }
    return false;
}

}  // namespace gnomon::renderer
