// Opening a glTF file. The JSON is parsed once, to check its types and to take out what the loader reads by itself
// (buffers, images, animations, indices). The rest goes to tinygltf. The reasons were all met with tinygltf 2.7:
// - it puts defaults in the place of values of a wrong type;
// - it refuses indices without a bufferView, which are zeros;
// - it reads eight bytes past a GLB whose last chunk is too long;
// - it forms addresses from unchecked image views;
// - it drops primitives that it cannot parse without a word;
// - it refuses Draco files when built without Draco.

#include "scene/gltf_document.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scene/gltf_bytes.h"
#include "scene/gltf_extensions.h"
#include "scene/gltf_schema.h"

namespace gnomon::renderer::gltf {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxNotes = 48;
constexpr std::size_t kMaxMotionNumbers = 1u << 27;  // 512 MiB
// No bytes vouch for what has no bufferView.
constexpr std::size_t kMaxUnbackedElements = 1u << 22, kMaxUnbackedElementsInAll = 1u << 25;

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

std::string stringMember(const json& object, const char* name) {
    const auto found = object.find(name);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

int indexMember(const json& object, const char* name) {
    const auto found = object.find(name);
    return found == object.end() ? -1 : found->get<int>();
}

json arrayMember(const json& object, const char* name) {
    return object.value(name, json::array());
}

AnimationSource animationSource(const json& from) {
    AnimationSource out;
    out.name = stringMember(from, "name");
    for (const json& sampler : arrayMember(from, "samplers"))
        out.samplers.push_back(
            {indexMember(sampler, "input"), indexMember(sampler, "output"), stringMember(sampler, "interpolation")});
    for (const json& channel : arrayMember(from, "channels")) {
        const auto target = channel.find("target");
        if (target == channel.end()) continue;
        out.channels.push_back(
            {indexMember(channel, "sampler"), indexMember(*target, "node"), stringMember(*target, "path")});
    }
    return out;
}

// Takes the indices of all primitives out, in order: -1 where there are none. tinygltf refuses those whose accessor has
// no bufferView. With Draco they do not count: it brings its own.
std::vector<int> takeIndices(json& root) {
    std::vector<int> taken;
    if (!root.contains("meshes")) return taken;
    std::size_t number = 0;
    for (json& mesh : root["meshes"]) {
        if (!mesh.contains("primitives")) refuse("meshes[{}] has no primitives", number);
        for (json& primitive : mesh["primitives"]) {
            if (!primitive.contains("attributes"))
                refuse("a primitive of mesh '{}' has no attributes", stringMember(mesh, "name").substr(0, 60));
            const auto extensions = primitive.find("extensions");
            const bool draco = extensions != primitive.end() && extensions->contains("KHR_draco_mesh_compression");
            taken.push_back(draco ? -1 : indexMember(primitive, "indices"));
            primitive.erase("indices");
        }
        ++number;
    }
    return taken;
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
    checkVersion(root);
    checkTypes(root);
    const std::vector<int> indices = takeIndices(root);
    for (const json& source : arrayMember(root, "buffers")) {
        BufferSource buffer;
        buffer.uri = stringMember(source, "uri");
        buffer.byteLength = source.value("byteLength", std::uint64_t{0});
        buffers_.push_back(std::move(buffer));
    }
    for (const json& source : arrayMember(root, "images"))
        images_.push_back(
            {stringMember(source, "name"), stringMember(source, "uri"), indexMember(source, "bufferView")});
    for (const json& source : arrayMember(root, "animations")) animations_.push_back(animationSource(source));
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
    std::size_t next = 0;
    for (tinygltf::Mesh& mesh : model_.meshes)
        for (tinygltf::Primitive& primitive : mesh.primitives)
            primitive.indices = next < indices.size() ? indices[next++] : -1;
    if (next != indices.size()) refuse("a primitive of a mesh cannot be read");
}

void Document::checkExtensions() {
    for (const std::string& name : model_.extensionsRequired)
        if (!isAccepted(name))
            refuse("the file requires the extension '{}', which is not supported", name.substr(0, 80));
    for (const std::string& name : model_.extensionsUsed)
        if (std::string sentence = costOf(name); !sentence.empty()) note(std::move(sentence));
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

void Document::spendUnbackedElements(std::size_t count, std::string_view user) {
    if (count > kMaxUnbackedElements || count > kMaxUnbackedElementsInAll - unbackedElements_)
        refuse("{} wants {} elements without a bufferView", user, count);
    unbackedElements_ += count;
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
