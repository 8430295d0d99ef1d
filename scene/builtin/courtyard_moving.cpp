// Nodes, skins and animations of what moves in the courtyard. Everything repeats after kLoopSeconds. The rest of every
// node is its pose at time 0, and vertices of skinned meshes stand in world space at that pose.

#include "scene/builtin/courtyard_figure.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::renderer::courtyard {
namespace {

glm::mat4 localOf(const Node& node) {
    return glm::scale(
        glm::translate(glm::mat4(1.0f), glm::vec3(node.translation)) * glm::mat4_cast(glm::quat(node.rotation)),
        glm::vec3(node.scale));
}

AnimationChannel channelOf(std::uint32_t node, AnimationChannel::Path path, int keys) {
    AnimationChannel channel;
    channel.node = node;
    channel.path = path;
    for (int i = 0; i <= keys; ++i)
        channel.times.push_back(kLoopSeconds * static_cast<float>(i) / static_cast<float>(keys));
    return channel;
}

// Time 1 is time 0 to the bit.
float keyTime(int i, int keys) {
    return static_cast<float>(i % keys) / static_cast<float>(keys);
}

void addChannel(Scene& scene, AnimationChannel channel) {
    if (scene.animations.empty()) scene.animations.push_back({"courtyard", kLoopSeconds, {}});
    scene.animations.front().channels.push_back(std::move(channel));
}

// Triangles that skinning folded so far that a vertex' normal leaves their side get vertices of their own.
void mendNormals(Primitive& p) {
    for (std::size_t i = 0; i < p.indices.size(); i += 3) {
        const glm::vec3 a = p.positions[p.indices[i]], b = p.positions[p.indices[i + 1]];
        const glm::vec3 face = glm::normalize(glm::cross(b - a, p.positions[p.indices[i + 2]] - a));
        for (std::size_t k = i; k < i + 3; ++k) {
            const std::uint32_t v = p.indices[k];
            if (glm::dot(face, p.normals[v]) > 0.25f) continue;
            p.indices[k] = static_cast<std::uint32_t>(p.positions.size());
            p.positions.push_back(glm::vec3(p.positions[v]));
            p.normals.push_back(glm::normalize(face + 0.5f * p.normals[v]));
            p.texcoords[0].push_back(glm::vec2(p.texcoords[0][v]));
            p.joints.push_back(glm::u16vec4(p.joints[v]));
            p.weights.push_back(glm::vec4(p.weights[v]));
        }
    }
}

}  // namespace

std::uint32_t addNode(Scene& scene, std::string name, std::uint32_t parent, const glm::vec3& translation,
                      const glm::quat& rotation, float scale) {
    scene.nodes.push_back({std::move(name), parent, translation, glm::dquat(rotation), glm::dvec3(scale)});
    return static_cast<std::uint32_t>(scene.nodes.size() - 1);
}

glm::mat4 worldFromNode(const Scene& scene, std::uint32_t node) {
    glm::mat4 world(1.0f);
    for (; node != kNone; node = scene.nodes[node].parent) world = localOf(scene.nodes[node]) * world;
    return world;
}

void placeOn(SceneBuilder& builder, std::uint32_t node, std::uint32_t mesh) {
    builder.place(mesh, worldFromNode(builder.scene, node));
    builder.scene.instances.back().node = node;
}

