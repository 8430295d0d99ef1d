// Screen bounds of a spot's volume, the spherical sector with apex p, axis d, half-angle a and radius r.
//
// Problem: the ball around a spot is a poor bound. A narrow cone fills a few per cent of it.
// Plain way: clip or rasterise a mesh of the cone. Costly, and never exact.
// What we do: the part of the sector in front of the near plane is convex, so its image is convex too. Any line that
// touches the image bounds it. We take up to ten such lines, and screen_bounds.cpp intersects them with the ball's
// rows:
//
// 1. The two silhouettes of the infinite cone. They are planes through eye and apex that touch the cone. With a unit
//    normal n they are n.p = 0 and n.d = -sin a (the angle between n and d is 90 degrees + a). They exist iff the eye
//    is outside the double cone. They hold whatever the near plane cuts off. For a parallel view n.z = 0 replaces n.p =
//    0.
// 2. Tangents in four directions and their opposites: (1,0), (0,1), (1,1), (1,-1). The view is turned about its axis so
//    that the direction is u. Then the largest x/z is wanted. While the sector lies in front of the near plane, it is
//    at one of three places: at the apex; where the ball's tangent plane through the eye touches the cap; where one
//    touches the rim. The rim's tangents n = (1,0,-t) through the eye solve (n.c)^2 = R^2 (|n|^2 - (n.d)^2), a
//    quadratic in t.
// 3. Where the near plane cuts the sector there is no short formula. But every plane that holds the sector on one side
//    gives a bound: from x + m z <= h(1,0,m) for all points follows x/z <= max(h/near, h/far) - m. The least over m is
//    the exact bound (it is the dual problem). The function is quasi-convex in the plane's angle, so a golden-section
//    search finds its least. Stopping early costs tightness, never correctness. This is done for u and v only.
//
// A parallel view needs the support function alone. Where the eye is inside the volume nothing is bounded.
// Limits: ten lines and the ball leave corners beside a round cap. That makes 3 to 5 % more tiles than are reached
// (measured in conservative_test.cpp at 1920x1080).

#include "prepare/cone_outline.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gnomon::prepare {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLargestAngle = 1.55;  // radians between a searched plane and the view axis
constexpr int kSearchSteps = 14;        // the angle is then known to 4e-3
constexpr double kLeastAcross = 1e-9;

struct Interval {
    double low = -kInfinity, high = kInfinity;
};

// Bounds of (a x + b y) / z over a sector wholly in front of the near plane; (a, b) has unit length.
Interval tangentsInFront(const LightVolume& s, double a, double b) {
    const double px = a * s.apexVs.x + b * s.apexVs.y, pz = s.apexVs.z;
    const double dx = a * s.axisVs.x + b * s.axisVs.y, dz = s.axisVs.z;
    Interval out{px / pz, px / pz};

    // The rim.
    const double cx = px + dx * s.range * s.cosOuter, cz = pz + dz * s.range * s.cosOuter;
    const double radius2 = s.range * s.range * s.sinOuter * s.sinOuter;
    const double qa = cz * cz - radius2 * (1 - dz * dz);
    const double qb = cx * cz + radius2 * dx * dz;
    const double qc = cx * cx - radius2 * (1 - dx * dx);
    if (!(qa > 0)) return {};
    const double root = std::sqrt(std::max(0.0, qb * qb - qa * qc));
    out.low = std::min(out.low, (qb - root) / qa);
    out.high = std::max(out.high, (qb + root) / qa);

    // The ball, where its tangent point lies within the cone.
    const double power = px * px + pz * pz - s.range * s.range;
    if (power > 0) {
        const double tangent = std::sqrt(power);
        const double scale = s.range / (px * px + pz * pz);
        for (const double side : {-1.0, 1.0}) {
            // From the apex to the tangent point: -(range / distance)^2 * p plus a step across.
            const double tx = scale * (side * tangent * pz - s.range * px);
            const double tz = scale * (-side * tangent * px - s.range * pz);
            if (tx * dx + tz * dz < s.range * s.cosOuter || pz + tz <= 0) continue;
            const double ratio = (px + tx) / (pz + tz);
            out.low = std::min(out.low, ratio);
            out.high = std::max(out.high, ratio);
        }
    }
    return out;
}

