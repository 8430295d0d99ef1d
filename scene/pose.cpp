#include "scene/pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/deform.h"
#include "scene/sample_animation.h"

namespace gnomon::renderer {
namespace {

// True where what hangs on a node can not be told from its place at rest: the inverse is missing, or would blow up the
// rounding of a float more than a hundred times.
bool hidesWhatHangsOnIt(const glm::dmat4& m) {
    constexpr double kWorstCondition = 100.0;
    const auto norm = [](const glm::dmat3& a) {
        return std::sqrt(glm::dot(a[0], a[0]) + glm::dot(a[1], a[1]) + glm::dot(a[2], a[2]));
    };
    const double size = norm(glm::dmat3(m));
    if (!(size > 0.0)) return true;
    const glm::dmat3 scaled = glm::dmat3(m) / size;
    if (!(std::abs(glm::determinant(scaled)) > 1.0e-30)) return true;
    return !(norm(glm::inverse(scaled)) < kWorstCondition);
}

// Equal but for the rounding of floats.
template <class Vector>
bool isNear(const Vector& a, const Vector& b) {
    return glm::length(a - b) <= 1.0e-6 * glm::length(b);
}

bool isNear(const glm::dmat4& a, const glm::dmat4& b) {
    return isNear(a[0], b[0]) && isNear(a[1], b[1]) && isNear(a[2], b[2]) && isNear(a[3], b[3]);
}

// Relative to `origin`: what lies there keeps all of its digits, however far out that is.
std::vector<glm::dmat4> worldTransforms(const std::vector<Node>& nodes, const glm::dvec3& origin, double timeSeconds) {
    std::vector<glm::dmat4> world(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        world[i] = localTransform(nodes[i]);
        if (nodes[i].parent != kNone)
            world[i] = world[nodes[i].parent] * world[i];
        else
            world[i][3] -= glm::dvec4(origin, 0.0);
        for (int k = 0; k < 16; ++k)
            if (!(std::abs(world[i][k / 4][k % 4]) < static_cast<double>(kFarthestUnits)))
                throw PoseError(fmt::format("The node '{}' is thrown beyond {:g} units from the origin at {:g} s.",
                                            nodes[i].name.substr(0, 60), kFarthestUnits, timeSeconds));
    }
    return world;
}

void apply(const AnimationChannel& channel, double seconds, Node& node) {
    double v[4];
    switch (channel.path) {
        case AnimationChannel::Path::Translation:
            sampleChannel(channel, seconds, std::span(v, 3));
            node.translation = {v[0], v[1], v[2]};
            break;
        case AnimationChannel::Path::Rotation:
            sampleChannel(channel, seconds, std::span(v, 4));
            node.rotation = glm::dquat(v[3], v[0], v[1], v[2]);
            break;
        case AnimationChannel::Path::Scale:
            sampleChannel(channel, seconds, std::span(v, 3));
            node.scale = {v[0], v[1], v[2]};
            break;
        case AnimationChannel::Path::Weights: {
            std::vector<double> weights(channelWidth(channel));
            sampleChannel(channel, seconds, weights);
            node.weights.assign(weights.begin(), weights.end());
            break;
        }
    }
}

// Where `rest`, given in the world at rest, comes to lie when its node moves. What stands where its node stands follows
// the node alone, so that nothing of the pose at rest is left in it.
glm::dmat4 moved(const Pose& pose, std::uint32_t node, const glm::dmat4& rest) {
    const glm::dmat4& now = pose.worldFromNode[node];
    const glm::dmat4& before = pose.worldFromNodeAtRest[node];
    if (now == before) return rest;
    return isNear(rest, before) || hidesWhatHangsOnIt(before) ? now : now * glm::inverse(before) * rest;
}

// The node's z axis, unit. A scale of zero along it hides it; the two other axes still tell it. Zero where they do not.
glm::dvec3 alongAxis(const glm::dmat4& node) {
    const glm::dvec3 x(node[0]), y(node[1]), z(node[2]);
    const glm::dvec3 axis = z != glm::dvec3(0.0) ? z : glm::cross(x, y);
    const double length = glm::length(axis);
    return length > 0.0 ? axis / length : glm::dvec3(0.0);
}

SceneLight posedLight(const Pose& pose, const SceneLight& light) {
    const glm::dmat4& now = pose.worldFromNode[light.node];
    const glm::dmat4& before = pose.worldFromNodeAtRest[light.node];
    if (now == before) return light;
    SceneLight out = light;
    const bool hidden = hidesWhatHangsOnIt(before);
    const glm::dmat4 motion = hidden ? glm::dmat4(1.0) : now * glm::inverse(before);
    const glm::dvec4 position(glm::dvec3(light.position), 1.0);
    out.position = glm::vec3(hidden || isNear(position, before[3]) ? now[3] : motion * position);
    glm::dvec3 direction = glm::dmat3(motion) * glm::dvec3(light.direction);
    if (hidden || isNear(-alongAxis(before), glm::dvec3(light.direction))) direction = -alongAxis(now);
    const double length = glm::length(direction);
    if (length > 0.0) out.direction = glm::vec3(direction / length);
    return out;
}

void place(const Scene& scene, Pose& pose) {
    pose.worldFromObject.resize(scene.instances.size());
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const glm::dmat4& rest = instance.worldFromObject;
        if (instance.skin != kNone) {
            const glm::dvec3 joint(pose.worldFromNode[scene.skins[instance.skin].joints.front()][3]);
            pose.worldFromObject[i] =
                glm::translate(glm::dmat4(1.0), glm::round(joint / kAnchorGridMetres) * kAnchorGridMetres);
        } else {
            pose.worldFromObject[i] = instance.node == kNone ? rest : moved(pose, instance.node, rest);
        }
    }
    if (pose.lights.size() != scene.lights.size()) pose.lights = scene.lights;
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        if (scene.lights[i].node != kNone) pose.lights[i] = posedLight(pose, scene.lights[i]);
}

std::vector<glm::mat4> jointMatrices(const Skin& skin, const Pose& pose, const glm::dmat4& worldFromObject) {
    const glm::dvec3 anchor(worldFromObject[3]);
    std::vector<glm::mat4> out(skin.joints.size());
    for (std::size_t j = 0; j < out.size(); ++j) {
        glm::dmat4 m = pose.worldFromNode[skin.joints[j]] * glm::dmat4(skin.jointFromMesh[j]);
        m[3] -= glm::dvec4(anchor, 0.0);
        out[j] = glm::mat4(m);
    }
    return out;
}

void deform(const Scene& scene, const std::vector<Node>& nodes, Pose& pose) {
    std::size_t slot = 0;
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const Mesh& mesh = scene.meshes[instance.mesh];
        std::vector<glm::mat4> joints;
        for (std::uint32_t p = 0; p < mesh.primitives.size(); ++p) {
            const Primitive& primitive = mesh.primitives[p];
            if (!deforms(instance, primitive)) continue;
            if (instance.skin != kNone && joints.empty())
                joints = jointMatrices(scene.skins[instance.skin], pose, pose.worldFromObject[i]);
            std::vector<float> weights = mesh.weights;
            if (instance.node != kNone && !nodes[instance.node].weights.empty()) weights = nodes[instance.node].weights;
            weights.resize(primitive.targets.size());
            if (slot == pose.deformed.size()) pose.deformed.emplace_back();
            PosedPrimitive& posed = pose.deformed[slot++];
            const bool same = posed.instance == i && posed.primitive == p && posed.objectFromMesh == joints &&
                              posed.weights == weights && posed.positions.size() == primitive.positions.size();
            if (same) continue;
            posed.instance = i;
            posed.primitive = p;
            posed.objectFromMesh = joints;
            posed.weights = std::move(weights);
            if (!deformPrimitive(primitive, posed))
                throw PoseError(fmt::format("A vertex of '{}' is thrown beyond {:g} units from the origin at {:g} s.",
                                            instance.name.substr(0, 60), kFarthestUnits, pose.timeSeconds));
        }
    }
    pose.deformed.resize(slot);
}

