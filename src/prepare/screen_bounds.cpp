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
// Vectorised, the whole phase gains a mere 5 % (an AMD EPYC of family 26, GCC 12). GCC does it only under
// -fno-math-errno, so no flag is set.
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

// Wholly in front of the near plane: both tangents count everywhere.
void extentsInFront(const ScreenGrid& grid, const BallRows& ball, std::uint32_t first, std::uint32_t last, float* low,
                    float* high) {
    const float *vs = grid.boundaryV.data(), *secants = grid.boundarySecant.data(),
                *cosines = grid.boundaryCosine.data();
    const float x = ball.x, y = ball.y, z = ball.z, radius2 = ball.radius2, tangent = ball.tangent;
    for (std::uint32_t j = first; j < last; ++j) {
        const float s = (vs[j] * y + z) * cosines[j];
        const float across = (y - vs[j] * z) * cosines[j];
        const float disc2 = radius2 - across * across;
        const float disc = std::sqrt(disc2 > 0.0f ? disc2 : 0.0f);
        const float a = tangent * x, b = disc * s, c = tangent * s, d = disc * x;
        const float smallest = secants[j] * (a - b) / (c + d);
        const float largest = secants[j] * (a + b) / (c - d);
        low[j] = disc2 >= 0.0f ? smallest : kNowhere;
        high[j] = disc2 >= 0.0f ? largest : -kNowhere;
    }
}

// Cut by the near plane.
void extentsCut(const ScreenGrid& grid, const BallRows& ball, std::uint32_t first, std::uint32_t last, float* low,
                float* high) {
    const float *vs = grid.boundaryV.data(), *secants = grid.boundarySecant.data(),
                *cosines = grid.boundaryCosine.data();
    const BallRows l = ball;  // a copy, which the outputs cannot alias
    const float perNear = 1.0f / l.nearMetres;
    for (std::uint32_t j = first; j < last; ++j) {
        const float s = (vs[j] * l.y + l.z) * cosines[j];
        const float across = (l.y - vs[j] * l.z) * cosines[j];
        const float disc2 = l.radius2 - across * across;
        const float disc = std::sqrt(disc2 > 0.0f ? disc2 : 0.0f);
        const float nearS = l.nearMetres * secants[j];
        const float cut2 = disc2 - (nearS - s) * (nearS - s);
        const float cut = std::sqrt(cut2 > 0.0f ? cut2 : 0.0f);
        const float a = l.tangent * l.x, b = disc * s, c = l.tangent * s, d = disc * l.x;
        // The tangent point's s, times distance^2 / L, against near.
        const float least = nearS * (l.tangent2 + disc2);
        const bool tangentLow = l.tangent2 > 0.0f && (c + d) * l.tangent >= least;
        const bool tangentHigh = l.tangent2 > 0.0f && (c - d) * l.tangent >= least;
        const float smallest = tangentLow ? secants[j] * (a - b) / (c + d) : (l.x - cut) * perNear;
        const float largest = tangentHigh ? secants[j] * (a + b) / (c - d) : (l.x + cut) * perNear;
        const bool empty = disc2 < 0.0f || (s < nearS && cut2 < 0.0f);
        low[j] = empty ? kNowhere : smallest;
        high[j] = empty ? -kNowhere : largest;
    }
}

