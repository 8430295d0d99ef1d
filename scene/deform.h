#pragma once
// Morph targets, then linear blend skinning.

#include "scene/pose.h"

namespace gnomon::renderer {

/// Vertices from out.weights (as many as targets, or fewer) and out.objectFromMesh (none: not skinned). False where one
/// is thrown kFarthestUnits away or more.
[[nodiscard]] bool deformPrimitive(const Primitive& primitive, PosedPrimitive& out);

}  // namespace gnomon::renderer
