#pragma once
// Scenes made by code: the courtyard of the README, and small scenes for tests.
// Everything here is deterministic: the same arguments give the same scene.

#include "scene/scene.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon::renderer {

struct BuiltinInfo {
    std::string name;
    std::string description;  // one line
};

// What `seed` and `lightCount` mean to a scene stands in its description; 0 lights: the scene's own number.
struct BuiltinOptions {
    std::uint64_t seed = 1;
    std::uint32_t lightCount = 0;  // `columns` only: how many lights stand between the columns
};

// All built-in scenes, in the order in which they are listed to people.
std::vector<BuiltinInfo> builtinScenes();

// Empty for a name that builtinScenes() does not list.
std::optional<Scene> makeBuiltinScene(std::string_view name, const BuiltinOptions& options = {});

}  // namespace gnomon::renderer
