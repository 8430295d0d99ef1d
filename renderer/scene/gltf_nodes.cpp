#include "renderer/scene/gltf_nodes.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

namespace gnomon::renderer::gltf {
namespace {

glm::vec3 vector3(const std::vector<double>& numbers, glm::vec3 otherwise, const char* what, const std::string& user) {
    if (numbers.empty()) return otherwise;
    if (numbers.size() != 3) refuse("the {} of {} has {} numbers", what, user, numbers.size());
    return {toFloat(numbers[0], user), toFloat(numbers[1], user), toFloat(numbers[2], user)};
}

glm::mat4 localTransform(const tinygltf::Node& node, const std::string& user) {
    if (!node.matrix.empty()) {
        if (node.matrix.size() != 16) refuse("the matrix of {} has {} numbers", user, node.matrix.size());
        glm::mat4 matrix;
        for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = toFloat(node.matrix[static_cast<std::size_t>(i)], user);
        if (matrix[0].w != 0.0f || matrix[1].w != 0.0f || matrix[2].w != 0.0f || matrix[3].w != 1.0f)
            refuse("the matrix of {} is not affine", user);
        return matrix;
    }
    glm::quat rotation(1.0f, 0.0f, 0.0f, 0.0f);
    if (!node.rotation.empty()) {
        if (node.rotation.size() != 4) refuse("the rotation of {} has {} numbers", user, node.rotation.size());
        const glm::vec4 q(toFloat(node.rotation[0], user), toFloat(node.rotation[1], user),
                          toFloat(node.rotation[2], user), toFloat(node.rotation[3], user));
        const float length = glm::length(q);
        if (!(length > 1.0e-6f) || !std::isfinite(length)) refuse("the rotation of {} is no quaternion", user);
        rotation = glm::quat(q.w / length, q.x / length, q.y / length, q.z / length);
    }
    const glm::vec3 translation = vector3(node.translation, glm::vec3(0.0f), "translation", user);
    const glm::vec3 scale = vector3(node.scale, glm::vec3(1.0f), "scale", user);
    return glm::translate(glm::mat4(1.0f), translation) * glm::mat4_cast(rotation) * glm::scale(glm::mat4(1.0f), scale);
}

void checkFinite(const glm::mat4& matrix, const std::string& user) {
    for (int i = 0; i < 16; ++i)
        if (!(std::abs(matrix[i / 4][i % 4]) < 1.0e30f))
            refuse("the transform of {} leaves the range of a float", user);
}

std::vector<int> sceneRoots(Document& document) {
    const tinygltf::Model& model = document.model();
    if (!model.scenes.empty())
        return at(model.scenes, model.defaultScene == -1 ? 0 : model.defaultScene, "scene", "the file").nodes;
    if (model.defaultScene != -1)
        refuse("the file's default scene is {}, but the file has no scenes", model.defaultScene);
    std::vector<bool> isChild(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes)
        for (int child : node.children)
            if (child >= 0 && static_cast<std::size_t>(child) < isChild.size())
                isChild[static_cast<std::size_t>(child)] = true;
    std::vector<int> roots;
    for (std::size_t i = 0; i < isChild.size(); ++i)
        if (!isChild[i]) roots.push_back(static_cast<int>(i));
    if (roots.empty() && !isChild.empty()) refuse("every node is the child of another, so the nodes form a loop");
    document.note("The file has no scene; all of its root nodes are drawn.");
    return roots;
}

}  // namespace

std::string nodeName(const Document& document, int index) {
    const auto& nodes = document.model().nodes;
    if (index < 0 || static_cast<std::size_t>(index) >= nodes.size()) return fmt::format("node {}", index);
    return fmt::format("node {} '{}'", index, nodes[static_cast<std::size_t>(index)].name.substr(0, 60));
}

std::vector<PlacedNode> placeNodes(Document& document) {
    const auto& nodes = document.model().nodes;
    std::vector<bool> reached(nodes.size(), false);
    std::vector<PlacedNode> placed, pending;
    const auto push = [&](int index, const glm::mat4& worldFromParent, const std::string& user) {
        const tinygltf::Node& node = at(nodes, index, "node", user);
        const std::string name = nodeName(document, index);
        if (reached[static_cast<std::size_t>(index)])
            refuse("{} is reached twice, from {} and earlier: the nodes must form a tree", name, user);
        reached[static_cast<std::size_t>(index)] = true;
        const glm::mat4 world = worldFromParent * localTransform(node, name);
        checkFinite(world, name);
        pending.push_back({index, world});
    };
    std::vector<int> roots = sceneRoots(document);
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) push(*root, glm::mat4(1.0f), "the scene");
    while (!pending.empty()) {
        const PlacedNode current = pending.back();
        pending.pop_back();
        placed.push_back(current);
        const auto& children = nodes[static_cast<std::size_t>(current.index)].children;
        for (auto child = children.rbegin(); child != children.rend(); ++child)
            push(*child, current.worldFromNode, nodeName(document, current.index));
    }
    return placed;
}

NodeTransforms::NodeTransforms(Document& document) : document_(document), parents_(document.model().nodes.size(), -1) {
    const auto& nodes = document.model().nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (int child : nodes[i].children)
            if (child >= 0 && static_cast<std::size_t>(child) < parents_.size())
                parents_[static_cast<std::size_t>(child)] = static_cast<int>(i);
}

glm::mat4 NodeTransforms::worldFromNode(int index, std::string_view user) const {
    const auto& nodes = document_.model().nodes;
    at(nodes, index, "node", user);
    glm::mat4 world(1.0f);
    std::size_t steps = 0;
    for (int current = index; current != -1; current = parents_[static_cast<std::size_t>(current)]) {
        if (++steps > nodes.size()) refuse("{} lies on a loop of nodes", nodeName(document_, index));
        world = localTransform(nodes[static_cast<std::size_t>(current)], nodeName(document_, current)) * world;
    }
    checkFinite(world, nodeName(document_, index));
    return world;
}

}  // namespace gnomon::renderer::gltf
