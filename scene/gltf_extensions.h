#pragma once
// Extensions by name: which are read, and what a picture lacks without the others.

#include <string>

namespace gnomon::renderer::gltf {

/// True where a file may require the extension: it is read, or the core format beneath is a fair picture of it.
bool isAccepted(const std::string& extension);

/// One sentence that says what drawing without the extension costs; empty when nothing is lost.
std::string costOf(const std::string& extension);

}  // namespace gnomon::renderer::gltf
