#pragma once
// Comparisons of a receiver with a shadowmap's texels: one, bilinear, and percentage closer filtering.
//
// Source: the specification, Phase 4; Reeves, Salesin and Cook 1987 (percentage closer filtering).
//
// What: every texel is compared at its own centre, against the depth that the receiver's plane has there. Hard takes
// the texel that holds the position. PCF of radius r is the mean of (2r + 1)^2 bilinear comparisons, that is the sum
// over (2r + 2)^2 texels with weights (1 - f), 1, ..., 1, f per axis over (2r + 1)^2, f being the position's fraction
// relative to texel centres; the position is clamped so that the kernel's support, r + 1 texels to each side, stays in
// the view's rectangle.
//
// Limits: a position is an interval too, and the result holds what every position in it would give.

#include "reference/receiver_plane.h"

namespace gnomon::reference {

/// Visibilities between 0 and 1 that are acceptable.
struct Visibility {
    double min = 1, max = 1;
};
inline constexpr Visibility kLit = {1, 1}, kDark = {0, 0}, kAny = {0, 1};
inline constexpr Visibility kNone = {1, 0};  ///< of no outcome yet: merge() adds some
inline Visibility merge(Visibility a, Visibility b) {
    return {std::min(a.min, b.min), std::max(a.max, b.max)};
}
inline Visibility visibilityOf(Verdict lit) {
    return lit == Verdict::Must ? kLit : lit == Verdict::Never ? kDark : kAny;
}

/// A receiver in front of one view's texels.
struct Comparison {
    const ShadowViewModel& view;
    const AtlasCopy& atlas;
    const ReceiverPlane& plane;
    bool limited = false;  ///< see depthOfPlane()

    /// One texel, which must lie in the atlas.
    [[nodiscard]] Verdict lit(int x, int y) const;
    [[nodiscard]] double stored(int x, int y) const;
};

/// First and last texel that may hold a coordinate, kept in [first, first + size).
struct TexelRange {
    int from = 0, to = 0;
};
TexelRange texelsOf(Interval px, int first, int size);

Visibility hardAt(const Comparison& comparison, Interval xPx, Interval yPx);
/// The plain mean of (2 radius + 1)^2 bilinear comparisons; 0: a single one.
Visibility pcfAt(const Comparison& comparison, int radius, Interval xPx, Interval yPx);

}  // namespace gnomon::reference
