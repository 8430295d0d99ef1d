// Opening a glTF file. The JSON is parsed once, to check its shape and to take out what the loader reads by itself
// (buffers, images, animations). The rest goes to tinygltf. The reasons were all met with tinygltf 2.7:
// - it reads eight bytes past a GLB whose last chunk is too long;
// - it forms addresses from unchecked image views;
// - it drops primitives that it cannot parse without a word;
// - it refuses Draco files when built without Draco.

#include "scene/gltf_document.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "scene/gltf_bytes.h"

namespace gnomon::renderer::gltf {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxNotes = 48;
constexpr std::size_t kMaxMotionNumbers = 1u << 27;  // 512 MiB

// Read in full.
constexpr std::array kSupported = {"KHR_lights_punctual", "KHR_texture_transform", "KHR_materials_emissive_strength",
                                   "KHR_mesh_quantization", "KHR_draco_mesh_compression"};
// Known, and the core material beneath is a fair picture of them.
constexpr std::array kApproximated = {"KHR_materials_unlit",
                                      "KHR_materials_ior",
                                      "KHR_materials_specular",
                                      "KHR_materials_clearcoat",
                                      "KHR_materials_sheen",
                                      "KHR_materials_transmission",
                                      "KHR_materials_volume",
                                      "KHR_materials_iridescence",
                                      "KHR_materials_dispersion",
                                      "KHR_materials_anisotropy",
                                      "KHR_materials_variants",
                                      "KHR_materials_diffuse_transmission",
                                      "KHR_materials_pbrSpecularGlossiness"};

template <std::size_t N>
bool contains(const std::array<const char*, N>& names, const std::string& name) {
    return std::any_of(names.begin(), names.end(), [&](const char* known) { return name == known; });
}

json parseJson(std::string_view text) {
    checkNesting(text);
    // GLB pads its JSON with spaces, some writers with zeros.
    while (!text.empty() && text.back() == '\0') text.remove_suffix(1);
    try {
        return json::parse(text);
    } catch (const json::exception& error) {
        const std::string_view what = error.what();
        refuse("the file is not JSON: {}", what.substr(0, 150));
    }
}

// Every top-level collection that is read is an array of objects.
void checkCollections(const json& root) {
    if (!root.is_object()) refuse("the JSON's root is not an object");
    for (const char* name : {"accessors", "animations", "bufferViews", "buffers", "cameras", "images", "materials",
                             "meshes", "nodes", "samplers", "scenes", "skins", "textures"}) {
        const auto found = root.find(name);
        if (found == root.end()) continue;
        if (!found->is_array()) refuse("'{}' is not an array", name);
        for (const json& element : *found)
            if (!element.is_object()) refuse("'{}' holds something that is not an object", name);
    }
    if (root.contains("scene") && !root["scene"].is_number_integer()) refuse("'scene' is not an index");
}

void checkAsset(const json& root) {
    const auto asset = root.find("asset");
    if (asset == root.end() || !asset->is_object() || !asset->contains("version") || !(*asset)["version"].is_string())
        refuse("the file gives no glTF version");
    const std::string version = (*asset)["version"];
    if (!version.starts_with("2.")) refuse("the file is glTF version '{}', only 2.0 is read", version.substr(0, 20));
    const auto least = asset->find("minVersion");
    if (least != asset->end() && *least != "2.0")
        refuse("the file asks for glTF version {}, only 2.0 is read", least->dump());
}

std::string stringMember(const json& object, const char* name) {
    const auto found = object.find(name);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

int indexMember(const json& object, const char* name) {
    const auto found = object.find(name);
    if (found == object.end()) return -1;
    if (!found->is_number_integer()) refuse("'{}' is not an index", name);
    const auto value = found->get<std::int64_t>();
    return value < 0 || value > 0x7FFFFFFF ? 0x7FFFFFFF : static_cast<int>(value);
}

// As indexMember(), but what is no index is found when somebody needs it.
int laterIndexMember(const json& object, const char* name) {
    const auto found = object.find(name);
    if (found == object.end()) return -1;
    return found->is_number_integer() ? indexMember(object, name) : 0x7FFFFFFF;
}

// The objects of an array member; nothing where there is none.
std::vector<json> objects(const json& object, const char* name) {
    std::vector<json> out;
    const auto found = object.find(name);
    if (found == object.end() || !found->is_array()) return out;
    for (const json& element : *found) out.push_back(element.is_object() ? element : json::object());
    return out;
}

AnimationSource animationSource(const json& from) {
    AnimationSource out;
    out.name = stringMember(from, "name");
    for (const json& sampler : objects(from, "samplers"))
        out.samplers.push_back({laterIndexMember(sampler, "input"), laterIndexMember(sampler, "output"),
                                stringMember(sampler, "interpolation")});
    for (const json& channel : objects(from, "channels")) {
        const auto target = channel.find("target");
        if (target == channel.end() || !target->is_object()) continue;
        out.channels.push_back(
            {laterIndexMember(channel, "sampler"), laterIndexMember(*target, "node"), stringMember(*target, "path")});
    }
    return out;
}

void checkTargets(const json& primitive, const std::string& mesh) {
    const auto targets = primitive.find("targets");
    if (targets == primitive.end()) return;
    if (!targets->is_array()) refuse("the morph targets of mesh '{}' are not an array", mesh);
    for (const json& target : *targets) {
        if (!target.is_object()) refuse("a morph target of mesh '{}' is not an object", mesh);
        for (const json& index : target)
            if (!index.is_number_integer())
                refuse("a morph target of mesh '{}' holds something that is no index", mesh);
    }
}

// Checks the parts of meshes that tinygltf would drop without a word. Draco brings its own indices, and tinygltf cannot
// know that their accessor needs no bufferView, so the reference goes.
void prepareMeshes(json& root) {
    if (!root.contains("meshes")) return;
    for (json& mesh : root["meshes"]) {
        if (!mesh.contains("primitives") || !mesh["primitives"].is_array()) refuse("a mesh has no array of primitives");
        for (json& primitive : mesh["primitives"]) {
            if (!primitive.is_object() || !primitive.contains("attributes") || !primitive["attributes"].is_object())
                refuse("a primitive of mesh '{}' has no attributes", stringMember(mesh, "name"));
            for (const json& index : primitive["attributes"])
                if (!index.is_number_integer())
                    refuse("an attribute of mesh '{}' is not an index", stringMember(mesh, "name"));
            checkTargets(primitive, stringMember(mesh, "name"));
            const auto extensions = primitive.find("extensions");
            if (extensions != primitive.end() && extensions->is_object() &&
                extensions->contains("KHR_draco_mesh_compression"))
                primitive.erase("indices");
        }
    }
}

}  // namespace

const tinygltf::Value* member(const tinygltf::Value& object, const char* name) {
    return object.IsObject() && object.Has(name) ? &object.Get(name) : nullptr;
}

const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions, const char* name) {
    const auto found = extensions.find(name);
    return found != extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

double number(const tinygltf::Value& object, const char* name, double otherwise, std::string_view what) {
    const tinygltf::Value* value = member(object, name);
    if (!value) return otherwise;
    if (!value->IsNumber()) refuse("'{}' of {} is not a number", name, what);
    return value->GetNumberAsDouble();
}

int integer(const tinygltf::Value& object, const char* name, int otherwise, std::string_view what) {
    const tinygltf::Value* value = member(object, name);
    if (!value) return otherwise;
    if (!value->IsInt()) refuse("'{}' of {} is not an integer", name, what);
    return value->GetNumberAsInt();
}

std::vector<double> numbers(const tinygltf::Value& object, const char* name, std::vector<double> otherwise,
                            std::string_view what) {
    const tinygltf::Value* value = member(object, name);
    if (!value) return otherwise;
    std::vector<double> out;
    for (std::size_t i = 0; i < value->ArrayLen(); ++i) {
        const tinygltf::Value& element = value->Get(static_cast<int>(i));
        if (!element.IsNumber()) refuse("'{}' of {} holds something that is not a number", name, what);
        out.push_back(element.GetNumberAsDouble());
    }
    if (out.size() != otherwise.size()) refuse("'{}' of {} must hold {} numbers", name, what, otherwise.size());
    return out;
}

Document::Document(const std::filesystem::path& path) : folder_(path.parent_path()), file_(readFile(path)) {
    const Container container = openContainer(file_);
    binaryChunk_ = container.binary;
    parse(container.json);
    checkExtensions();
}

void Document::parse(std::string_view text) {
    json root = parseJson(text);
    checkCollections(root);
    checkAsset(root);
    prepareMeshes(root);
    for (const json& source : root.value("buffers", json::array())) {
        const auto length = source.find("byteLength");
        BufferSource buffer;
        buffer.uri = stringMember(source, "uri");
        if (length != source.end() && length->is_number_unsigned()) buffer.byteLength = length->get<std::uint64_t>();
        buffers_.push_back(std::move(buffer));
    }
    for (const json& source : root.value("images", json::array()))
        images_.push_back(
            {stringMember(source, "name"), stringMember(source, "uri"), indexMember(source, "bufferView")});
    for (const json& source : root.value("animations", json::array())) animations_.push_back(animationSource(source));
    for (const char* name : {"buffers", "images", "animations", "extras"}) root.erase(name);

    const std::string rest = root.dump(-1, ' ', false, json::error_handler_t::replace);
    if (rest.size() > 0x7FFFFFFF) refuse("the JSON is larger than 2 GiB");
    tinygltf::TinyGLTF parser;
    std::string errors, warnings;
    const bool parsed = parser.LoadASCIIFromString(&model_, &errors, &warnings, rest.data(),
                                                   static_cast<unsigned>(rest.size()), "", tinygltf::NO_REQUIRE);
    if (!parsed) {
        std::replace(errors.begin(), errors.end(), '\n', ' ');
        refuse("the glTF is malformed: {}", errors.empty() ? "no reason is known" : errors.substr(0, 160));
    }
}

void Document::checkExtensions() {
    for (const std::string& name : model_.extensionsRequired)
        if (!contains(kSupported, name) && !contains(kApproximated, name))
            refuse("the file requires the extension '{}', which is not supported", name.substr(0, 80));
    for (const std::string& name : model_.extensionsUsed)
        if (!contains(kSupported, name) && !name.empty())
            note(fmt::format("The extension '{}' is not or only partly read.", name));
}

std::span<const std::uint8_t> Document::bufferBytes(int index, std::string_view user) {
    at(buffers_, index, "buffer", user);
    BufferSource& buffer = buffers_[static_cast<std::size_t>(index)];
    if (buffer.loaded) return buffer.bytes;
    if (buffer.byteLength == 0) refuse("buffer {} has no valid byteLength", index);
    if (buffer.uri.empty()) {
        if (index != 0 || !binaryChunk_)
            refuse("buffer {}, which {} needs, has neither a file nor a binary chunk", index, user);
        buffer.bytes = *binaryChunk_;
    } else {
        if (isDataUri(buffer.uri)) {
            auto decoded = decodeDataUri(buffer.uri);
            if (!decoded) refuse("the data URI of buffer {} is malformed", index);
            buffer.storage = std::move(*decoded);
        } else {
            buffer.storage = readFile(resolveUri(folder_, buffer.uri));
        }
        buffer.bytes = buffer.storage;
    }
    if (buffer.bytes.size() < buffer.byteLength)
        refuse("buffer {} is truncated: {} of {} bytes are there", index, buffer.bytes.size(), buffer.byteLength);
    buffer.bytes = buffer.bytes.first(buffer.byteLength);
    buffer.loaded = true;
    return buffer.bytes;
}

BytesOfView Document::view(int bufferView, std::string_view user) {
    const tinygltf::BufferView& source = at(model_.bufferViews, bufferView, "bufferView", user);
    const std::span<const std::uint8_t> buffer = bufferBytes(source.buffer, user);
    if (source.byteOffset > buffer.size() || source.byteLength > buffer.size() - source.byteOffset)
        refuse("bufferView {}, which {} needs, runs past the end of buffer {}", bufferView, user, source.buffer);
    return {buffer.subspan(source.byteOffset, source.byteLength), source.byteStride};
}

std::span<const std::uint8_t> Document::encodedImage(int image, std::vector<std::uint8_t>& storage) {
    const ImageSource& source = at(images_, image, "image", "a texture");
    try {
        if (source.bufferView >= 0) return view(source.bufferView, fmt::format("image {}", image)).bytes;
        if (isDataUri(source.uri)) {
            auto decoded = decodeDataUri(source.uri);
            if (!decoded) refuse("its data URI is malformed");
            storage = std::move(*decoded);
        } else {
            storage = readFile(resolveUri(folder_, source.uri));
        }
        if (storage.empty()) refuse("it is empty");
        return storage;
    } catch (const Refusal& refusal) {
        note(fmt::format("Image {} is left out: {}.", image, refusal.what()));
        return {};
    }
}

void Document::spendMotionNumbers(std::size_t count) {
    if (count > kMaxMotionNumbers - motionNumbers_)
        refuse("the morph targets and animations hold more than {} numbers", kMaxMotionNumbers);
    motionNumbers_ += count;
}

void Document::note(std::string sentence) {
    if (noted_.contains(sentence)) return;
    if (notes_.size() >= kMaxNotes) {
        ++heldBack_;
        return;
    }
    noted_.insert(sentence);
    notes_.push_back(std::move(sentence));
}

std::vector<std::string> Document::takeNotes() {
    if (heldBack_ > 0) notes_.push_back(fmt::format("{} further notes are held back.", heldBack_));
    return std::move(notes_);
}

}  // namespace gnomon::renderer::gltf