void extentsParallel(const ScreenGrid& grid, const BallRows& ball, std::uint32_t first, std::uint32_t last, float* low,
                     float* high) {
    const float* vs = grid.boundaryV.data();
    for (std::uint32_t j = first; j < last; ++j) {
        const float disc2 = ball.radius2 - (vs[j] - ball.y) * (vs[j] - ball.y);
        const float disc = std::sqrt(disc2 > 0.0f ? disc2 : 0.0f);
        low[j] = disc2 >= 0.0f ? ball.x - disc : kNowhere;
        high[j] = disc2 >= 0.0f ? ball.x + disc : -kNowhere;
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
    const double cut = std::sqrt(std::max(0.0, radius * radius - (nearest - z) * (nearest - z)));
    out.low = (x - cut) / nearest, out.high = (x + cut) / nearest;
    out.zLow = out.zHigh = nearest;
    if (power <= 0) return out;
    const double tangent = std::sqrt(power), scale = tangent / (x * x + z * z);
    const double zLow = scale * (tangent * z + radius * x), zHigh = scale * (tangent * z - radius * x);
    if (zLow >= nearest) {
        out.zLow = zLow;
        out.low = scale * (tangent * x - radius * z) / zLow;
    }
    if (zHigh >= nearest) {
        out.zHigh = zHigh;
        out.high = scale * (tangent * x + radius * z) / zHigh;
    }
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

// Row in which v lies, possibly outside the screen.
double rowOf(const ScreenGrid& grid, double v) {
    return std::floor((v - grid.vMin) / grid.vPerTile);
}
std::uint32_t clampRow(const ScreenGrid& grid, double row) {
    return static_cast<std::uint32_t>(std::clamp(row, 0.0, static_cast<double>(grid.rows)));
}

// Widens the rows that hold a leftmost or rightmost point; two, where it is next to a boundary.
template <class Widen>
void atPeak(const ScreenGrid& grid, const Coverage& coverage, double v, Widen&& widen) {
    const std::uint32_t first = clampRow(grid, rowOf(grid, v - grid.uvSlack));
    const std::uint32_t last = clampRow(grid, rowOf(grid, v + grid.uvSlack));
    for (std::uint32_t row = std::max(first, coverage.firstRow); row <= last && row < coverage.lastRow; ++row)
        widen(row);
}

// Cuts the rows' extents by one line. Within a row a line bounds u most loosely at one of its ends.
void cutRows(const ScreenGrid& grid, const Coverage& coverage, const HalfPlane& line, float vLow, float vHigh,
             float* low, float* high) {
    if (std::abs(line.a) < kLeastSlope) return;
    const float perA = 1.0f / line.a;
    const float* vs = grid.boundaryV.data();
    for (std::uint32_t row = coverage.firstRow; row < coverage.lastRow; ++row) {
        const float v0 = vs[row] > vLow ? vs[row] : vLow;
        const float v1 = vs[row + 1] < vHigh ? vs[row + 1] : vHigh;
        const float u0 = (line.c - line.b * v0) * perA, u1 = (line.c - line.b * v1) * perA;
        if (line.a > 0.0f) {
            const float bound = u0 > u1 ? u0 : u1;
            high[row] = high[row] < bound ? high[row] : bound;
        } else {
            const float bound = u0 < u1 ? u0 : u1;
            low[row] = low[row] > bound ? low[row] : bound;
        }
    }
}

bool cornersInside(const ScreenGrid& grid, const ConeOutline& outline) {
    if (outline.uLow > grid.uMin || outline.uHigh < grid.uMax) return false;
    for (int i = 0; i < outline.count; ++i) {
        const HalfPlane& line = outline.halfPlanes[i];
        const double u = line.a > 0 ? grid.uMax : grid.uMin, v = line.b > 0 ? grid.vMax : grid.vMin;
        if (line.a * u + line.b * v > line.c) return false;
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

// Extent of u on the boundaries first to last - 1; low above high where a boundary misses the ball.
void extentsOf(const ScreenGrid& grid, const BallRows& ball, std::uint32_t first, std::uint32_t last, float* low,
               float* high) {
    if (grid.orthographic) {
        extentsParallel(grid, ball, first, last, low, high);
    } else if (ball.inFront) {
        extentsInFront(grid, ball, first, last, low, high);
    } else {
        extentsCut(grid, ball, first, last, low, high);
    }
}

// From boundaries to rows: the wider of a row's two boundaries, or the image's own end where it lies between.
void joinBoundaries(const ScreenGrid& grid, const Coverage& coverage, const BallImage& image, const float* low,
                    const float* high, float* rowLow, float* rowHigh) {
    for (std::uint32_t row = coverage.firstRow; row < coverage.lastRow; ++row) {
        rowLow[row] = low[row] < low[row + 1] ? low[row] : low[row + 1];
        rowHigh[row] = high[row] > high[row + 1] ? high[row] : high[row + 1];
    }
    const auto uLow = static_cast<float>(image.uLow), uHigh = static_cast<float>(image.uHigh);
    atPeak(grid, coverage, image.vOfLow, [&](std::uint32_t row) { rowLow[row] = std::min(rowLow[row], uLow); });
    atPeak(grid, coverage, image.vOfHigh, [&](std::uint32_t row) { rowHigh[row] = std::max(rowHigh[row], uHigh); });
}

void cutByOutline(const ScreenGrid& grid, const Coverage& coverage, const ConeOutline& outline, double vLow,
                  double vHigh, float* rowLow, float* rowHigh) {
    const auto clampToFloat = [](double u) { return static_cast<float>(std::clamp<double>(u, -kNowhere, kNowhere)); };
    const float uLow = clampToFloat(outline.uLow), uHigh = clampToFloat(outline.uHigh);
    for (std::uint32_t row = coverage.firstRow; row < coverage.lastRow; ++row) {
        rowLow[row] = rowLow[row] > uLow ? rowLow[row] : uLow;
        rowHigh[row] = rowHigh[row] < uHigh ? rowHigh[row] : uHigh;
    }
    for (int i = 0; i < outline.count; ++i) {
        cutRows(grid, coverage, outline.halfPlanes[i], clampToFloat(vLow), clampToFloat(vHigh), rowLow, rowHigh);
    }
}

// From u to columns, rounded outward and clamped to the screen.
void spansOf(const ScreenGrid& grid, const Coverage& coverage, const float* rowLow, const float* rowHigh,
             TileSpan* spans) {
    const auto tilesPerU = static_cast<float>(1 / grid.uPerTile);
    const auto lowOffset = static_cast<float>((-grid.uMin - grid.uvSlack) / grid.uPerTile);
    const auto highOffset = static_cast<float>((-grid.uMin + grid.uvSlack) / grid.uPerTile + 1);
    const auto columns = static_cast<float>(grid.columns);
    for (std::uint32_t row = coverage.firstRow; row < coverage.lastRow; ++row) {
        const float first = rowLow[row] * tilesPerU + lowOffset, last = rowHigh[row] * tilesPerU + highOffset;
        // Clamped first: truncation is floor for what is not negative.
        spans[row].first = static_cast<std::uint16_t>(static_cast<int>(std::min(std::max(first, 0.0f), columns)));
        spans[row].last = static_cast<std::uint16_t>(static_cast<int>(std::min(std::max(last, 0.0f), columns)));
    }
}

}  // namespace

void ScreenGrid::create(std::uint32_t maxRows) {
    boundaryV.resize(maxRows + 1);
    boundarySecant.resize(maxRows + 1);
    boundaryCosine.resize(maxRows + 1);
}

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
    uPerTile = uPerPx * gpu::kMaskTileSizePx;
    vPerTile = vPerPx * gpu::kMaskTileSizePx;
    const double largest = std::max({std::abs(uMin), std::abs(uMax), std::abs(vMin), std::abs(vMax)});
    uvSlack = kSlackPx * std::max(uPerPx, vPerPx) + kFloatSlack * largest;
    for (std::uint32_t row = 0; row <= rows; ++row) {
        const double v = vMin + vPerTile * row, secant = std::sqrt(1 + v * v);
        boundaryV[row] = static_cast<float>(v);
        boundarySecant[row] = static_cast<float>(secant);
        boundaryCosine[row] = static_cast<float>(1 / secant);
    }
}

void ScreenBounds::create(std::uint32_t maxRows) {
    boundaryLow_.resize(maxRows + 1);
    boundaryHigh_.resize(maxRows + 1);
    rowLow_.resize(maxRows);
    rowHigh_.resize(maxRows);
    spans_.resize(maxRows);
}

Coverage ScreenBounds::cover(const ScreenGrid& grid, const LightVolume& hostVolume) noexcept {
    const LightVolume volume = flipped(grid, hostVolume);
    const Vec3 centre = volume.apexVs;
    const double radius = (volume.range + volume.slack) * (1 + kBallSlack) + kBallSlack * length(centre);
    const double seenRadius = grid.orthographic ? radiusSeenParallel(grid, centre.z, radius) : radius;
    const BallImage image = imageOfBall(grid, centre, radius, seenRadius);
    Coverage coverage;
    if (image.empty) return coverage;

    ConeOutline outline;
    if (volume.spot) outline = outlineOfCone(grid, volume);
    const double vLow = (volume.spot ? std::max(image.vLow, outline.vLow) : image.vLow) - grid.uvSlack;
    const double vHigh = (volume.spot ? std::min(image.vHigh, outline.vHigh) : image.vHigh) + grid.uvSlack;
    if (vHigh < grid.vMin || vLow > grid.vMax) return coverage;
    coverage.firstRow = clampRow(grid, rowOf(grid, vLow));
    coverage.lastRow = clampRow(grid, rowOf(grid, vHigh) + 1);

    const BallRows ball = ballRows(grid, centre, radius, seenRadius);
    float *low = boundaryLow_.data(), *high = boundaryHigh_.data();
    const auto boundaryIsFull = [&](std::uint32_t j) {
        extentsOf(grid, ball, j, j + 1, low, high);
        return low[j] <= grid.uMin && high[j] >= grid.uMax;
    };
    const bool coversSides =
        coverage.firstRow == 0 && coverage.lastRow == grid.rows && image.uLow <= grid.uMin && image.uHigh >= grid.uMax;
    if (coversSides && boundaryIsFull(0) && boundaryIsFull(grid.rows) &&
        (!volume.spot || cornersInside(grid, outline))) {
        coverage.everywhere = true;
        return coverage;
    }
    extentsOf(grid, ball, coverage.firstRow, coverage.lastRow + 1, low, high);
    joinBoundaries(grid, coverage, image, low, high, rowLow_.data(), rowHigh_.data());
    if (volume.spot) cutByOutline(grid, coverage, outline, vLow, vHigh, rowLow_.data(), rowHigh_.data());
    spansOf(grid, coverage, rowLow_.data(), rowHigh_.data(), spans_.data());
    return coverage;
}

}  // namespace gnomon::prepare
