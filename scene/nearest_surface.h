#pragma once
// How near the things are that a light shines on. CPU only.

#include <vector>

#include "scene/scene.h"

namespace gnomon::renderer {

/// For each light the distance to the nearest surface within its range and cone, while the animations play (at the
/// times that animatedExtent() looks at). Infinity where there is none, for directional lights, and for lights that
/// `wanted` (as many) leaves out. A surface that the light lies on does not count. Lights must have ranges. Masks count
/// as whole.
[[nodiscard]] std::vector<float> nearestSurfaces(const Scene& scene, const std::vector<bool>& wanted);

}  // namespace gnomon::renderer
