#pragma once
// Hierarchical depth: nearest and farthest view depth of every shadow tile, over its pixels that are not background.
//
// Source: the specification, Hierarchical depth; the paper, section 2.2, footnote 1.
//
// What: a loop over the tile's pixels. Slices of the range that hold a pixel: Harada 2012, "A 2.5D Culling for
// Forward+". A tile of background alone has minimum +infinity above maximum -infinity.
//
// Limits: checks the library's own pyramid (view depths), not one that a host gave (device depths, background
// included).

#include <cstdint>
#include <span>

#include "reference/findings.h"
#include "reference/receivers.h"

namespace gnomon::reference {

struct TileDepths {
    double minMetres = kInfinity, maxMetres = -kInfinity;
    double toleranceMetres = 0;  ///< the largest reconstruction error of the tile's pixels
    [[nodiscard]] bool empty() const { return minMetres > maxMetres; }
};

/// One per shadow tile, in rows.
std::vector<TileDepths> tileDepths(const PixelGrid& grid);

/// Which of kDepthSlices equal parts of the tile's range hold a pixel, one bit each. Rounding may turn that.
struct TileSlices {
    std::uint32_t must = 0, may = 0;
};
/// `nearMetres` and `farMetres`: the range that the library found.
TileSlices tileSlices(const PixelGrid& grid, std::uint32_t tileX, std::uint32_t tileY, double nearMetres,
                      double farMetres);
Findings checkTileSlices(const PixelGrid& grid, std::span<const float> minMax, std::span<const std::uint32_t> slices);

/// `minMax`: two floats per shadow tile, in rows. An empty tile may hold any minimum above its maximum.
Findings checkTileDepths(const PixelGrid& grid, std::span<const float> minMax);

}  // namespace gnomon::reference
