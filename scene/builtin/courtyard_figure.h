#pragma once
// People of the courtyard: a skeleton, a body with clothes bound to it, and poses. A figure's own frame: x to its left,
// y up, +z the way it faces, origin on the ground between its feet; measures are those of a grown-up of 1.75 m.

#include "scene/builtin/courtyard.h"

#include <functional>

namespace gnomon::renderer::courtyard {

// Order of the nodes of one figure, parents first; right limbs follow left ones by kPerLimb.
enum Joint : std::uint32_t {
    kRoot,
    kHips,
    kChest,
    kHead,
    kUpperArmL,
    kForearmL,
    kHandL,
    kUpperArmR,
    kForearmR,
    kHandR,
    kThighL,
    kShinL,
    kFootL,
    kThighR,
    kShinR,
    kFootR,
    kProp,
    kJointCount
};
inline constexpr std::uint32_t kPerLimb = 3;

inline constexpr float kThighLength = 0.43f, kShinLength = 0.42f, kAnkleHeight = 0.08f;
inline constexpr float kUpperArmLength = 0.27f, kForearmLength = 0.25f;
inline constexpr float kHipHeight = 0.96f;

/// Rotation about an axis of any length, radians.
glm::quat about(const glm::vec3& axis, float angle);

/// Joint in its parent's frame, standing with hanging arms.
glm::vec3 bindTranslation(std::uint32_t joint);
std::uint32_t parentOf(std::uint32_t joint);

// Local transforms of all joints. kProp, a child of the root, carries what the figure holds.
struct Pose {
    std::array<glm::vec3, kJointCount> translation;
    std::array<glm::quat, kJointCount> rotation;
    Pose();
    /// Figure-space place of a joint, the root's own transform left out.
    [[nodiscard]] glm::mat4 figureFromJoint(std::uint32_t joint) const;
};

struct Look {
    enum class Head { Hair, Hood, StrawHat, Cap };
    std::uint32_t robe, second, skin, hair, leather, straw;  // materials; second: belt, shawl or trousers
    bool longRobe = true;                                    // else a tunic to the knee over trousers
    bool shawl = false, beard = false;
    Head head = Head::Hair;
    float scale = 1.0f;
};

/// Bound to the skeleton, in figure space; every primitive has joints and weights.
std::vector<Primitive> figureBody(const Look& look);

// courtyard_figure_motion.cpp

/// Turns an arm so that its wrist comes to `target` (figure space), the elbow towards `pole`.
void reachWith(Pose& pose, bool left, const glm::vec3& target, const glm::vec3& pole);

struct Gait {
    float metresPerCycle = 1.25f;  // two steps
    float stance = 0.62f;          // share of a cycle that a foot stands
    float lift = 0.10f;            // metres, of a swinging foot
    float armSwing = 0.45f;        // radians
    float lean = 0.03f;            // radians
};
/// Legs, hips and arms at `phase` (0 to 1) of a cycle.
void walk(Pose& pose, const Gait& gait, float phase);

/// Both feet on the ground, so far ahead of the hips' rest.
void stand(Pose& pose, float leftAhead, float rightAhead);

// A closed path on the ground, walked at constant speed. `at` runs from 0 to 1.
class ClosedPath {
public:
    explicit ClosedPath(std::vector<glm::vec2> corners);  // x and z, smoothly joined
    [[nodiscard]] float length() const { return lengths_.back(); }
    [[nodiscard]] glm::vec2 place(float at) const;
    [[nodiscard]] float heading(float at) const;  // turn about y that looks along the path

private:
    [[nodiscard]] glm::vec2 curve(float corner) const;
    std::vector<glm::vec2> corners_;
    std::vector<float> lengths_;  // up to sample i
};

// courtyard_moving.cpp: what turns poses into nodes, skins and animations

/// Adds a node at rest with this transform; returns its index.
std::uint32_t addNode(Scene& scene, std::string name, std::uint32_t parent, const glm::vec3& translation,
                      const glm::quat& rotation = {1, 0, 0, 0}, float scale = 1.0f);
glm::mat4 worldFromNode(const Scene& scene, std::uint32_t node);  // at rest
/// A rigid mesh that moves with a node and has the node's frame.
void placeOn(SceneBuilder& builder, std::uint32_t node, std::uint32_t mesh);
/// A mesh whose vertices stand in figure space of an unposed skeleton: moved to the rest of its nodes and bound there.
void placeSkinned(SceneBuilder& builder, std::string name, std::vector<Primitive> primitives,
                  const std::vector<std::uint32_t>& joints, const std::vector<glm::mat4>& jointFromFigure);

/// A channel of the scene's one animation, of `keys` equal steps over one loop; `at` runs from 0 to 1, and 1 gives what
/// 0 gives.
void animatePlace(Scene& scene, std::uint32_t node, int keys, const std::function<glm::vec3(float)>& translation);
void animateTurn(Scene& scene, std::uint32_t node, int keys, const std::function<glm::quat(float)>& rotation);

using PoseAt = std::function<Pose(float)>;  // of the share of the loop that has passed
/// The first of the figure's kJointCount nodes.
std::uint32_t addFigure(Parts& parts, const std::string& name, const Look& look, int keys, const PoseAt& poseAt);

}  // namespace gnomon::renderer::courtyard
