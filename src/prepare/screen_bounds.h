#pragma once
// Which columns of tiles a light's volume covers in every row of tiles.

#include <cstdint>
#include <vector>

#include "prepare/camera.h"
#include "prepare/light_volume.h"

namespace gnomon::prepare {

/// The screen as rows and columns of tiles, in image-plane coordinates (u, v) that grow with pixel x and y. They are
/// view xy at depth 1 (perspective) or view xy (orthographic), each negated where the projection mirrors.
struct ScreenGrid {
    void create(std::uint32_t maxRows);  ///< may throw std::bad_alloc
    void set(const ViewCamera& camera, std::uint32_t widthPx, std::uint32_t heightPx) noexcept;

    std::uint32_t columns = 0, rows = 0;
    bool orthographic = false;
    double nearMetres = 0, farMetres = 0;
    double flipX = 1, flipY = 1;
    double uMin = 0, uMax = 0, vMin = 0, vMax = 0;  // edges of the active extent
    double uPerTile = 1, vPerTile = 1;
    double uvSlack = 0;  // by how much bounds are widened: a fiftieth of a pixel and float rounding
    // Of every row boundary: v, sqrt(1 + v^2) and its inverse.
    std::vector<float> boundaryV, boundarySecant, boundaryCosine;
};

/// Columns first to last - 1 of one row; empty where first >= last.
struct TileSpan {
    std::uint16_t first = 0, last = 0;
};

/// What cover() found: rows firstRow to lastRow - 1 have a span each.
struct Coverage {
    std::uint32_t firstRow = 0, lastRow = 0;
    bool everywhere = false;  // all tiles; no spans are written
};

/// Scratch for one light's rows, reused for all.
class ScreenBounds {
public:
    void create(std::uint32_t maxRows);  ///< may throw std::bad_alloc
    /// spans() holds Coverage's rows until the next call.
    Coverage cover(const ScreenGrid& grid, const LightVolume& volume) noexcept;
    [[nodiscard]] const TileSpan* spans() const noexcept { return spans_.data(); }  // by row

private:
    std::vector<float> boundaryLow_, boundaryHigh_;  // u extent on each row boundary
    std::vector<float> rowLow_, rowHigh_;            // u extent in each row
    std::vector<TileSpan> spans_;
};

}  // namespace gnomon::prepare
