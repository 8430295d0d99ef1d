#pragma once
// glTF 2.0 (.gltf and .glb) into a Scene. docs/scenes.md lists what is read, what is left out and what is refused.

#include <filesystem>

#include "gnomon/result.h"
#include "scene/scene.h"

namespace gnomon::renderer {

/// Loads a glTF 2.0 file. On failure `out` is unchanged and the message is one sentence that names the file and its
/// fault. Nothing in a file is trusted: every index, range and size is checked before use, and no memory is taken on a
/// file's word alone. Lights keep what the file gives; completeLights() fills in ranges and source sizes.
/// Thread safe on different `out`; uses several threads for decoding images. Never touches the network.
Result loadGltf(const std::filesystem::path& path, Scene& out);

}  // namespace gnomon::renderer
