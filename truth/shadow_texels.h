#pragma once
// How large a texel of a light's shadowmaps is where a receiver stands.

#include <span>

#include "gnomon/scene.h"
#include "scene/scene.h"

namespace gnomon::renderer {

/// Metres across, perpendicular to the light; 0 where the light has no shadow view there. `position` is relative to the
/// views' origin. Where two cascades blend, the larger one counts.
[[nodiscard]] double shadowTexelMetres(std::span<const ShadowView> views, LightKind kind,
                                       const glm::dvec3& lightPosition, const glm::dvec3& position);

}  // namespace gnomon::renderer
