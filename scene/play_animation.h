#pragma once
// Which of a scene's animations play. Two that move the same thing are alternatives: one of them stands by.

#include <string_view>

#include "scene/scene.h"

namespace gnomon::renderer {

/// Lets the animation `first` play, and of the others, in their order, each that moves nothing that is already moved.
void playCompatible(Scene& scene, std::size_t first);

/// "default", "none" (everything is at rest), or the name or #index of an animation that is to play, with whatever goes
/// along with it. Changes the scene on success only.
Result playAnimation(Scene& scene, std::string_view text);

}  // namespace gnomon::renderer
