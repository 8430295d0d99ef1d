// Screen bounds of a light, row of tiles by row of tiles.
//
// Problem: find the 32x32-pixel tiles that a light's volume may touch: never one too few, and few too many.
// Source: exact bounds of a ball under perspective are known from Mara and McGuire, "2D Polyhedral Bounds of a Clipped,
// Perspective-Projected 3D Sphere" (2013). The derivation below is our own, and goes row by row.
// Plain way: project a bounding box. That is loose, and wrong where a corner is behind the eye.
//
// What we do: a ball cut off at the near plane is convex and in front of the eye, so its image is convex. Therefore the
// largest u within a row is at one of three places: at the row's upper boundary, at its lower boundary, or at the
// image's rightmost point if that lies in the row. The boundary v = const is a plane through the eye. It cuts the ball
// in a disc, and the extent of x/z on a disc has a closed form. In 2D the disc has centre (x, s) and radius p, with s
// measured along the boundary plane. With L = sqrt(x^2 + s^2 - p^2) the largest x/z is
//
//     tangent from the eye   (L x + p s) / (L s - p x)    if it touches at s >= near,
//     else the corner        (x + sqrt(p^2 - (near - s)^2)) / near    where the near plane cuts the disc,
//
// and mirrored for the smallest. L is the same for every boundary: it is the length of the eye's tangent to the ball.
// So a row costs one or two square roots, in a loop over boundaries without branches.
// Spots are cut further by straight lines (cone_outline.cpp). A light that covers all four corners of the screen covers
// all of it, by convexity, and writes no rows.
//
// Loops over rows and boundaries are written so that compilers vectorise them:
// - They have no branches, and write to arrays of one struct, which cannot alias each other. Ranges of rows are passed
//   by value, so that no store can change them.
// - Boundaries that miss the ball are corrected afterwards. By convexity they come first or last.
// - GCC and Clang vectorise square roots only under -fno-math-errno, which src/CMakeLists.txt sets.
// Where every light has a span in every row (Fringe, bench/prepare_benchmark.cpp), that takes a quarter off the whole
// phase (an AMD EPYC of family 25, GCC 12, SSE2).
//
// Parallel view: the image of a ball is a disc. It is smaller where near or far plane cut off the ball's larger half.
// Rounding: the loop is float. Next to the uppermost and lowest point of the image, p^2 is a small difference. So the
// ball's radius grows by 2e-6 of its distance, ten float roundings, and bounds move outward by a fiftieth of a pixel.
// Limits: the far plane of a perspective view is not used.

#include "prepare/screen_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gpu_interface/numbers.h"
#include "gpu_interface/packing.h"
#include "prepare/cone_outline.h"

