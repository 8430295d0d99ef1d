#pragma once
// glTF materials, textures, samplers and images into Scene::materials and Scene::images, each loaded once and on
// demand.

#include <map>
#include <tuple>

#include "scene/gltf_document.h"
#include "scene/scene.h"

namespace gnomon::renderer::gltf {

class MaterialLoader {
public:
    MaterialLoader(Document& document, Scene& scene) : document_(document), scene_(scene) {}

    /// Index in Scene::materials of a material of the file; -1 is glTF's default material.
    std::uint32_t use(int material, std::string_view user);
    /// Decodes every image asked for. Textures whose image cannot be read are dropped: their factor alone is drawn.
    void decodeImages();
    /// Says how blended materials are drawn, if there are any.
    void noteBlended();

private:
    // An image with the axes along which a mirrored copy is appended: samplers know no mirrored repeat here.
    using ImageKey = std::tuple<int, bool, bool>;

    Material load(const tinygltf::Material& source, const std::string& user);
    template <class Info>
    TextureUse texture(const Info& info, const std::string& user);
    TextureUse texture(int index, int texcoord, const tinygltf::Value* transform, const std::string& user);
    void specularGlossiness(const tinygltf::Value& source, Material& material, const std::string& user);

    Document& document_;
    Scene& scene_;
    std::map<int, std::uint32_t> slots_;
    std::map<ImageKey, std::uint32_t> imageSlots_;
};

/// Decodes PNG or JPEG into `out`, appending mirrored copies; false and the reason on failure. Thread safe.
bool decodeImage(std::span<const std::uint8_t> encoded, bool mirrorU, bool mirrorV, Image& out, std::string& reason);
/// Width times height from the header alone, or 0.
std::uint64_t imagePixels(std::span<const std::uint8_t> encoded);

}  // namespace gnomon::renderer::gltf
