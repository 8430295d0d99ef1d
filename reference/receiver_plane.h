#pragma once
// The receiver's plane: how deep, in a shadow view, the pixel's own face lies beside the pixel.
//
// Problem: a shadowmap's texel holds the depth at its centre, not at the pixel. On a face that is slanted in the view
// the two differ by far more than any fixed bias, the more the farther away a filter looks.
//
// Source: Isidoro 2006, "Shadow Mapping: GPU-based Tips and Techniques" (receiver plane depth bias), from the face
// normal instead of screen derivatives.
//
// What: with clip.xyw = (r0 p, r1 p, a p) up to constants, a face of normal n obeys alpha X w + beta Y w + gamma w =
// const, where (alpha, beta, gamma) = (n (r1 x a), n (a x r0), n (r0 x r1)). Perspective: 1/w, and with it device
// depth, is linear in X and Y; orthographic: w is. The slopes per texel follow. Where the view sees the face from the
// side, the least tilt (kLeastCosine) keeps them finite. Device depth at p starts a bias nearer to the light, which
// grows by what the pixel may lie off its face, seen along the light's axis; and a slack of a sixteenth of the slopes,
// a step of the atlas' depth and a few float roundings. Without a plane (DepthMode::Constant) all texels have one
// depth: that of p, moved, with no slack.
//
// Limits: all is interval arithmetic, see interval.h. What rounding could turn gives several planes.

#include <vector>

#include "reference/interval.h"
#include "reference/receivers.h"
#include "reference/shadow_views.h"

namespace gnomon::reference {

inline constexpr double kLeastCosine = 0.005;

enum class DepthMode { Plane, Constant };

struct ReceiverPlane {
    Interval xPx, yPx;            ///< where the pixel lies in the atlas
    Interval linearDepth;         ///< of the pixel, no bias
    Interval tangentX, tangentY;  ///< of the pixel's direction from the view's axis; 0 if orthographic
    Interval ray = 1.0;           ///< length of (tangentX, tangentY, 1)
    Interval slopeX, slopeY;      ///< device depth per texel
    Interval depth;               ///< device depth at (xPx, yPx), with bias and slack
};

struct ReceiverInView {
    bool mayBeBehind = false;  ///< behind a perspective view: lit
    bool unknown = false;      ///< anything may come out
    std::vector<ReceiverPlane> planes;
};
/// What the light's bias and the view's limits to it allow, but `leastMetres` at least. `none`: nothing of all that.
struct Bias {
    double metres = 0.0, leastMetres = 0.0;
    bool none = false;
};
/// The bias, and with it the slack, is toward the light or away from it.
ReceiverInView receiverIn(const ShadowViewModel& view, const Pixel& pixel, DepthMode mode, const Bias& bias,
                          bool toward);

/// Device depth of the plane at an atlas position. `limited`: no more than |slopeX| + |slopeY| farther from the light
/// than at the pixel itself.
Interval depthOfPlane(const ShadowViewModel& view, const ReceiverPlane& plane, Interval xPx, Interval yPx,
                      bool limited);

/// Is a surface at `stored` no nearer to the light than a receiver at `depth`?
Verdict isLit(const ShadowViewModel& view, double stored, Interval depth);

}  // namespace gnomon::reference
