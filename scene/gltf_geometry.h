#pragma once
// One glTF primitive into one indexed triangle list.

#include <optional>
#include <string>

#include "scene/gltf_document.h"
#include "scene/scene.h"

namespace gnomon::renderer::gltf {

/// Nothing (and a note) for points, lines and primitives without a whole triangle; a refusal for broken ones. The
/// material is left to the caller.
std::optional<Primitive> loadPrimitive(Document& document, const tinygltf::Primitive& source, const std::string& user);

}  // namespace gnomon::renderer::gltf
