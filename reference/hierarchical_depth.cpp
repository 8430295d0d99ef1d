// See hierarchical_depth.h.
#include "reference/hierarchical_depth.h"

#include <algorithm>
#include <cmath>

#include "gpu_interface/numbers.h"

namespace gnomon::reference {

std::vector<TileDepths> tileDepths(const PixelGrid& grid) {
    std::vector<TileDepths> result;
    for (std::uint32_t tileY = 0; tileY < grid.tilesY; ++tileY) {
        for (std::uint32_t tileX = 0; tileX < grid.tilesX; ++tileX) {
            TileDepths tile;
            for (const auto [x, y] : grid.tilePixels(tileX, tileY)) {
                const Pixel& pixel = grid.at(x, y);
                if (pixel.background) continue;
                tile.minMetres = std::min(tile.minMetres, pixel.viewDepth);
                tile.maxMetres = std::max(tile.maxMetres, pixel.viewDepth);
                tile.toleranceMetres = std::max(tile.toleranceMetres, pixel.viewDepthError);
            }
            result.push_back(tile);
        }
    }
    return result;
}

TileSlices tileSlices(const PixelGrid& grid, std::uint32_t tileX, std::uint32_t tileY, double nearMetres,
                      double farMetres) {
    TileSlices result;
    const auto sliceOf = [&](double depth) {
        const double share = farMetres > nearMetres ? (depth - nearMetres) / (farMetres - nearMetres) : 0.0;
        return std::clamp(static_cast<int>(std::floor(share * gpu::kDepthSlices)), 0, int(gpu::kDepthSlices) - 1);
    };
    for (const auto [x, y] : grid.tilePixels(tileX, tileY)) {
        const Pixel& pixel = grid.at(x, y);
        if (pixel.background) continue;
        // The share itself is rounded, too.
        const double error = pixel.viewDepthError + 4 * kFloatRoundoff * (farMetres - nearMetres);
        const int first = sliceOf(pixel.viewDepth - error), last = sliceOf(pixel.viewDepth + error);
        if (first == last) result.must |= 1u << first;
        for (int i = first; i <= last; ++i) result.may |= 1u << i;
    }
    return result;
}

Findings checkTileSlices(const PixelGrid& grid, std::span<const float> minMax, std::span<const std::uint32_t> slices) {
    Findings findings;
    const std::size_t tiles = std::size_t(grid.tilesX) * grid.tilesY;
    if (minMax.size() < 2 * tiles || slices.size() < tiles) {
        findings.add("%zu slices are too few for %zu tiles", slices.size(), tiles);
        return findings;
    }
    for (std::size_t i = 0; i < tiles; ++i) {
        if (minMax[2 * i] > minMax[2 * i + 1]) {  // no geometry
            if (slices[i] != 0) findings.add("tile %zu is empty but has slices %08x", i, slices[i]);
            continue;
        }
        const TileSlices expected =
            tileSlices(grid, static_cast<std::uint32_t>(i % grid.tilesX), static_cast<std::uint32_t>(i / grid.tilesX),
                       minMax[2 * i], minMax[2 * i + 1]);
        if ((expected.must & ~slices[i]) != 0 || (slices[i] & ~expected.may) != 0)
            findings.add("tile %zu has slices %08x; it must have %08x and may have %08x", i, slices[i], expected.must,
                         expected.may);
    }
    return findings;
}

Findings checkTileDepths(const PixelGrid& grid, std::span<const float> minMax) {
    Findings findings;
    const std::vector<TileDepths> expected = tileDepths(grid);
    if (minMax.size() < 2 * expected.size()) {
        findings.add("%zu floats are too few for %zu tiles", minMax.size(), expected.size());
        return findings;
    }
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const TileDepths& tile = expected[i];
        const double minimum = minMax[2 * i], maximum = minMax[2 * i + 1];
        if (tile.empty()) {
            if (!(minimum > maximum)) findings.add("tile %zu is empty but has depths [%g, %g]", i, minimum, maximum);
        } else if (!(std::abs(minimum - tile.minMetres) <= tile.toleranceMetres) ||
                   !(std::abs(maximum - tile.maxMetres) <= tile.toleranceMetres)) {
            findings.add("tile %zu has depths [%.9g, %.9g] instead of [%.9g, %.9g] within %g", i, minimum, maximum,
                         tile.minMetres, tile.maxMetres, tile.toleranceMetres);
        }
    }
    return findings;
}

}  // namespace gnomon::reference