namespace gnomon::prepare {
namespace {

constexpr double kSlackPx = 0.02;
constexpr double kFloatSlack = 4e-7;
constexpr double kBallSlack = 2e-6;
constexpr float kNowhere = 1e30f;  // beyond any u; not infinite, so that sums with it stay numbers
constexpr float kLeastSlope = 1e-6f;

// What the loops over row boundaries need of a ball.
struct BallRows {
    float x, y, z, radius2;
    float tangent;   // L; 0 where the eye is inside
    float tangent2;  // L^2; negative where the eye is inside
    float nearMetres;
    bool inFront;  // wholly in front of the near plane
};

// Boundaries first to last - 1 of a light.
struct BoundaryRange {
    std::uint32_t first, last;
};

// Wholly in front of the near plane: both tangents count everywhere. In two loops, so that compilers vectorise both.
void extentsInFront(const ScreenGrid& grid, const BallRows& ball, BoundaryRange range, RowExtents& rows) {
    const float x = ball.x, y = ball.y, z = ball.z, radius2 = ball.radius2, tangent = ball.tangent;
    for (std::uint32_t j = range.first; j < range.last; ++j) {
        const float v = grid.boundaryV[j], secant = grid.boundarySecant[j], cosine = grid.boundaryCosine[j];
        const float s = (v * y + z) * cosine;
        const float across = (y - v * z) * cosine;
        const float disc2 = radius2 - across * across;
        const float disc = std::sqrt(disc2 > 0.0f ? disc2 : 0.0f);
        const float a = tangent * x, b = disc * s, c = tangent * s, d = disc * x;
        rows.boundaryDisc2[j] = disc2;
        rows.boundaryLow[j] = secant * (a - b) / (c + d);
        rows.boundaryHigh[j] = secant * (a + b) / (c - d);
    }
}

// Cut by the near plane.
void extentsCut(const ScreenGrid& grid, const BallRows& ball, BoundaryRange range, RowExtents& rows) {
    const BallRows l = ball;  // a copy, which the outputs cannot alias
    const float perNear = 1.0f / l.nearMetres;
    for (std::uint32_t j = range.first; j < range.last; ++j) {
        const float v = grid.boundaryV[j], secant = grid.boundarySecant[j], cosine = grid.boundaryCosine[j];
        const float s = (v * l.y + l.z) * cosine;
        const float across = (l.y - v * l.z) * cosine;
        const float disc2 = l.radius2 - across * across;
        const float disc = std::sqrt(disc2 > 0.0f ? disc2 : 0.0f);
        const float nearS = l.nearMetres * secant;
        const float cut2 = disc2 - (nearS - s) * (nearS - s);
        const float cut = std::sqrt(cut2 > 0.0f ? cut2 : 0.0f);
        const float a = l.tangent * l.x, b = disc * s, c = l.tangent * s, d = disc * l.x;
        // The tangent point's s, times distance^2 / L, against near.
        const float least = nearS * (l.tangent2 + disc2);
        const bool tangentLow = l.tangent2 > 0.0f && (c + d) * l.tangent >= least;
        const bool tangentHigh = l.tangent2 > 0.0f && (c - d) * l.tangent >= least;
        const float smallest = tangentLow ? secant * (a - b) / (c + d) : (l.x - cut) * perNear;
        const float largest = tangentHigh ? secant * (a + b) / (c - d) : (l.x + cut) * perNear;
        const bool empty = disc2 < 0.0f || (s < nearS && cut2 < 0.0f);
        rows.boundaryDisc2[j] = empty ? -1.0f : disc2;
        rows.boundaryLow[j] = smallest;
        rows.boundaryHigh[j] = largest;
    }
}

void extentsParallel(const ScreenGrid& grid, const BallRows& ball, BoundaryRange range, RowExtents& rows) {
    for (std::uint32_t j = range.first; j < range.last; ++j) {
        const float v = grid.boundaryV[j];
        const float disc2 = ball.radius2 - (v - ball.y) * (v - ball.y);
        const float disc = std::sqrt(disc2 > 0.0f ? disc2 : 0.0f);
        rows.boundaryDisc2[j] = disc2;
        rows.boundaryLow[j] = ball.x - disc;
        rows.boundaryHigh[j] = ball.x + disc;
    }
}

// Extent of x/z over a disc in the (x, z) plane cut off at the near plane, and the depths at which it is reached.
struct DiscExtent {
    bool empty = true;
    double low = 0, high = 0, zLow = 1, zHigh = 1;
};

DiscExtent discExtent(double x, double z, double radius, double nearest) {
    DiscExtent out;
    if (z + radius < nearest) return out;
    out.empty = false;
    const double power = x * x + z * z - radius * radius;
    bool lowIsTangent = false, highIsTangent = false;
    if (power > 0) {
        const double tangent = std::sqrt(power), scale = tangent / (x * x + z * z);
        out.zLow = scale * (tangent * z + radius * x), out.zHigh = scale * (tangent * z - radius * x);
        lowIsTangent = out.zLow >= nearest, highIsTangent = out.zHigh >= nearest;
        if (lowIsTangent) out.low = scale * (tangent * x - radius * z) / out.zLow;
        if (highIsTangent) out.high = scale * (tangent * x + radius * z) / out.zHigh;
    }
    if (lowIsTangent && highIsTangent) return out;
    const double cut = std::sqrt(std::max(0.0, radius * radius - (nearest - z) * (nearest - z)));
    if (!lowIsTangent) out.low = (x - cut) / nearest, out.zLow = nearest;
    if (!highIsTangent) out.high = (x + cut) / nearest, out.zHigh = nearest;
    return out;
}

// The ball's image: its bounding rectangle, and at which v its leftmost and rightmost points are.
struct BallImage {
    bool empty = true;
    double uLow = 0, uHigh = 0, vLow = 0, vHigh = 0, vOfLow = 0, vOfHigh = 0;
};

BallImage imageOfBall(const ScreenGrid& grid, Vec3 centre, double radius, double parallelRadius) {
    BallImage image;
    if (grid.orthographic) {
        const double r = parallelRadius;
        return {r < 0, centre.x - r, centre.x + r, centre.y - r, centre.y + r, centre.y, centre.y};
    }
    const DiscExtent u = discExtent(centre.x, centre.z, radius, grid.nearMetres);
    const DiscExtent v = discExtent(centre.y, centre.z, radius, grid.nearMetres);
    if (u.empty || v.empty) return image;
    return {false, u.low, u.high, v.low, v.high, centre.y / u.zLow, centre.y / u.zHigh};
}

double radiusSeenParallel(const ScreenGrid& grid, double z, double radius) {
    const double beyond = std::max({0.0, grid.nearMetres - z, z - grid.farMetres});
    return beyond > radius ? -1.0 : std::sqrt(radius * radius - beyond * beyond);
}

// Row in which v lies; 0 above the screen, grid.rows below it. Clamped first: truncation is floor for what is not
// negative.
std::uint32_t rowOf(const ScreenGrid& grid, double v) {
    const double row = (v - grid.vMin) * grid.tilesPerV;
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::clamp(row, 0.0, static_cast<double>(grid.rows))));
}

