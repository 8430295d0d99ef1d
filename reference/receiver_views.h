#pragma once
// A pixel before a light's shadow views: which of them it may ask, and how it lies in one.
//
// Source: the specification, Phase 4; generate_shadows.h, steps 1 to 3.

#include <vector>

#include "reference/generate_shadows.h"

namespace gnomon::reference {

/// Does the pixel look at the light: c > 0?
struct Facing {
    bool mayFace = false, mayFaceAway = false;
};
Facing facingOf(const LightModel& light, const Pixel& pixel);

/// Are face normals of no use: nothing hangs on where a face looks?
bool ignoresFaceNormals(const ShadowInput& input);

/// Faces of a point light that the pixel may lie in: that of the largest component, and those that float errors could
/// put before it. Of other lights: the first view.
std::vector<std::size_t> facesOf(const LightModel& light, const Pixel& pixel);

/// The pixel in one of the light's views. `toward`: its bias is toward the light, or away from it.
ReceiverInView receiverInView(const LightModel& light, std::size_t which, const Pixel& pixel, const ShadowInput& input,
                              bool toward);

}  // namespace gnomon::reference
