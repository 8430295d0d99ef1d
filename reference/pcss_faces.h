#pragma once
// A point light's tap that leaves its face: the texel of another face in the same direction.
//
// What: a position in the own view is a direction from the light, a + r0 / |r0|^2 X + r1 / |r1|^2 Y, whose length along
// the own axis a is 1. Its largest component names the face; the texel is that of its projection there. The receiver's
// plane has a linear depth l in that direction in the own view, and l * w in the other, where w is the direction's
// length along the other axis.

#include <span>
#include <vector>

#include "reference/receiver_plane.h"

namespace gnomon::reference {

/// A texel that the tap may take, with what it is compared with.
struct OtherTexel {
    std::size_t face = 0;
    std::uint32_t x = 0, y = 0;  ///< atlas texel
    Interval w;                  ///< linear depth in the other view per linear depth in the own
    Interval depth;              ///< the receiver's plane in the other view's device depth
};
struct OtherFaces {
    bool unknown = false;  ///< anything may come out
    std::vector<OtherTexel> texels;
};
OtherFaces otherFaces(std::span<const ShadowViewModel> faces, std::size_t own, const ReceiverPlane& plane, Interval xPx,
                      Interval yPx);

/// A stored depth of the other view in the own view's device depth.
Interval inOwnView(const ShadowViewModel& own, const ShadowViewModel& other, const OtherTexel& texel, double stored);

}  // namespace gnomon::reference