void placeSkinned(SceneBuilder& builder, std::string name, std::vector<Primitive> primitives,
                  const std::vector<std::uint32_t>& joints, const std::vector<glm::mat4>& jointFromFigure) {
    Scene& scene = builder.scene;
    Skin skin{name, joints, {}};
    std::vector<glm::mat4> worldFromFigure;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const glm::mat4 world = worldFromNode(scene, joints[j]);
        skin.jointFromMesh.push_back(glm::inverse(world));
        worldFromFigure.push_back(world * jointFromFigure[j]);
    }
    for (Primitive& p : primitives) {
        p.bounds = {};
        for (std::size_t v = 0; v < p.positions.size(); ++v) {
            glm::mat4 blend(0.0f);
            for (int k = 0; k < 4; ++k) blend += p.weights[v][k] * worldFromFigure[p.joints[v][k]];
            p.positions[v] = glm::vec3(blend * glm::vec4(p.positions[v], 1.0f));
            p.normals[v] = glm::normalize(glm::mat3(blend) * p.normals[v]);
        }
        mendNormals(p);
        for (const std::uint32_t index : p.indices) p.bounds.add(p.positions[index]);
    }
    builder.place(builder.mesh(std::move(name), std::move(primitives)), glm::mat4(1.0f));
    scene.skins.push_back(std::move(skin));
    scene.instances.back().skin = static_cast<std::uint32_t>(scene.skins.size() - 1);
}

void animatePlace(Scene& scene, std::uint32_t node, int keys, const std::function<glm::vec3(float)>& translation) {
    AnimationChannel channel = channelOf(node, AnimationChannel::Path::Translation, keys);
    for (int i = 0; i <= keys; ++i) {
        const glm::vec3 at = translation(keyTime(i, keys));
        channel.values.insert(channel.values.end(), {at.x, at.y, at.z});
    }
    addChannel(scene, std::move(channel));
}

void animateTurn(Scene& scene, std::uint32_t node, int keys, const std::function<glm::quat(float)>& rotation) {
    AnimationChannel channel = channelOf(node, AnimationChannel::Path::Rotation, keys);
    glm::quat before = rotation(0.0f);
    for (int i = 0; i <= keys; ++i) {
        glm::quat turn = rotation(keyTime(i, keys));
        if (glm::dot(turn, before) < 0.0f) turn = -turn;  // the shorter way
        channel.values.insert(channel.values.end(), {turn.x, turn.y, turn.z, turn.w});
        before = turn;
    }
    addChannel(scene, std::move(channel));
}

std::uint32_t addFigure(Parts& parts, const std::string& name, const Look& look, int keys, const PoseAt& poseAt) {
    Scene& scene = parts.builder.scene;
    const Pose rest = poseAt(0.0f), bind;
    const auto first = static_cast<std::uint32_t>(scene.nodes.size());
    std::vector<std::uint32_t> joints;
    std::vector<glm::mat4> jointFromFigure;
    for (std::uint32_t j = 0; j < kJointCount; ++j) {
        addNode(scene, name, j == kRoot ? kNone : first + parentOf(j), rest.translation[j], rest.rotation[j],
                j == kRoot ? look.scale : 1.0f);
        if (j == kProp) continue;
        joints.push_back(first + j);
        jointFromFigure.push_back(glm::inverse(bind.figureFromJoint(j)));
    }
    placeSkinned(parts.builder, name, figureBody(look), joints, jointFromFigure);

    std::vector<Pose> poses;
    for (int i = 0; i < keys; ++i) poses.push_back(poseAt(keyTime(i, keys)));
    const auto poseOf = [&](float at) -> const Pose& {
        return poses[static_cast<std::size_t>(std::lround(at * static_cast<float>(keys))) % poses.size()];
    };
    for (std::uint32_t j = 0; j < kJointCount; ++j) {
        bool moves = false, turns = false;
        for (const Pose& pose : poses) {
            moves = moves || glm::length(pose.translation[j] - rest.translation[j]) > 1e-5f;
            turns = turns || std::abs(glm::dot(pose.rotation[j], rest.rotation[j])) < 1.0f - 1e-6f;
        }
        if (moves)
            animatePlace(scene, first + j, keys, [&](float at) -> glm::vec3 { return poseOf(at).translation[j]; });
        if (turns) animateTurn(scene, first + j, keys, [&](float at) -> glm::quat { return poseOf(at).rotation[j]; });
    }
    return first;
}

}  // namespace gnomon::renderer::courtyard
