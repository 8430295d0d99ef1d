#pragma once
// Cascades of a directional light: orthographic shadow views around slices of the camera's view.
//
// Stable: no edge crawls while the camera moves or turns.
// - A cascade surrounds its slice's bounding sphere. So its size depends on the slice's distances and the camera's lens
//   alone.
// - Its place moves in steps of whole texels. The steps are kCascadeStepPx texels wide, so that a slow camera leaves
//   most cascades as they were drawn.
// - The slices' distances, and near and far along the light, move in steps, too.
// Fitted: nothing here is in metres, and no bound of the whole scene counts.
// - The slices end where the farthest part of the scene that is seen ends, specks left out. They begin where the nearest
//   one begins.
// - A plane that is seen to the horizon counts only as far as something casts upon it.
// - The first slice ends where most of what is seen has not begun, whatever stands right before the camera.
// - Along the light a cascade holds what is seen within its square, and whatever may cast upon that.
// Limits: parts are boxes. One part as large as the world, that is no plane, makes the cascades as large.
// Source: Valient 2008, "Stable Rendering of Cascaded Shadow Maps", ShaderX6; Zhang et al. 2006, "Parallel-Split Shadow
// Maps" (distances between logarithmic and even).

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "gnomon/scene.h"
#include "renderer/gpu/cull_volume.h"

namespace gnomon::renderer {

inline constexpr std::uint32_t kCascadeStepPx = 16;

struct CascadeSettings {
    std::uint32_t count = 4;    ///< 1 to 8
    float evenShare = 0.05f;    ///< of the split distances: 0 logarithmic, 1 even; orthographic cameras: always even
    double mostRatio = 2000.0;  ///< the logarithm starts at this part of the farthest distance, or farther away
};

/// What cascades need of a camera.
struct CascadeCamera {
    glm::dvec3 position{0.0};
    glm::dvec3 forward{0.0, 0.0, -1.0};  ///< unit
    double tangent = 0.7;                ///< perspective: of the angle between the axis and the picture's corner
    double halfDiagonalMetres = 0.0;     ///< orthographic: half the picture's diagonal; else 0
};

/// Along the camera's axis, metres.
struct SeenRange {
    double nearest = 0.0, farthest = 0.0;  ///< between which anything is seen; farthest 0: nothing is
    double most = 0.0;                     ///< beyond which nearly all of it lies
};
/// Of what light that travels in `direction` (unit) may leave in shadow. In steps of a quarter of a power of two.
/// `frustum` may have no planes: then parts are seen whole.
SeenRange seenRangeOf(const CascadeCamera& camera, const CullVolume& frustum, std::span<const ScenePart> parts,
                      const glm::vec3& direction);

struct Cascade {
    glm::dvec3 centre{0.0};   ///< world, on the near plane: nothing that casts is before it
    double halfExtent = 0.0;  ///< metres, guard texels included
    double depth = 0.0;       ///< metres between near and far
};

/// Distances at which the slices end: `ends[0]` to `ends[count - 1]`, metres.
void cascadeEnds(const CascadeSettings& settings, const CascadeCamera& camera, const SeenRange& seen,
                 double (&ends)[8]);

/// Cascade `index` of a light that travels in `direction` (unit), drawn with `sizePx` texels across.
Cascade cascadeAround(const CascadeSettings& settings, const CascadeCamera& camera, const SeenRange& seen,
                      std::span<const ScenePart> parts, const glm::vec3& direction, std::uint32_t index,
                      std::uint32_t sizePx);

/// The cascade's view; positions relative to `origin`, reversed Z. The rectangle's place is left to the caller.
ShadowView cascadeView(const Cascade& cascade, const glm::vec3& direction, std::uint32_t sizePx,
                       const glm::dvec3& origin);

}  // namespace gnomon::renderer
