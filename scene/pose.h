#pragma once
// The pose of a scene at a time: where its nodes, instances, lights and cameras are, and the vertices of what deforms.
//
// Node transforms are kept in double. Vertices are floats. Those of a skinned instance count from an anchor near its
// joints, on a grid of kAnchorGridMetres. So a figure far from the scene's origin is as smooth as one near it.
// Everything is computed on the CPU, so that whatever draws or traces the scene meets the very same triangles.

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <stdexcept>
#include <vector>

#include "scene/scene.h"

namespace gnomon::renderer {

/// A float step is 0.06 mm within 1 km.
inline constexpr double kAnchorGridMetres = 1024.0;

/// From any origin; beyond, squared lengths overflow a float.
inline constexpr float kFarthestUnits = 1.0e15f;

/// How far a light or camera may be from the origin along any axis: floats farther out are coarser than anything a
/// picture could show, and no frame's origin helps.
inline constexpr float kFarthestMetres = 1.0e8f;

/// Times at which an animation's extent is looked at, besides its keys.
inline constexpr std::uint32_t kExtentSamples = 16;

/// Vertices of one primitive of one instance, in the space of Pose::worldFromObject. Same counts as the primitive's.
struct PosedPrimitive {
    std::uint32_t instance = 0, primitive = 0;
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec4> tangents;
    Bounds bounds;  ///< of all positions
    // What they were computed from.
    std::vector<glm::mat4> objectFromMesh;  // per joint
    std::vector<float> weights;
};

struct Pose {
    double timeSeconds = 0.0;
    std::vector<glm::dmat4> worldFromNode, worldFromNodeAtRest;
    std::vector<glm::dmat4> worldFromObject;  ///< per instance
    std::vector<PosedPrimitive> deformed;     ///< in order of instance and primitive
    std::vector<SceneLight> lights;           ///< all of the scene's
};

/// An animation throws a node or a vertex too far: one sentence.
struct PoseError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// In its parent's space.
[[nodiscard]] glm::dmat4 localTransform(const Node& node);
/// True where the primitive's vertices depend on the pose.
[[nodiscard]] bool deforms(const Instance& instance, const Primitive& primitive);
/// True where two times may look different.
[[nodiscard]] bool isAnimated(const Scene& scene);

/// All playing animations at `timeSeconds` (any finite number; each is looped). Throws PoseError.
[[nodiscard]] Pose poseAt(const Scene& scene, double timeSeconds);
/// The same into a pose of the same scene: vertices that did not change are left alone.
void poseAt(const Scene& scene, double timeSeconds, Pose& pose);
/// Without any animation.
[[nodiscard]] Pose restPose(const Scene& scene);

/// Where everything drawn and each light comes to be while the animations play. The pose at rest does not count, as
/// long as something plays: a file may store anything there. Nor do moments that throw something beyond
/// kFarthestMetres.
struct AnimatedExtent {
    Bounds drawn;
    std::vector<Bounds> lights;  ///< of their positions, one per light
};
/// From `samples` times over the longest animation that plays, and from key times.
[[nodiscard]] AnimatedExtent animatedExtent(const Scene& scene, std::uint32_t samples = kExtentSamples);

/// The poses that animatedExtent() looks at, one after another: those at its times, or the one at rest where nothing
/// plays or no time can be posed.
void forEachPose(const Scene& scene, std::uint32_t samples, const std::function<void(const Pose&)>& work);

/// A camera of the scene, moved by its node.
[[nodiscard]] SceneCamera posedCamera(const Scene& scene, const Pose& pose, const SceneCamera& camera);
/// A still scene that shows the pose: same instances, primitives and triangles.
[[nodiscard]] Scene posedScene(const Scene& scene, const Pose& pose);
/// What poseAt() reads of a scene, without textures and the vertices of what cannot deform.
[[nodiscard]] Scene posablePart(const Scene& scene);

}  // namespace gnomon::renderer
