#include "scene/gltf_motion.h"

#include <algorithm>
#include <optional>

#include "scene/gltf_accessor.h"
#include "scene/play_animation.h"

namespace gnomon::renderer::gltf {
namespace {

constexpr float kMaxValue = 1.0e15f;  // as of positions

std::optional<AnimationChannel::Path> pathOf(const std::string& name) {
    if (name == "translation") return AnimationChannel::Path::Translation;
    if (name == "rotation") return AnimationChannel::Path::Rotation;
    if (name == "scale") return AnimationChannel::Path::Scale;
    if (name == "weights") return AnimationChannel::Path::Weights;
    return std::nullopt;
}

AnimationChannel::Interpolation interpolationOf(const std::string& name, const std::string& user) {
    if (name.empty() || name == "LINEAR") return AnimationChannel::Interpolation::Linear;
    if (name == "STEP") return AnimationChannel::Interpolation::Step;
    if (name == "CUBICSPLINE") return AnimationChannel::Interpolation::CubicSpline;
    refuse("{} has the unknown interpolation '{}'", user, name.substr(0, 40));
}

// They are made unit where they are sampled, in double.
void checkRotations(const AnimationChannel& channel, const std::string& user) {
    const bool spline = channel.interpolation == AnimationChannel::Interpolation::CubicSpline;
    for (std::size_t k = 0; k < channel.times.size(); ++k) {
        const float* q = channel.values.data() + (spline ? 3 * k + 1 : k) * 4;
        if (!(glm::length(glm::vec4(q[0], q[1], q[2], q[3])) > 1.0e-6f))
            refuse("{} has a rotation that is no quaternion", user);
    }
}

}  // namespace

MotionLoader::MotionLoader(Document& document, const std::vector<PlacedNode>& placed, Scene& scene)
    : document_(document), scene_(scene), parents_(parentsOf(document, placed)) {
    findMovers(placed);
}

void MotionLoader::findMovers(const std::vector<PlacedNode>& placed) {
    const std::size_t count = document_.model().nodes.size();
    canMove_.assign(count, 0);
    weightChannel_.assign(count, 0);
    for (const AnimationSource& animation : document_.animations())
        for (const AnimationSource::Channel& channel : animation.channels) {
            if (channel.node < 0 || static_cast<std::size_t>(channel.node) >= count) continue;
            const auto path = pathOf(channel.path);
            if (path == AnimationChannel::Path::Weights)
                weightChannel_[static_cast<std::size_t>(channel.node)] = 1;
            else if (path)
                canMove_[static_cast<std::size_t>(channel.node)] = 1;
        }
    for (const PlacedNode& node : placed) {  // parents come first
        const int parent = parents_[static_cast<std::size_t>(node.index)];
        if (parent >= 0 && canMove_[static_cast<std::size_t>(parent)] != 0)
            canMove_[static_cast<std::size_t>(node.index)] = 1;
    }
}

std::uint32_t MotionLoader::use(int node, std::string_view user) {
    const auto& nodes = document_.model().nodes;
    at(nodes, node, "node", user);
    std::vector<int> missing;  // the node and those above it that the scene lacks
    int top = node;
    for (; top != -1 && !nodeSlots_.contains(top); top = parents_[static_cast<std::size_t>(top)]) {
        missing.push_back(top);
        if (missing.size() > nodes.size()) refuse("{} lies on a loop of nodes", nodeName(document_, node));
    }
    std::uint32_t parent = top == -1 ? kNone : nodeSlots_.at(top);
    for (auto current = missing.rbegin(); current != missing.rend(); ++current) {
        const tinygltf::Node& source = nodes[static_cast<std::size_t>(*current)];
        Node made = readNode(source, nodeName(document_, *current));
        made.name = source.name;
        made.parent = parent;
        parent = static_cast<std::uint32_t>(scene_.nodes.size());
        scene_.nodes.push_back(std::move(made));
        nodeSlots_.emplace(*current, parent);
    }
    return parent;
}

std::uint32_t MotionLoader::useSkin(int skin, const std::string& user) {
    if (const auto known = skinSlots_.find(skin); known != skinSlots_.end()) return known->second;
    const tinygltf::Skin& source = at(document_.model().skins, skin, "skin", user);
    if (source.joints.empty()) refuse("skin {}, which {} uses, has no joints", skin, user);
    Skin made;
    made.name = source.name;
    made.jointFromMesh.assign(source.joints.size(), glm::mat4(1.0f));
    if (source.inverseBindMatrices != -1) {
        const std::string name = fmt::format("the inverse bind matrices of skin {}", skin);
        auto read = readMatrices(document_, source.inverseBindMatrices, name);
        if (read.size() < source.joints.size())
            refuse("{} are {} for {} joints", name, read.size(), source.joints.size());
        read.resize(source.joints.size());
        for (const glm::mat4& m : read)
            for (int i = 0; i < 16; ++i)
                if (!(std::abs(m[i / 4][i % 4]) < kMaxValue)) refuse("{} hold a number beyond {:g}", name, kMaxValue);
        made.jointFromMesh = std::move(read);
    }
    const std::string name = fmt::format("skin {}", skin);
    for (int joint : source.joints) made.joints.push_back(use(joint, name));
    scene_.skins.push_back(std::move(made));
    return skinSlots_.emplace(skin, static_cast<std::uint32_t>(scene_.skins.size() - 1)).first->second;
}

void MotionLoader::readTimes(int accessor, const std::string& user, std::vector<float>& times) {
    const std::string name = "the times of " + user;
    const Elements elements = openAccessor(document_, accessor, name);
    if (elements.components != 1) refuse("{} have {} components", name, elements.components);
    document_.spendMotionNumbers(elements.count);
    times.resize(elements.count);
    for (std::size_t i = 0; i < times.size(); ++i) {
        times[i] = elements.value(i, 0);
        const float before = i == 0 ? 0.0f : times[i - 1];
        if (!(times[i] >= 0.0f) || !std::isfinite(times[i])) refuse("{} hold {}", name, times[i]);
        if (i > 0 && !(times[i] > before)) refuse("{} do not ascend: {} follows {}", name, times[i], before);
    }
}

void MotionLoader::readValues(int accessor, std::size_t width, const std::string& user, AnimationChannel& channel) {
    const std::string name = "the values of " + user;
    const bool weights = channel.path == AnimationChannel::Path::Weights;
    const std::size_t components = weights ? 1 : width;
    const std::size_t perKey = channel.interpolation == AnimationChannel::Interpolation::CubicSpline ? 3 : 1;
    const Elements elements = openAccessor(document_, accessor, name);
    if (elements.components != components)
        refuse("{} have {} components, not {}", name, elements.components, components);
    // Divided, so that nothing overflows.
    const std::size_t perTime = perKey * (width / components);
    if (elements.count / perTime != channel.times.size() || elements.count % perTime != 0)
        refuse("{} are {} for {} times, {} each", name, elements.count, channel.times.size(), perTime);
    document_.spendMotionNumbers(elements.count * components);
    channel.values.resize(elements.count * components);
    for (std::size_t i = 0; i < channel.values.size(); ++i) {
        const float value = elements.value(i / components, i % components);
        if (!(std::abs(value) < kMaxValue))
            refuse("{} hold a number that is not finite or beyond {:g}", name, kMaxValue);
        channel.values[i] = value;
    }
    if (channel.path == AnimationChannel::Path::Rotation) checkRotations(channel, user);
}

// False where it moves nothing that is drawn: such a channel is not even looked at.
bool MotionLoader::loadChannel(const AnimationSource& source, const AnimationSource::Channel& from,
                               const std::string& user, Animation& animation) {
    const auto path = pathOf(from.path);
    const auto node = nodeSlots_.find(from.node);
    if (!path && from.node >= 0)
        document_.note(fmt::format("Channels for '{}' are not played.", from.path.substr(0, 40)));
    if (!path || node == nodeSlots_.end()) return false;
    AnimationChannel channel;
    channel.node = node->second;
    channel.path = *path;
    std::size_t width = *path == AnimationChannel::Path::Rotation ? 4 : 3;
    if (*path == AnimationChannel::Path::Weights) {
        const auto targets = targetsOfNode_.find(from.node);
        if (targets == targetsOfNode_.end()) return false;
        width = targets->second;
    } else if (scene_.nodes[channel.node].matrix) {
        document_.note(fmt::format("{} has a matrix, so it cannot be animated.", nodeName(document_, from.node)));
        return false;
    }
    const AnimationSource::Sampler& sampler = at(source.samplers, from.sampler, "sampler", user);
    channel.interpolation = interpolationOf(sampler.interpolation, user);
    readTimes(sampler.input, user, channel.times);
    readValues(sampler.output, width, user, channel);
    animation.durationSeconds = std::max(animation.durationSeconds, channel.times.back());
    animation.channels.push_back(std::move(channel));
    return true;
}

void MotionLoader::loadAnimations() {
    const std::vector<AnimationSource>& sources = document_.animations();
    for (std::size_t a = 0; a < sources.size(); ++a) {
        Animation animation;
        animation.name = sources[a].name;
        for (std::size_t c = 0; c < sources[a].channels.size(); ++c) {
            const std::string user =
                fmt::format("channel {} of animation {} '{}'", c, a, sources[a].name.substr(0, 60));
            loadChannel(sources[a], sources[a].channels[c], user, animation);
        }
        if (!animation.channels.empty()) scene_.animations.push_back(std::move(animation));
    }
    playCompatible(scene_, 0);
    const auto waiting = std::count_if(scene_.animations.begin(), scene_.animations.end(),
                                       [](const Animation& a) { return !a.playing; });
    if (waiting > 0)
        document_.note(fmt::format("Of {} animations {} move what an earlier one moves; they are played on demand.",
                                   scene_.animations.size(), waiting));
}

}  // namespace gnomon::renderer::gltf
