#pragma once
// Cascades of a directional light: orthographic shadow views around slices of the camera's view.
//
// Stable: no edge crawls while the camera moves or turns.
// - A cascade surrounds its slice's bounding sphere. So its size depends on the slice's distances and the camera's lens
//   alone.
// - Its place moves in steps of whole texels. The steps are kCascadeStepPx texels wide, so that a slow camera leaves
//   most cascades as they were drawn.
// Source: Valient 2008, "Stable Rendering of Cascaded Shadow Maps", ShaderX6; Zhang et al. 2006, "Parallel-Split Shadow
// Maps" (distances between logarithmic and even).

#include <cstdint>
#include <glm/glm.hpp>

#include "gnomon/scene.h"

namespace gnomon::renderer {

inline constexpr std::uint32_t kCascadeStepPx = 16;

struct CascadeSettings {
    std::uint32_t count = 4;     ///< 1 to 8
    float evenShare = 0.05f;     ///< of the split distances: 0 logarithmic, 1 even
    float nearestMetres = 1.0f;  ///< where the logarithm starts, at most a tenth of the reach
    float reachMetres = 200.0f;  ///< of the last cascade, at most; scenes that end before it need less
};

/// What cascades need of a camera.
struct CascadeCamera {
    glm::dvec3 position{0.0};
    glm::dvec3 forward{0.0, 0.0, -1.0};  ///< unit
    double tangent = 0.7;                ///< perspective: of the angle between the axis and the picture's corner
    double halfDiagonalMetres = 0.0;     ///< orthographic: half the picture's diagonal; else 0
};

/// A sphere around everything that casts.
struct CasterBounds {
    glm::dvec3 centre{0.0};
    double radius = 0.0;  ///< metres; 0: nothing to cast
};

struct Cascade {
    glm::dvec3 centre{0.0};   ///< world, on the plane of the nearest caster
    double halfExtent = 0.0;  ///< metres, guard texels included
    double depth = 0.0;       ///< metres between near and far
};

/// Distances at which the slices end: `ends[0]` to `ends[count - 1]`, metres.
void cascadeEnds(const CascadeSettings& settings, const CascadeCamera& camera, const CasterBounds& casters,
                 double (&ends)[8]);

/// Cascade `index` of a light that travels in `direction` (unit), drawn with `sizePx` texels across.
Cascade cascadeAround(const CascadeSettings& settings, const CascadeCamera& camera, const CasterBounds& casters,
                      const glm::vec3& direction, std::uint32_t index, std::uint32_t sizePx);

/// The cascade's view; positions relative to `origin`, reversed Z. The rectangle's place is left to the caller.
ShadowView cascadeView(const Cascade& cascade, const glm::vec3& direction, std::uint32_t sizePx,
                       const glm::dvec3& origin);

}  // namespace gnomon::renderer