// Widens the rows that hold a leftmost or rightmost point; two, where it is next to a boundary.
template <class Widen>
void atPeak(const ScreenGrid& grid, Coverage coverage, double v, Widen&& widen) {
    const std::uint32_t first = rowOf(grid, v - grid.uvSlack);
    const std::uint32_t last = rowOf(grid, v + grid.uvSlack);
    for (std::uint32_t row = std::max(first, coverage.firstRow); row <= last && row < coverage.lastRow; ++row)
        widen(row);
}

// Part of the rows' extents of v that the image reaches.
struct VRange {
    float low, high;
    [[nodiscard]] float from(float v) const { return v > low ? v : low; }
    [[nodiscard]] float to(float v) const { return v < high ? v : high; }
};

// Cuts the rows' extents by one line. Within a row a line bounds u most loosely at one of its ends.
void cutByLine(const ScreenGrid& grid, Coverage coverage, const HalfPlane& line, VRange range, RowExtents& rows) {
    if (std::abs(line.a) < kLeastSlope) return;
    const float perA = 1.0f / line.a, b = line.b, c = line.c;
    const auto uAt = [&](float v) { return (c - b * v) * perA; };
    if (line.a > 0.0f) {
        for (std::uint32_t row = coverage.firstRow; row < coverage.lastRow; ++row) {
            const float u0 = uAt(range.from(grid.boundaryV[row])), u1 = uAt(range.to(grid.boundaryV[row + 1]));
            const float bound = u0 > u1 ? u0 : u1;
            rows.high[row] = rows.high[row] < bound ? rows.high[row] : bound;
        }
    } else {
        for (std::uint32_t row = coverage.firstRow; row < coverage.lastRow; ++row) {
            const float u0 = uAt(range.from(grid.boundaryV[row])), u1 = uAt(range.to(grid.boundaryV[row + 1]));
            const float bound = u0 < u1 ? u0 : u1;
            rows.low[row] = rows.low[row] > bound ? rows.low[row] : bound;
        }
    }
}

// Likewise by two parallel lines.
void cutByStrip(const ScreenGrid& grid, Coverage coverage, const Strip& strip, VRange range, RowExtents& rows) {
    const float perA = 1.0f / strip.a, b = strip.b, stripLow = strip.low, stripHigh = strip.high;
    for (std::uint32_t row = coverage.firstRow; row < coverage.lastRow; ++row) {
        const float bv0 = b * range.from(grid.boundaryV[row]), bv1 = b * range.to(grid.boundaryV[row + 1]);
        const float low0 = (stripLow - bv0) * perA, low1 = (stripLow - bv1) * perA;
        const float high0 = (stripHigh - bv0) * perA, high1 = (stripHigh - bv1) * perA;
        const float low = low0 < low1 ? low0 : low1, high = high0 > high1 ? high0 : high1;
        rows.low[row] = rows.low[row] > low ? rows.low[row] : low;
        rows.high[row] = rows.high[row] < high ? rows.high[row] : high;
    }
}

bool cornersInside(const ScreenGrid& grid, const ConeOutline& outline) {
    if (outline.uLow > grid.uMin || outline.uHigh < grid.uMax) return false;
    for (int i = 0; i < outline.silhouetteCount; ++i) {
        const HalfPlane& line = outline.silhouettes[i];
        const double u = line.a > 0 ? grid.uMax : grid.uMin, v = line.b > 0 ? grid.vMax : grid.vMin;
        if (line.a * u + line.b * v > line.c) return false;
    }
    for (int i = 0; i < outline.stripCount; ++i) {
        const Strip& strip = outline.strips[i];
        const bool rises = strip.b > 0;
        if (strip.a * grid.uMax + strip.b * (rises ? grid.vMax : grid.vMin) > strip.high) return false;
        if (strip.a * grid.uMin + strip.b * (rises ? grid.vMin : grid.vMax) < strip.low) return false;
    }
    return true;
}

