#pragma once
// How much of a light's source a point sees.

#include "truth/receivers.h"

namespace gnomon::renderer {

/// The source as rays meet it. A point light's sphere is the disk that faces the receiver; a spot's is a disk across
/// its axis; a directional light is a cone of its angular radius.
struct LightSource {
    LightKind kind = LightKind::Point;
    glm::dvec3 position{0.0};  ///< relative to the traced scene's origin
    glm::dvec3 direction{0.0, -1.0, 0.0};
    double radius = 0.0;  ///< metres; directional: radians
};

/// Unit vector to the light's centre.
[[nodiscard]] glm::dvec3 directionTo(const LightSource& source, const glm::dvec3& position);
/// End of a ray to the light's centre.
[[nodiscard]] glm::dvec3 endOfRay(const LightSource& source, const glm::dvec3& position, double reachMetres);

/// Share of the source's disk that `raysPerSide` squared stratified rays find free. What is below the receiver's face
/// is dark, unless the receiver is subsurface. The same `seed` gives the same rays.
[[nodiscard]] double softVisibility(const TracedScene& scene, const TruthReceiver& receiver, const LightSource& source,
                                    std::uint32_t raysPerSide, std::uint64_t seed);

}  // namespace gnomon::renderer