// Upper bound of (a x + b y) / z over the part of the sector between near and `farthest`.
double searchBound(const LightVolume& s, double a, double b, double nearest, double farthest) {
    const auto boundAt = [&](double angle) {
        const double cosine = std::cos(angle), m = std::sin(angle);
        const double h = support(s, {a * cosine, b * cosine, m});
        return ((h > 0 ? h / nearest : h / farthest) - m) / cosine;
    };
    constexpr double kGolden = 0.6180339887498949;
    double low = -kLargestAngle, high = kLargestAngle;
    double x1 = high - kGolden * (high - low), x2 = low + kGolden * (high - low);
    double f1 = boundAt(x1), f2 = boundAt(x2);
    double best = std::min(f1, f2);
    for (int step = 0; step < kSearchSteps; ++step) {
        if (f1 < f2) {
            high = x2, x2 = x1, f2 = f1;
            x1 = high - kGolden * (high - low);
            f1 = boundAt(x1);
        } else {
            low = x1, x1 = x2, f1 = f2;
            x2 = low + kGolden * (high - low);
            f2 = boundAt(x2);
        }
        best = std::min({best, f1, f2});
    }
    return best;
}

// The two silhouettes. `slack` is by how much a unit normal's plane is moved outward on the image plane.
void addSilhouettes(const ScreenGrid& grid, const LightVolume& s, double slack, ConeOutline& out) {
    const Vec3 through = grid.orthographic ? Vec3{0, 0, 1} : s.apexVs;  // every plane wanted holds this direction
    const double distance = grid.orthographic ? 1 : s.distance;
    if (!(distance > 1e-6 * s.range)) return;
    const Vec3 sight = through * (1.0 / distance);
    const Vec3 side = s.axisVs - sight * dot(s.axisVs, sight);
    const double across = length(side);
    if (!(across > s.sinOuter) || across < kLeastAcross) return;  // the eye is inside the double cone
    const Vec3 e1 = side * (1.0 / across), e2 = cross(sight, e1);
    const double cosine = -s.sinOuter / across, sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    for (const double sign : {-1.0, 1.0}) {
        const Vec3 n = e1 * cosine + e2 * (sign * sine);
        const double c = grid.orthographic ? dot(n, s.apexVs) : -n.z;
        out.silhouettes[out.silhouetteCount++] = {static_cast<float>(n.x), static_cast<float>(n.y),
                                                  static_cast<float>(c + slack)};
    }
}

Interval boundsAlong(const ScreenGrid& grid, const LightVolume& s, const DepthRange& depth, double a, double b) {
    if (grid.orthographic) return {-support(s, {-a, -b, 0}), support(s, {a, b, 0})};
    if (depth.nearest >= grid.nearMetres) return tangentsInFront(s, a, b);
    if (a != 0 && b != 0) return {};
    const double farthest = std::min(depth.farthest, grid.farMetres);
    if (!(farthest > grid.nearMetres)) return {};
    return {-searchBound(s, -a, -b, grid.nearMetres, farthest), searchBound(s, a, b, grid.nearMetres, farthest)};
}

bool holdsEye(const LightVolume& s) {
    return s.distance <= s.range + s.slack && -dot(s.apexVs, s.axisVs) >= s.cosOuter * s.distance - s.slack;
}

}  // namespace

ConeOutline outlineOfCone(const ScreenGrid& grid, const LightVolume& volume, const DepthRange& depth) noexcept {
    ConeOutline out;
    if (!grid.orthographic && holdsEye(volume)) return out;

    const double nearest = std::max(depth.nearest, grid.nearMetres);
    // What a step of `slack` metres is on the image plane, where |(u, v, 1)| is below `reach`.
    const double reach =
        1 + std::max(std::abs(grid.uMin), std::abs(grid.uMax)) + std::max(std::abs(grid.vMin), std::abs(grid.vMax));
    const double slack = grid.uvSlack + (grid.orthographic ? volume.slack : 2 * volume.slack * reach / nearest);
    addSilhouettes(grid, volume, slack, out);

    const Interval u = boundsAlong(grid, volume, depth, 1, 0), v = boundsAlong(grid, volume, depth, 0, 1);
    out.uLow = u.low - slack, out.uHigh = u.high + slack;
    out.vLow = v.low - slack, out.vHigh = v.high + slack;
    constexpr double kDiagonal = 0.7071067811865476;
    for (const double b : {-kDiagonal, kDiagonal}) {
        const Interval along = boundsAlong(grid, volume, depth, kDiagonal, b);
        if (!std::isfinite(along.low) || !std::isfinite(along.high)) continue;
        out.strips[out.stripCount++] = {static_cast<float>(kDiagonal), static_cast<float>(b),
                                        static_cast<float>(along.low - slack), static_cast<float>(along.high + slack)};
    }
    return out;
}

}  // namespace gnomon::prepare
