#include "scene/gltf_draco.h"

#include <draco/compression/decode.h>
#include <draco/core/decoder_buffer.h>
#include <draco/mesh/mesh.h>

#include <algorithm>

namespace gnomon::renderer::gltf {

DracoPrimitive::DracoPrimitive(Document& document, const tinygltf::Value& extension, std::string_view user) {
    const auto bytes = document.view(integer(extension, "bufferView", -1, user), user).bytes;
    const tinygltf::Value* attributes = member(extension, "attributes");
    if (!attributes || !attributes->IsObject()) refuse("the Draco extension of {} names no attributes", user);
    for (const std::string& name : attributes->Keys())
        attributeIds_.emplace_back(name, integer(*attributes, name.c_str(), -1, user));

    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) refuse("the Draco data of {} cannot be decoded: {}", user, decoded.status().error_msg_string());
    mesh_ = std::move(decoded).value();
    if (!mesh_ || mesh_->num_points() == 0 || mesh_->num_faces() == 0)
        refuse("the Draco data of {} holds no triangles", user);
    for (const auto& [name, id] : attributeIds_)
        if (id < 0 || !mesh_->GetAttributeByUniqueId(static_cast<std::uint32_t>(id)))
            refuse("the Draco data of {} lacks the attribute {} ({})", user, name, id);
}

DracoPrimitive::~DracoPrimitive() = default;

std::size_t DracoPrimitive::vertexCount() const {
    return mesh_->num_points();
}

std::vector<std::uint32_t> DracoPrimitive::indices() const {
    std::vector<std::uint32_t> out;
    out.reserve(std::size_t(mesh_->num_faces()) * 3);
    for (draco::FaceIndex face(0); face < mesh_->num_faces(); ++face)
        for (const draco::PointIndex& corner : mesh_->face(face)) out.push_back(corner.value());
    return out;
}

bool DracoPrimitive::has(const std::string& attribute) const {
    return std::any_of(attributeIds_.begin(), attributeIds_.end(),
                       [&](const auto& entry) { return entry.first == attribute; });
}

std::vector<float> DracoPrimitive::read(const std::string& attribute, int components, float fill,
                                        std::string_view user) const {
    const auto entry =
        std::find_if(attributeIds_.begin(), attributeIds_.end(), [&](const auto& e) { return e.first == attribute; });
    const draco::PointAttribute* source = mesh_->GetAttributeByUniqueId(static_cast<std::uint32_t>(entry->second));
    const int present = std::min<int>(components, source->num_components());
    std::vector<float> out(vertexCount() * static_cast<std::size_t>(components), fill);
    for (draco::PointIndex point(0); point < mesh_->num_points(); ++point) {
        const draco::AttributeValueIndex value = source->mapped_index(point);
        float* target = out.data() + std::size_t(point.value()) * static_cast<std::size_t>(components);
        if (value.value() >= source->size() ||
            !source->ConvertValue<float>(value, static_cast<std::int8_t>(present), target))
            refuse("the attribute {} of {} cannot be read from its Draco data", attribute, user);
    }
    return out;
}

}  // namespace gnomon::renderer::gltf
