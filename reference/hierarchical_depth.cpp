// See hierarchical_depth.h.
#include "reference/hierarchical_depth.h"

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
