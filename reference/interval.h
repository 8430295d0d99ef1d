#pragma once
// Intervals: everything that a 32-bit float may come out as, carried through the arithmetic that made it.
//
// Problem: phase 4 chains dozens of float operations between a pixel and a comparison, and the oracle must know how far
// the last one may be off.
//
// What: each operation widens its exact result by the rounding of a float (twice over, so that sums may be taken in
// another order; division and square root may be a few units off, as Vulkan allows). Constants are exact.
//
// Limits: operands count as independent, so x - x is not 0. Results stay far from a float's ends.

#include <algorithm>
#include <cmath>

#include "reference/findings.h"
#include "reference/vector_math.h"

namespace gnomon::reference {

struct Interval {
    double lo = 0, hi = 0;
    Interval() = default;
    Interval(double value)
        : lo(value), hi(value) {}  // NOLINT(google-explicit-constructor): numbers are exact intervals
    Interval(double from, double to) : lo(from), hi(to) {}

    [[nodiscard]] double width() const { return hi - lo; }
    [[nodiscard]] double middle() const { return 0.5 * (lo + hi); }
    [[nodiscard]] double magnitude() const { return std::max(std::abs(lo), std::abs(hi)); }
    [[nodiscard]] bool finite() const { return std::isfinite(lo) && std::isfinite(hi); }
};

/// [value - error, value + error].
inline Interval within(double value, double error) {
    return {value - error, value + error};
}
/// Either one.
inline Interval hull(Interval a, Interval b) {
    return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}
/// Widened by the rounding of a result: `roundings` times half a unit in the last place.
inline Interval rounded(Interval a, double roundings = 2) {
    const double share = roundings * kFloatRoundoff;
    return {a.lo - share * std::abs(a.lo), a.hi + share * std::abs(a.hi)};
}

inline Interval operator-(Interval a) {
    return {-a.hi, -a.lo};
}
inline Interval operator+(Interval a, Interval b) {
    return rounded({a.lo + b.lo, a.hi + b.hi});
}
inline Interval operator-(Interval a, Interval b) {
    return rounded({a.lo - b.hi, a.hi - b.lo});
}
inline Interval operator*(Interval a, Interval b) {
    const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
    return rounded({std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s))});
}
/// Everything, where the divisor may be 0.
inline Interval operator/(Interval a, Interval b) {
    if (b.lo <= 0 && b.hi >= 0) return {-kInfinity, kInfinity};
    const double p = a.lo / b.lo, q = a.lo / b.hi, r = a.hi / b.lo, s = a.hi / b.hi;
    return rounded({std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s))}, 6);
}
inline Interval abs(Interval a) {
    if (a.lo >= 0) return a;
    if (a.hi <= 0) return -a;
    return {0, a.magnitude()};
}
inline Interval min(Interval a, Interval b) {
    return {std::min(a.lo, b.lo), std::min(a.hi, b.hi)};
}
inline Interval max(Interval a, Interval b) {
    return {std::max(a.lo, b.lo), std::max(a.hi, b.hi)};
}
inline Interval clamp(Interval a, double from, double to) {
    return {std::clamp(a.lo, from, to), std::clamp(a.hi, from, to)};
}
inline Interval squareRoot(Interval a) {
    return rounded({std::sqrt(std::max(a.lo, 0.0)), std::sqrt(std::max(a.hi, 0.0))}, 10);
}
/// Is it at least `value`?
inline Verdict atLeast(Interval a, double value) {
    return a.lo >= value ? Verdict::Must : a.hi < value ? Verdict::Never : Verdict::May;
}

struct Interval3 {
    Interval x, y, z;
    Interval3() = default;
    Interval3(Interval ax, Interval ay, Interval az) : x(ax), y(ay), z(az) {}
    explicit Interval3(Vec3 v) : x(v.x), y(v.y), z(v.z) {}
};
inline Interval3 operator*(Interval3 a, Interval s) {
    return {a.x * s, a.y * s, a.z * s};
}
inline Interval3 operator+(Interval3 a, Interval3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
/// The three products may be summed in any order.
inline Interval dot(Interval3 a, Interval3 b) {
    const Interval x = a.x * b.x, y = a.y * b.y, z = a.z * b.z;
    const double error = 3 * kFloatRoundoff * (x.magnitude() + y.magnitude() + z.magnitude());
    return {x.lo + y.lo + z.lo - error, x.hi + y.hi + z.hi + error};
}
inline Interval3 cross(Interval3 a, Interval3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Interval component(const Interval3& a, int axis) {
    return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}

}  // namespace gnomon::reference