LightVolume flipped(const ScreenGrid& grid, LightVolume volume) {
    const auto flip = [&](Vec3 v) { return Vec3{v.x * grid.flipX, v.y * grid.flipY, v.z}; };
    volume.apexVs = flip(volume.apexVs);
    volume.axisVs = flip(volume.axisVs);
    return volume;
}

BallRows ballRows(const ScreenGrid& grid, Vec3 centre, double radius, double seenRadius) {
    const double power = dot(centre, centre) - radius * radius;
    const auto f = [](double d) { return static_cast<float>(d); };
    return {f(centre.x),
            f(centre.y),
            f(centre.z),
            f(seenRadius * seenRadius),
            f(std::sqrt(std::max(0.0, power))),
            f(power),
            f(grid.nearMetres),
            centre.z - radius >= grid.nearMetres};
}

// Extent of u on the boundaries; low above high where a boundary misses the ball.
void extentsOf(const ScreenGrid& grid, const BallRows& ball, BoundaryRange range, RowExtents& rows) {
    if (grid.orthographic) {
        extentsParallel(grid, ball, range, rows);
    } else if (ball.inFront) {
        extentsInFront(grid, ball, range, rows);
    } else {
        extentsCut(grid, ball, range, rows);
    }
    // The image is convex, so boundaries that miss it come first or last.
    const auto misses = [&](std::uint32_t j) {
        if (rows.boundaryDisc2[j] >= 0.0f) return false;
        rows.boundaryLow[j] = kNowhere;
        rows.boundaryHigh[j] = -kNowhere;
        return true;
    };
    std::uint32_t first = range.first, last = range.last;
    while (first < last && misses(first)) ++first;
    while (first < last && misses(last - 1)) --last;
}

// From boundaries to rows: the wider of a row's two boundaries, or the image's own end where it lies between.
void joinBoundaries(const ScreenGrid& grid, Coverage coverage, const BallImage& image, RowExtents& rows) {
    for (std::uint32_t row = coverage.firstRow; row < coverage.lastRow; ++row) {
        const float low0 = rows.boundaryLow[row], low1 = rows.boundaryLow[row + 1];
        const float high0 = rows.boundaryHigh[row], high1 = rows.boundaryHigh[row + 1];
        rows.low[row] = low0 < low1 ? low0 : low1;
        rows.high[row] = high0 > high1 ? high0 : high1;
    }
    const auto uLow = static_cast<float>(image.uLow), uHigh = static_cast<float>(image.uHigh);
    atPeak(grid, coverage, image.vOfLow, [&](std::uint32_t row) { rows.low[row] = std::min(rows.low[row], uLow); });
    atPeak(grid, coverage, image.vOfHigh, [&](std::uint32_t row) { rows.high[row] = std::max(rows.high[row], uHigh); });
}

float clampToFloat(double u) {
    return static_cast<float>(std::clamp<double>(u, -kNowhere, kNowhere));
}

// From u to columns, rounded outward and clamped to the screen. No extent reaches beyond uLow and uHigh.
void columnsOf(const ScreenGrid& grid, Coverage coverage, float uLow, float uHigh, RowExtents& rows) {
    const float tilesPerU = grid.tilesPerU, firstOffset = grid.firstColumnOffset, endOffset = grid.endColumnOffset;
    const auto columns = static_cast<float>(grid.columns);
    for (std::uint32_t row = coverage.firstRow; row < coverage.lastRow; ++row) {
        const float low = rows.low[row] > uLow ? rows.low[row] : uLow;
        const float high = rows.high[row] < uHigh ? rows.high[row] : uHigh;
        float first = low * tilesPerU + firstOffset, end = high * tilesPerU + endOffset;
        // Clamped first: truncation is floor for what is not negative.
        first = first > 0.0f ? first : 0.0f;
        end = end > 0.0f ? end : 0.0f;
        rows.firstColumn[row] = static_cast<std::int32_t>(first < columns ? first : columns);
        rows.endColumn[row] = static_cast<std::int32_t>(end < columns ? end : columns);
    }
}

}  // namespace

