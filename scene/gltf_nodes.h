#pragma once
// The node hierarchy: transforms, and which nodes the chosen scene draws. No step recurses, and no node is reached
// twice.

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "scene/gltf_document.h"
#include "scene/scene.h"

namespace gnomon::renderer::gltf {

struct PlacedNode {
    int index = 0;
    glm::dmat4 worldFromNode{1.0};  ///< in the file's coordinates, whatever Scene::origin will be
};

/// "node 3 'Wheel'"
std::string nodeName(const Document& document, int index);

/// Nodes of the default scene in depth-first order. Without scenes, all roots; refuses loops and nodes with two
/// parents.
std::vector<PlacedNode> placeNodes(Document& document);

/// Per node its parent or -1. Where two claim a node, the one that is drawn has it.
std::vector<int> parentsOf(const Document& document, const std::vector<PlacedNode>& placed);

/// A node's own transform, checked; name, parent and weights are left to the caller.
Node readNode(const tinygltf::Node& node, const std::string& user);

}  // namespace gnomon::renderer::gltf
