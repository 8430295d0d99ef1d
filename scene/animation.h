#pragma once
// What moves: nodes, skins, morph targets and animations of a scene, and the pose they take at a time.
//
// A scene's nodes form a forest. Parents come before their children. An instance, light or camera that hangs on a node
// moves with it. All others stand still, and cost nothing. Vertices are deformed on the CPU, so that the ray tracer,
// the shadowmaps and the G-buffer see the very same triangles.
// Source: Khronos glTF 2.0 specification, sections 3.7 (skins, morph targets), 3.11 and appendix C (interpolation).

#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string>
#include <vector>

namespace gnomon::renderer {

struct Scene;
struct Primitive;

/// Local transform: translation * rotation * scale. Its parent has a lower index.
struct Node {
    std::string name;
    std::uint32_t parent = 0xFFFFFFFFu;  ///< kNone: a root
    glm::dvec3 translation{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< unit
    glm::dvec3 scale{1.0};
    std::vector<float> weights;        ///< of the morph targets of instances on this node; empty: their mesh's
    std::optional<glm::dmat4> matrix;  ///< in place of the three, where they cannot express it; no channel may move it
};

struct Skin {
    std::string name;
    std::vector<std::uint32_t> joints;     ///< nodes
    std::vector<glm::mat4> jointFromMesh;  ///< inverse bind matrices, one per joint
};

/// Offsets from a primitive's vertices; arrays have the length of its positions or are empty.
struct MorphTarget {
    std::vector<glm::vec3> positions, normals, tangents;
};

struct AnimationChannel {
    enum class Path : std::uint8_t { Translation, Rotation, Scale, Weights };
    enum class Interpolation : std::uint8_t { Step, Linear, CubicSpline };
    std::uint32_t node = 0;
    Path path = Path::Translation;
    Interpolation interpolation = Interpolation::Linear;
    std::vector<float> times;  ///< seconds, strictly ascending, at least one
    std::vector<float>
        values;  ///< per time: 3, 4 (x y z w) or the node's count of weights; cubic splines: three times that
};

struct Animation {
    std::string name;
    float durationSeconds = 0.0f;  ///< of its longest channel; played in a loop
    std::vector<AnimationChannel> channels;
    bool playing = true;  ///< false: an alternative that stands by
};

}  // namespace gnomon::renderer
