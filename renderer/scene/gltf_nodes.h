#pragma once
// The node hierarchy: transforms, and which nodes the chosen scene draws. No step recurses, and no node is reached
// twice.

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "renderer/scene/gltf_document.h"

namespace gnomon::renderer::gltf {

struct PlacedNode {
    int index = 0;
    glm::mat4 worldFromNode{1.0f};
};

/// "node 3 'Wheel'"
std::string nodeName(const Document& document, int index);

/// Nodes of the default scene in depth-first order. Without scenes, all roots; refuses loops and nodes with two
/// parents.
std::vector<PlacedNode> placeNodes(Document& document);

/// World transforms of any nodes, inside the scene or not, for joints; refuses loops.
class NodeTransforms {
public:
    explicit NodeTransforms(Document& document);
    glm::mat4 worldFromNode(int index, std::string_view user) const;

private:
    Document& document_;
    std::vector<int> parents_;
};

}  // namespace gnomon::renderer::gltf