void finish(const Scene& scene, const std::vector<Node>& nodes, double timeSeconds, Pose& pose) {
    pose.timeSeconds = timeSeconds;
    if (pose.worldFromNodeAtRest.size() != scene.nodes.size())
        pose.worldFromNodeAtRest = worldTransforms(scene.nodes, scene.origin, timeSeconds);
    pose.worldFromNode = worldTransforms(nodes, scene.origin, timeSeconds);
    place(scene, pose);
    deform(scene, nodes, pose);
}

}  // namespace

glm::dmat4 localTransform(const Node& node) {
    if (node.matrix) return *node.matrix;
    return glm::scale(glm::translate(glm::dmat4(1.0), node.translation) * glm::mat4_cast(node.rotation), node.scale);
}

bool deforms(const Instance& instance, const Primitive& primitive) {
    return !primitive.targets.empty() || (instance.skin != kNone && !primitive.joints.empty());
}

bool isAnimated(const Scene& scene) {
    return std::any_of(scene.animations.begin(), scene.animations.end(),
                       [](const Animation& a) { return a.playing && !a.channels.empty(); });
}

void poseAt(const Scene& scene, double timeSeconds, Pose& pose) {
    std::vector<Node> nodes = scene.nodes;
    for (const Animation& animation : scene.animations) {
        if (!animation.playing) continue;
        const double seconds = loopedTime(animation, timeSeconds);
        for (const AnimationChannel& channel : animation.channels) apply(channel, seconds, nodes[channel.node]);
    }
    finish(scene, nodes, timeSeconds, pose);
}

