#include "scene/gltf_nodes.h"

#include <glm/gtc/quaternion.hpp>

#include "scene/pose.h"

namespace gnomon::renderer::gltf {
namespace {

glm::dvec3 vector3(const std::vector<double>& numbers, glm::dvec3 otherwise, const char* what,
                   const std::string& user) {
    if (numbers.empty()) return otherwise;
    if (numbers.size() != 3) refuse("the {} of {} has {} numbers", what, user, numbers.size());
    return {inFloatRange(numbers[0], user), inFloatRange(numbers[1], user), inFloatRange(numbers[2], user)};
}

// Exporters write floats: what rounds to 0 and 1 is meant so.
bool isAffine(const glm::dmat4& m) {
    const auto rounded = [](double value) { return static_cast<float>(value); };
    return rounded(m[0].w) == 0.0f && rounded(m[1].w) == 0.0f && rounded(m[2].w) == 0.0f && rounded(m[3].w) == 1.0f;
}

glm::dmat4 readMatrix(const std::vector<double>& numbers, const std::string& user) {
    if (numbers.size() != 16) refuse("the matrix of {} has {} numbers", user, numbers.size());
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = inFloatRange(numbers[static_cast<std::size_t>(i)], user);
    if (!isAffine(matrix)) refuse("the matrix of {} is not affine", user);
    matrix[0].w = matrix[1].w = matrix[2].w = 0.0;
    matrix[3].w = 1.0;
    return matrix;
}

void checkFinite(const glm::dmat4& matrix, const std::string& user) {
    for (int i = 0; i < 16; ++i)
        if (!(std::abs(matrix[i / 4][i % 4]) < 1.0e30)) refuse("the transform of {} leaves the range of a float", user);
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
    const auto push = [&](int index, const glm::dmat4& worldFromParent, const std::string& user) {
        const tinygltf::Node& node = at(nodes, index, "node", user);
        const std::string name = nodeName(document, index);
        if (reached[static_cast<std::size_t>(index)])
            refuse("{} is reached twice, from {} and earlier: the nodes must form a tree", name, user);
        reached[static_cast<std::size_t>(index)] = true;
        const glm::dmat4 world = worldFromParent * localTransform(readNode(node, name));
        checkFinite(world, name);
        pending.push_back({index, world});
    };
    std::vector<int> roots = sceneRoots(document);
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) push(*root, glm::dmat4(1.0), "the scene");
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

std::vector<int> parentsOf(const Document& document, const std::vector<PlacedNode>& placed) {
    const auto& nodes = document.model().nodes;
    std::vector<int> parents(nodes.size(), -1);
    const auto claim = [&](int parent) {
        for (int child : nodes[static_cast<std::size_t>(parent)].children)
            if (child >= 0 && static_cast<std::size_t>(child) < parents.size())
                parents[static_cast<std::size_t>(child)] = parent;
    };
    for (std::size_t i = 0; i < nodes.size(); ++i) claim(static_cast<int>(i));
    for (const PlacedNode& node : placed) parents[static_cast<std::size_t>(node.index)] = -1;
    for (const PlacedNode& node : placed) claim(node.index);
    return parents;
}

Node readNode(const tinygltf::Node& source, const std::string& user) {
    Node node;
    if (!source.matrix.empty()) {
        node.matrix = readMatrix(source.matrix, user);
        return node;
    }
    if (!source.rotation.empty()) {
        if (source.rotation.size() != 4) refuse("the rotation of {} has {} numbers", user, source.rotation.size());
        const glm::dvec4 q(inFloatRange(source.rotation[0], user), inFloatRange(source.rotation[1], user),
                           inFloatRange(source.rotation[2], user), inFloatRange(source.rotation[3], user));
        const double length = glm::length(q);
        if (!(length > 1.0e-6) || !(length < 1.0e19)) refuse("the rotation of {} is no quaternion", user);
        node.rotation = glm::dquat(q.w / length, q.x / length, q.y / length, q.z / length);
    }
    node.translation = vector3(source.translation, glm::dvec3(0.0), "translation", user);
    node.scale = vector3(source.scale, glm::dvec3(1.0), "scale", user);
    return node;
}

}  // namespace gnomon::renderer::gltf
