#pragma once
// Free space of an atlas as power-of-two squares along a Morton curve. A square of 2^k cells a side, aligned to its own
// size, is one aligned run of 4^k cells on the curve. So packing squares is packing aligned intervals, which loses
// nothing.

#include <array>
#include <cstdint>
#include <vector>

namespace gnomon::renderer {

/// Cells count along the curve of each layer, layer after layer.
class MortonSpace {
public:
    /// `sideCells` a power of two up to 1024.
    MortonSpace(std::uint32_t sideCells, std::uint32_t layers);

    /// Marks a square as taken. Must be aligned, inside and free; all reservations come before the first take().
    void reserve(std::uint32_t firstCell, std::uint32_t sideCells);
    /// Takes the first free square of that side from the smallest free square that holds it. False if there is none.
    bool take(std::uint32_t sideCells, std::uint32_t& firstCell);

    static std::uint32_t cellOf(std::uint32_t x, std::uint32_t y);  ///< within a layer
    static void placeOf(std::uint32_t cell, std::uint32_t& x, std::uint32_t& y);

private:
    void buildFreeLists();
    static constexpr std::uint32_t kLevels = 11;
    std::uint64_t cellsPerLayer_, cells_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> taken_;  // first cell, cells
    std::array<std::vector<std::uint32_t>, kLevels> free_;        // by log2 of the side, descending first cells
    bool built_ = false;
};

}  // namespace gnomon::renderer
