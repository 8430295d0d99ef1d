#pragma once
// The types of what the loader reads: a wrong one is refused by name, because tinygltf would put a default in its
// place.

#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace gnomon::renderer::gltf {

/// "materials[2].alphaMode is "mask", not ...": the value is cut short where it is long.
[[noreturn]] void refuseValue(std::string_view path, const nlohmann::json& value, std::string_view expected);

/// Refuses files of another version than glTF 2.x, whatever else they hold.
void checkVersion(const nlohmann::json& root);

/// Refuses the first property of a wrong type, count or word. Looks at what the loader reads, drawn or not, in the core
/// format, in the extensions that it knows and in `extras`. Properties that are absent or that it does not read are
/// left alone, and so are indices that point nowhere.
void checkTypes(const nlohmann::json& root);

}  // namespace gnomon::renderer::gltf
