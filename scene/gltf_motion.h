#pragma once
// Nodes, skins and animations: only what moves or deforms something that is drawn ends up in the scene.

#include <map>
#include <string>
#include <vector>

#include "scene/gltf_nodes.h"
#include "scene/scene.h"

namespace gnomon::renderer::gltf {

class MotionLoader {
public:
    /// `placed`: the nodes that are drawn. They must outlive the loader's construction only.
    MotionLoader(Document& document, const std::vector<PlacedNode>& placed, Scene& scene);

    /// True where a channel of an animation moves the node or one above it.
    [[nodiscard]] bool canMove(int node) const { return canMove_[static_cast<std::size_t>(node)]; }
    /// True where a channel changes the weights of the node's morph targets.
    [[nodiscard]] bool hasWeightChannel(int node) const { return weightChannel_[static_cast<std::size_t>(node)]; }
    /// Index in Scene::nodes; the node and those above it are added on first use.
    std::uint32_t use(int node, std::string_view user);
    /// kNone where nothing moves the node.
    std::uint32_t useIfMoving(int node, std::string_view user) { return canMove(node) ? use(node, user) : kNone; }
    /// Index in Scene::skins.
    std::uint32_t useSkin(int skin, const std::string& user);
    /// The node carries a mesh with so many morph targets.
    void expectWeights(int node, std::size_t targets) { targetsOfNode_[node] = targets; }

    /// After everything is in use: the channels that move it.
    void loadAnimations();

private:
    void findMovers(const std::vector<PlacedNode>& placed);
    bool loadChannel(const AnimationSource& source, const AnimationSource::Channel& channel, const std::string& user,
                     Animation& animation);
    void readTimes(int accessor, const std::string& user, std::vector<float>& times);
    void readValues(int accessor, std::size_t width, const std::string& user, AnimationChannel& channel);

    Document& document_;
    Scene& scene_;
    std::vector<int> parents_;
    std::vector<char> canMove_, weightChannel_;
    std::map<int, std::uint32_t> nodeSlots_, skinSlots_;
    std::map<int, std::size_t> targetsOfNode_;
};

}  // namespace gnomon::renderer::gltf