void ScreenGrid::set(const ViewCamera& camera, std::uint32_t widthPx, std::uint32_t heightPx) noexcept {
    columns = gpu::divideRoundingUp(widthPx, gpu::kMaskTileSizePx);
    rows = gpu::divideRoundingUp(heightPx, gpu::kMaskTileSizePx);
    orthographic = camera.orthographic;
    nearMetres = camera.nearMetres;
    farMetres = camera.farMetres;
    flipX = camera.xyScale[0] < 0 ? -1 : 1;
    flipY = camera.xyScale[1] < 0 ? -1 : 1;
    const double uPerPx = std::abs(camera.xyScale[0]), vPerPx = std::abs(camera.xyScale[1]);
    uMin = flipX * camera.xyOffset[0];
    uMax = uMin + uPerPx * widthPx;
    vMin = flipY * camera.xyOffset[1];
    vMax = vMin + vPerPx * heightPx;
    const double uPerTile = uPerPx * gpu::kMaskTileSizePx, vPerTile = vPerPx * gpu::kMaskTileSizePx;
    tilesPerV = 1 / vPerTile;
    const double largest = std::max({std::abs(uMin), std::abs(uMax), std::abs(vMin), std::abs(vMax)});
    uvSlack = kSlackPx * std::max(uPerPx, vPerPx) + kFloatSlack * largest;
    tilesPerU = static_cast<float>(1 / uPerTile);
    firstColumnOffset = static_cast<float>((-uMin - uvSlack) / uPerTile);
    endColumnOffset = static_cast<float>((-uMin + uvSlack) / uPerTile + 1);
    for (std::uint32_t row = 0; row <= rows; ++row) {
        const double v = vMin + vPerTile * row, secant = std::sqrt(1 + v * v);
        boundaryV[row] = static_cast<float>(v);
        boundarySecant[row] = static_cast<float>(secant);
        boundaryCosine[row] = static_cast<float>(1 / secant);
    }
}

Coverage ScreenBounds::cover(const ScreenGrid& grid, const LightVolume& hostVolume, const DepthRange& depth) noexcept {
    const LightVolume volume = flipped(grid, hostVolume);
    const Vec3 centre = volume.apexVs;
    const double radius = (volume.range + volume.slack) * (1 + kBallSlack) + kBallSlack * volume.distance;
    const double seenRadius = grid.orthographic ? radiusSeenParallel(grid, centre.z, radius) : radius;
    const BallImage image = imageOfBall(grid, centre, radius, seenRadius);
    Coverage coverage;
    if (image.empty) return coverage;

    ConeOutline outline;
    if (volume.spot) outline = outlineOfCone(grid, volume, depth);
    const double vLow = std::max(image.vLow, outline.vLow) - grid.uvSlack;
    const double vHigh = std::min(image.vHigh, outline.vHigh) + grid.uvSlack;
    if (vHigh < grid.vMin || vLow > grid.vMax) return coverage;
    coverage.firstRow = rowOf(grid, vLow);
    coverage.lastRow = std::min(rowOf(grid, vHigh) + 1, grid.rows);

    const BallRows ball = ballRows(grid, centre, radius, seenRadius);
    const auto boundaryIsFull = [&](std::uint32_t j) {
        extentsOf(grid, ball, {j, j + 1}, rows_);
        return rows_.boundaryLow[j] <= grid.uMin && rows_.boundaryHigh[j] >= grid.uMax;
    };
    const bool coversSides =
        coverage.firstRow == 0 && coverage.lastRow == grid.rows && image.uLow <= grid.uMin && image.uHigh >= grid.uMax;
    if (coversSides && boundaryIsFull(0) && boundaryIsFull(grid.rows) &&
        (!volume.spot || cornersInside(grid, outline))) {
        coverage.everywhere = true;
        return coverage;
    }
    extentsOf(grid, ball, {coverage.firstRow, coverage.lastRow + 1}, rows_);
    joinBoundaries(grid, coverage, image, rows_);
    const VRange range{clampToFloat(vLow), clampToFloat(vHigh)};
    for (int i = 0; i < outline.silhouetteCount; ++i) {
        cutByLine(grid, coverage, outline.silhouettes[i], range, rows_);
    }
    for (int i = 0; i < outline.stripCount; ++i) cutByStrip(grid, coverage, outline.strips[i], range, rows_);
    columnsOf(grid, coverage, clampToFloat(outline.uLow), clampToFloat(outline.uHigh), rows_);
    return coverage;
}

}  // namespace gnomon::prepare
