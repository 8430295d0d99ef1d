#pragma once
// Which columns of tiles a light's volume covers in every row of tiles.

#include <array>
#include <cstdint>

#include "gpu_interface/numbers.h"
#include "prepare/camera.h"
#include "prepare/light_volume.h"

namespace gnomon::prepare {

/// Rows of tiles of the highest screen.
inline constexpr std::uint32_t kMaxTileRows = gpu::kMaxExtentPx / gpu::kMaskTileSizePx;

/// The screen as rows and columns of tiles, in image-plane coordinates (u, v) that grow with pixel x and y. They are
/// view xy at depth 1 (perspective) or view xy (orthographic), each negated where the projection mirrors.
struct ScreenGrid {
    void set(const ViewCamera& camera, std::uint32_t widthPx, std::uint32_t heightPx) noexcept;

    std::uint32_t columns = 0, rows = 0;
    bool orthographic = false;
    double nearMetres = 0, farMetres = 0;
    double flipX = 1, flipY = 1;
    double uMin = 0, uMax = 0, vMin = 0, vMax = 0;  // edges of the active extent
    double tilesPerV = 1;
    double uvSlack = 0;  // by how much bounds are widened: a fiftieth of a pixel and float rounding
    // The column of u = low, and the one after that of u = high: low * tilesPerU + firstColumnOffset, and
    // high * tilesPerU + endColumnOffset. The slack is in them.
    float tilesPerU = 1, firstColumnOffset = 0, endColumnOffset = 0;
    // Of every row boundary: v, sqrt(1 + v^2) and its inverse.
    std::array<float, kMaxTileRows + 1> boundaryV, boundarySecant, boundaryCosine;
};

/// What cover() found: rows firstRow to lastRow - 1 have a span of columns each.
struct Coverage {
    std::uint32_t firstRow = 0, lastRow = 0;
    bool everywhere = false;  // all tiles; no spans are written
};

/// One light's extents, row by row.
struct RowExtents {
    // On each row boundary: the extent of u, and the squared radius of the disc that the boundary cuts from the ball.
    std::array<float, kMaxTileRows + 1> boundaryLow, boundaryHigh, boundaryDisc2;
    // In each row: the extent of u, the first column and the column after the last.
    std::array<float, kMaxTileRows> low, high;
    std::array<std::int32_t, kMaxTileRows> firstColumn, endColumn;
};

/// Finds one light's extents after the other's.
class ScreenBounds {
public:
    /// `depth` is the volume's. firstColumns() and endColumns() hold Coverage's rows until the next call.
    Coverage cover(const ScreenGrid& grid, const LightVolume& volume, const DepthRange& depth) noexcept;
    /// By row: its span's first column, and the column after its last. It is empty where they meet or cross.
    [[nodiscard]] const std::int32_t* firstColumns() const noexcept { return rows_.firstColumn.data(); }
    [[nodiscard]] const std::int32_t* endColumns() const noexcept { return rows_.endColumn.data(); }

private:
    RowExtents rows_;
};

}  // namespace gnomon::prepare
