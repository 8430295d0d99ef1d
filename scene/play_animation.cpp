#include "scene/play_animation.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <string>
#include <utility>

namespace gnomon::renderer {
namespace {

std::size_t animationIndex(const Scene& scene, std::string_view text) {
    const std::size_t count = scene.animations.size();
    for (std::size_t a = 0; a < count; ++a)
        if (scene.animations[a].name == text) return a;
    std::size_t index = count;
    if (!text.starts_with('#')) return count;
    const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), index);
    return error == std::errc() && end == text.data() + text.size() ? std::min(index, count) : count;
}

}  // namespace

void playCompatible(Scene& scene, std::size_t first) {
    std::set<std::pair<std::uint32_t, AnimationChannel::Path>> moved;
    const auto decide = [&](Animation& animation) {
        animation.playing =
            std::none_of(animation.channels.begin(), animation.channels.end(), [&](const AnimationChannel& c) {
                return moved.contains({c.node, c.path});
            });
        if (!animation.playing) return;
        for (const AnimationChannel& channel : animation.channels) moved.emplace(channel.node, channel.path);
    };
    if (first < scene.animations.size()) decide(scene.animations[first]);
    for (std::size_t a = 0; a < scene.animations.size(); ++a)
        if (a != first) decide(scene.animations[a]);
}

Result playAnimation(Scene& scene, std::string_view text) {
    if (text == "default") {
        playCompatible(scene, 0);
        return {};
    }
    const std::size_t index = animationIndex(scene, text);
    if (index < scene.animations.size()) {
        playCompatible(scene, index);
        return {};
    }
    if (text == "none") {
        for (Animation& animation : scene.animations) animation.playing = false;
        return {};
    }
    std::string known;
    for (std::size_t a = 0; a < std::min<std::size_t>(scene.animations.size(), 100); ++a)
        known += (a == 0 ? "" : ", ") + scene.animations[a].name.substr(0, 60);
    return Result::failure(Status::BadArgument, "There is no animation '%.60s'; the scene has %zu%s%.400s.",
                           std::string(text).c_str(), scene.animations.size(), known.empty() ? "" : ": ",
                           known.c_str());
}

}  // namespace gnomon::renderer
