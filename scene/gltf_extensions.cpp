#include "scene/gltf_extensions.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace gnomon::renderer::gltf {
namespace {

struct Extension {
    std::string_view name;
    bool accepted;          // also where a file requires it
    std::string_view cost;  // after "The extension 'X' is "; empty: nothing
};

constexpr std::string_view kImages =
    "not read: textures that have no PNG or JPEG image besides are left out, and their factors alone are drawn.";

constexpr Extension kExtensions[] = {
    // Read in full.
    {"KHR_lights_punctual", true, ""},
    {"KHR_texture_transform", true, ""},
    {"KHR_materials_emissive_strength", true, ""},
    {"KHR_mesh_quantization", true, ""},
    {"KHR_draco_mesh_compression", true, ""},
    // The core material beneath is a fair picture of them.
    {"KHR_materials_unlit", true, "not read: materials that ask to be unlit are lit."},
    {"KHR_materials_ior", true, "not read: surfaces reflect as with an index of refraction of 1.5."},
    {"KHR_materials_specular", true, "not read: the strength and colour of what dielectrics reflect are the default."},
    {"KHR_materials_clearcoat", true, "not read: clear coats are missing."},
    {"KHR_materials_sheen", true, "not read: the sheen of cloth is missing."},
    {"KHR_materials_transmission", true,
     "partly read: surfaces that it makes transparent are opaque and count as subsurface."},
    {"KHR_materials_diffuse_transmission", true,
     "partly read: surfaces that it makes translucent are opaque and count as subsurface."},
    {"KHR_materials_volume", true, "not read: bodies are opaque, without absorption or refraction inside."},
    {"KHR_materials_iridescence", true, "not read: iridescent films are missing."},
    {"KHR_materials_dispersion", true, "not read: light is not split into its colours."},
    {"KHR_materials_anisotropy", true, "not read: highlights are the same in every direction."},
    {"KHR_materials_variants", true, "not read: every mesh has its default material."},
    {"KHR_materials_pbrSpecularGlossiness", true,
     "partly read: specular colours and the texture of specular colour and glossiness are left out."},
    // What a picture lacks without them, where the file does not require them.
    {"KHR_node_visibility", false, "not read: hidden nodes are drawn."},
    {"KHR_node_hoverability", false, ""},
    {"KHR_node_selectability", false, ""},
    {"KHR_xmp", false, ""},
    {"KHR_xmp_json_ld", false, ""},
    {"EXT_mesh_gpu_instancing", false, "not read: instances are missing."},
    {"KHR_texture_basisu", false, kImages},
    {"EXT_texture_webp", false, kImages},
    {"EXT_texture_avif", false, kImages},
    {"MSFT_texture_dds", false, kImages},
    {"KHR_animation_pointer", false, "not read: what it animates, other than nodes, will stand still."},
    {"KHR_audio_emitter", false, ""},
    {"MSFT_lod", false, "not read: the finest level of detail is drawn at every distance."},
    {"EXT_lights_image_based", false, "not read: the light of its environment picture is missing."},
    {"EXT_lights_ies", false, "not read: the light of its measured lamps is missing."},
    {"EXT_meshopt_compression", false, "not read: its buffers are taken without compression."},
    {"KHR_meshopt_compression", false, "not read: its buffers are taken without compression."},
    {"KHR_gaussian_splatting", false, "not read: its splats are missing."},
    {"KHR_techniques_webgl", false, "not read: its shaders are not run, and the core material is drawn."},
    {"AGI_articulations", false, "not read: its articulations stand still."},
    {"KHR_physics_rigid_bodies", false, "not read: its bodies stand still."},
    {"EXT_structural_metadata", false, ""},
    {"EXT_mesh_features", false, ""},
};

const Extension* find(const std::string& name) {
    const auto* found = std::find_if(std::begin(kExtensions), std::end(kExtensions),
                                     [&](const Extension& known) { return known.name == name; });
    return found == std::end(kExtensions) ? nullptr : found;
}

}  // namespace

bool isAccepted(const std::string& extension) {
    const Extension* known = find(extension);
    return known != nullptr && known->accepted;
}

std::string costOf(const std::string& extension) {
    if (extension.empty()) return {};
    const Extension* known = find(extension);
    if (known != nullptr)
        return known->cost.empty() ? std::string() : fmt::format("The extension '{}' is {}", extension, known->cost);
    const bool ofMaterials = extension.find("_materials_") != std::string::npos;
    return fmt::format("The extension '{}' is not read{}.", extension.substr(0, 80),
                       ofMaterials ? ": the core material is drawn" : "");
}

}  // namespace gnomon::renderer::gltf
