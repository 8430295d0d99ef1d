#pragma once
// Percentage closer soft shadows: a penumbra as wide as the source of the light makes it.
//
// Source: Fernando 2005, "Percentage-Closer Soft Shadows"; the specification, Phase 4.
//
// What, for a receiver at linear depth z and a source of radius R (directional: the tangent of its angular radius):
//   Region. The cone from the receiver to the source is, at linear depth z_b, this wide: R (1/z_b - 1/z) in tangents of
//   the view (perspective), R (z - z_b) in metres (orthographic). Both are linear in the blocker's device depth:
//   g = g0 + g1 D. P is the larger of the view's texels per such unit. The search reaches to S = G + 1/P, where G is
//   the widest region worth a look (perspective: of a blocker at a tenth of z; orthographic: at the near plane), but no
//   more than kMaxPcssRadiusPx texels. Pattern. Taps are points e of the unit disk, turned by a hash of the pixel, from
//   each to the next by the golden angle. A disk in front of the light is an ellipse off the view's axis: K(e) = e + T
//   (T.e) / (1 + |(T, 1)|), where T is the tangent of the pixel's direction. Tap position = pixel's position + K(e) *
//   radius * texels per unit. Search. Tap i lies at ((i + 1/2) / searchTaps)^2 of S and takes the four texels around
//   it. One occludes if it is not lit; it is a blocker if besides the tap's distance aside is within its region, give
//   or take 1.5 texels. All texels occlude: dark. Else no blocker among them: lit. Filter. The mean device depth of the
//   blockers gives the radius, at least one texel and at most G's. Tap i lies at sqrt((i + 1/2) / filterTaps) of it and
//   is a bilinear comparison; the result is their mean. Leaving. Positions stay a texel inside the rectangle. Spots and
//   cascades clamp them; a point light's tap that would leave looks at the face that its direction hits: one texel,
//   which in the search counts as four, against the depth that the receiver's plane has in that direction.
// In all comparisons the receiver's plane is limited, see depthOfPlane().
//
// The parts stand alone, too, for a search that several receivers share (pcss_quad.h). Such a search is made from their
// middle. It reaches farther by their distance from it, and a texel counts as if it were nearer by as much.
//
// Limits: intervals throughout; blocker_search.h says what becomes of texels that are too close to call.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "reference/filters.h"

namespace gnomon::reference {

struct PcssTapCounts {
    int search = 16, filter = 24;
};

/// The unit vectors of a pixel's taps, before they are scaled to the disk. `turn`: 2^32 to a whole turn.
struct DiskDirection {
    Interval x, y;
};
std::vector<DiskDirection> diskDirections(std::uint32_t x, std::uint32_t y, std::uint32_t turn, int count);

/// How many filter taps a penumbra takes whose taps follow its radius in texels: 5/12 of them at 0, 1/32 more per
/// square texel, rounded down to whole ones and one more, at most all of them. Rounding may turn that: first and last.
struct TapRange {
    int from = 1, to = 1;
};
TapRange tapsForRadius(int most, Interval radiusPx);

struct PcssInput {
    std::span<const ShadowViewModel> views;  ///< of the light: one, or six faces
    std::span<const AtlasCopy> atlases;
    std::size_t view = 0;  ///< the receiver's
    Interval sourceRadius;
    PcssTapCounts taps;
    std::span<const DiskDirection> directions;  ///< at least as many as the larger number of taps
    bool tapsByRadius = false;                  ///< see tapsForRadius(); else all of them
};
Visibility pcssAt(const PcssInput& input, const ReceiverPlane& plane);

/// What a search alone comes to.
struct PcssSearch {
    bool mayBeDark = false, mayBeLit = false;
    bool mayBePartial = false;
    Interval radiusPx;  ///< then: of the filter, in texels of the finer axis
};
/// `spreadMetres`: how far the receivers lie from their middle, which `plane` is of.
PcssSearch pcssSearchAt(const PcssInput& input, const ReceiverPlane& plane, Interval spreadMetres);
/// The filter alone.
Visibility pcssFilterAt(const PcssInput& input, const ReceiverPlane& plane, Interval radiusPx);

}  // namespace gnomon::reference
