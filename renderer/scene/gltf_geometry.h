#pragma once
// One glTF primitive into one indexed triangle list.

#include <glm/gtc/type_precision.hpp>
#include <optional>
#include <string>
#include <vector>

#include "renderer/scene/gltf_document.h"
#include "renderer/scene/scene.h"

namespace gnomon::renderer::gltf {

struct LoadedPrimitive {
    Primitive primitive;
    std::vector<glm::u16vec4> joints;  // empty, or one per vertex
    std::vector<glm::vec4> weights;    // same length as joints; each sums to one
};

/// Nothing (and a note) for points, lines and primitives without a whole triangle; a refusal for broken ones. The
/// material is left to the caller.
std::optional<LoadedPrimitive> loadPrimitive(Document& document, const tinygltf::Primitive& source,
                                             const std::string& user);

/// Sets primitive.bounds from the positions that the indices use.
void computeBounds(Primitive& primitive);

}  // namespace gnomon::renderer::gltf
