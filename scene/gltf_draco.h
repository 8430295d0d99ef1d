#pragma once
// KHR_draco_mesh_compression: one compressed primitive. The only file that sees Draco's headers is gltf_draco.cpp.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scene/gltf_document.h"

namespace draco {
class Mesh;
}

namespace gnomon::renderer::gltf {

class DracoPrimitive {
public:
    /// Decodes the extension's bufferView; refuses what Draco cannot read.
    DracoPrimitive(Document& document, const tinygltf::Value& extension, std::string_view user);
    ~DracoPrimitive();
    DracoPrimitive(const DracoPrimitive&) = delete;
    DracoPrimitive& operator=(const DracoPrimitive&) = delete;

    std::size_t vertexCount() const;
    std::vector<std::uint32_t> indices() const;
    bool has(const std::string& attribute) const;
    /// `components` floats per vertex; components that the attribute lacks keep `fill`.
    std::vector<float> read(const std::string& attribute, int components, float fill, std::string_view user) const;

private:
    std::unique_ptr<draco::Mesh> mesh_;
    std::vector<std::pair<std::string, int>> attributeIds_;
};

}  // namespace gnomon::renderer::gltf
