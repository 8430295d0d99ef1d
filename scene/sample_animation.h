#pragma once
// Values of an animation's channel between its key frames. Keys are floats, as files have them. What lies between is
// computed in double: what turns or moves far from its parent's origin shall not jump from float to float.

#include <span>

#include "scene/animation.h"

namespace gnomon::renderer {

/// Numbers of one key frame's value: 3, 4, or for weights what the channel holds.
[[nodiscard]] std::size_t channelWidth(const AnimationChannel& channel);
/// Writes channelWidth() numbers for `seconds`, clamped to the channel's own times. Rotations come out unit, x y z w.
void sampleChannel(const AnimationChannel& channel, double seconds, std::span<double> out);
/// Where an animation stands that is played in a loop: within [0, its duration).
[[nodiscard]] double loopedTime(const Animation& animation, double seconds);

}  // namespace gnomon::renderer