Pose poseAt(const Scene& scene, double timeSeconds) {
    Pose pose;
    poseAt(scene, timeSeconds, pose);
    return pose;
}

Pose restPose(const Scene& scene) {
    Pose pose;
    finish(scene, scene.nodes, 0.0, pose);
    return pose;
}

SceneCamera posedCamera(const Scene& scene, const Pose& pose, const SceneCamera& camera) {
    if (camera.node >= scene.nodes.size()) return camera;
    const glm::dmat4 rest(camera.worldFromCamera);
    const glm::dmat4 world = moved(pose, camera.node, rest);
    if (world == rest) return camera;
    // Scale and shear of the node do not belong to the view.
    const glm::dvec3 z(world[2]), y(world[1]);
    const glm::dvec3 x = glm::cross(y, z);
    if (!(glm::length(x) > 1.0e-30))
        throw PoseError(fmt::format("The camera '{}' is flattened by its node at {:g} s.", camera.name.substr(0, 60),
                                    pose.timeSeconds));
    const glm::dvec3 right = glm::normalize(x), back = glm::normalize(z);
    SceneCamera out = camera;
    out.worldFromCamera = glm::mat4(
        glm::dmat4(glm::dvec4(right, 0.0), glm::dvec4(glm::cross(back, right), 0.0), glm::dvec4(back, 0.0), world[3]));
    return out;
}

Scene posedScene(const Scene& scene, const Pose& pose) {
    Scene out = scene;
    out.animations.clear();
    out.skins.clear();
    out.nodes.clear();
    out.lights = pose.lights;
    for (SceneLight& light : out.lights) light.node = kNone;
    for (SceneCamera& camera : out.cameras) {
        camera = posedCamera(scene, pose, camera);
        camera.node = kNone;
    }
    for (std::size_t i = 0; i < out.instances.size(); ++i) {
        Instance& instance = out.instances[i];
        instance.worldFromObject = pose.worldFromObject[i];
        instance.node = instance.skin = kNone;
    }
    for (const PosedPrimitive& posed : pose.deformed) {
        Instance& instance = out.instances[posed.instance];
        if (instance.mesh == scene.instances[posed.instance].mesh) {
            out.meshes.push_back(scene.meshes[instance.mesh]);
            instance.mesh = static_cast<std::uint32_t>(out.meshes.size() - 1);
        }
        Primitive& primitive = out.meshes[instance.mesh].primitives[posed.primitive];
        primitive.positions = posed.positions;
        primitive.normals = posed.normals;
        primitive.tangents = posed.tangents;
        primitive.bounds = posed.bounds;
    }
    for (Mesh& mesh : out.meshes)
        for (Primitive& primitive : mesh.primitives) {
            primitive.targets.clear();
            primitive.joints.clear();
            primitive.weights.clear();
        }
    return out;
}

Scene posablePart(const Scene& scene) {
    Scene out;
    out.origin = scene.origin;
    out.nodes = scene.nodes;
    out.skins = scene.skins;
    out.animations = scene.animations;
    out.instances = scene.instances;
    out.lights = scene.lights;
    out.cameras = scene.cameras;
    out.meshes.resize(scene.meshes.size());
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        out.meshes[m].weights = scene.meshes[m].weights;
        out.meshes[m].primitives.resize(scene.meshes[m].primitives.size());
    }
    for (const Instance& instance : scene.instances)
        for (std::size_t p = 0; p < scene.meshes[instance.mesh].primitives.size(); ++p) {
            const Primitive& from = scene.meshes[instance.mesh].primitives[p];
            Primitive& to = out.meshes[instance.mesh].primitives[p];
            if (!deforms(instance, from) || !to.positions.empty()) continue;
            to.positions = from.positions;
            to.normals = from.normals;
            to.tangents = from.tangents;
            to.joints = from.joints;
            to.weights = from.weights;
            to.targets = from.targets;
        }
    return out;
}

}  // namespace gnomon::renderer
