// Source: glTF 2.0 specification, chapter 5 and its JSON schemas; section 2.7.1.1: integers are written without a
// fraction. The tables list one property per line, as the specification does, and only what this loader reads.

#include "scene/gltf_schema.h"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "scene/gltf_document.h"

namespace gnomon::renderer::gltf {
namespace {

using nlohmann::json;

enum class Type : std::uint8_t {
    Boolean,
    Number,
    Count,  // a whole number of 0 or more
    Index,  // the same, within an int
    Text,
    Word,     // one of `words`
    Code,     // one of `codes`
    Numbers,  // an array of `length` numbers, 0: of any length
    Indices,
    Texts,
    IndexMap,  // an object of indices: attributes
    Object,    // of `shape`
    Extras,    // anything; where it is an object, the properties of `shape` are ours
    Objects,   // an array of objects of `shape`
    IndexMaps  // an array of objects of indices: morph targets
};

struct Property {
    std::string_view name;
    Type type;
    std::size_t length = 0;
    std::span<const Property> shape{};
    std::span<const std::string_view> words{};
    std::span<const int> codes{};
};

using Shape = std::span<const Property>;

constexpr Property object(std::string_view name, Shape shape) {
    return {name, Type::Object, 0, shape, {}, {}};
}
constexpr Property extras(Shape shape) {
    return {"extras", Type::Extras, 0, shape, {}, {}};
}
constexpr Property objects(std::string_view name, Shape shape) {
    return {name, Type::Objects, 0, shape, {}, {}};
}
constexpr Property numbers(std::string_view name, std::size_t length) {
    return {name, Type::Numbers, length, {}, {}, {}};
}
constexpr Property word(std::string_view name, std::span<const std::string_view> words) {
    return {name, Type::Word, 0, {}, words, {}};
}
constexpr Property code(std::string_view name, std::span<const int> codes) {
    return {name, Type::Code, 0, {}, {}, codes};
}
constexpr Property plain(std::string_view name, Type type) {
    return {name, type, 0, {}, {}, {}};
}
constexpr Property text(std::string_view name) {
    return plain(name, Type::Text);
}
constexpr Property number(std::string_view name) {
    return plain(name, Type::Number);
}
constexpr Property index(std::string_view name) {
    return plain(name, Type::Index);
}
constexpr Property count(std::string_view name) {
    return plain(name, Type::Count);
}

constexpr Property kAsset[] = {text("version"), text("minVersion")};

constexpr std::string_view kAccessorTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
constexpr int kComponentTypes[] = {5120, 5121, 5122, 5123, 5125, 5126};
constexpr int kSparseIndexTypes[] = {5121, 5123, 5125};
constexpr Property kSparseIndices[] = {index("bufferView"), count("byteOffset"),
                                       code("componentType", kSparseIndexTypes)};
constexpr Property kSparseValues[] = {index("bufferView"), count("byteOffset")};
constexpr Property kSparse[] = {count("count"), object("indices", kSparseIndices), object("values", kSparseValues)};
constexpr Property kAccessor[] = {index("bufferView"),
                                  count("byteOffset"),
                                  code("componentType", kComponentTypes),
                                  plain("normalized", Type::Boolean),
                                  count("count"),
                                  word("type", kAccessorTypes),
                                  object("sparse", kSparse)};
constexpr Property kBufferView[] = {index("buffer"), count("byteOffset"), count("byteLength"), count("byteStride")};
constexpr Property kBuffer[] = {text("uri"), count("byteLength")};

constexpr Property kTextureTransform[] = {numbers("offset", 2), numbers("scale", 2), number("rotation"),
                                          index("texCoord")};
constexpr Property kTextureExtensions[] = {object("KHR_texture_transform", kTextureTransform)};
constexpr Property kTextureInfo[] = {index("index"), index("texCoord"), object("extensions", kTextureExtensions)};
constexpr Property kNormalTextureInfo[] = {index("index"), index("texCoord"), number("scale"),
                                           object("extensions", kTextureExtensions)};
constexpr Property kMetallicRoughness[] = {numbers("baseColorFactor", 4), number("metallicFactor"),
                                           number("roughnessFactor"), object("baseColorTexture", kTextureInfo),
                                           object("metallicRoughnessTexture", kTextureInfo)};
constexpr Property kEmissiveStrength[] = {number("emissiveStrength")};
constexpr Property kSpecularGlossiness[] = {numbers("diffuseFactor", 4), number("glossinessFactor"),
                                            object("diffuseTexture", kTextureInfo)};
constexpr Property kMaterialExtensions[] = {object("KHR_materials_emissive_strength", kEmissiveStrength),
                                            object("KHR_materials_pbrSpecularGlossiness", kSpecularGlossiness),
                                            object("KHR_materials_transmission", {}),
                                            object("KHR_materials_diffuse_transmission", {})};
constexpr Property kMaterialExtras[] = {plain("subsurface", Type::Boolean)};
constexpr std::string_view kAlphaModes[] = {"OPAQUE", "MASK", "BLEND"};
constexpr Property kMaterial[] = {text("name"),
                                  object("pbrMetallicRoughness", kMetallicRoughness),
                                  object("normalTexture", kNormalTextureInfo),
                                  object("emissiveTexture", kTextureInfo),
                                  numbers("emissiveFactor", 3),
                                  word("alphaMode", kAlphaModes),
                                  number("alphaCutoff"),
                                  plain("doubleSided", Type::Boolean),
                                  object("extensions", kMaterialExtensions),
                                  extras(kMaterialExtras)};
constexpr Property kTexture[] = {index("sampler"), index("source")};
constexpr int kWraps[] = {10497, 33071, 33648};
constexpr int kFilters[] = {9728, 9729};
constexpr Property kSampler[] = {code("wrapS", kWraps), code("wrapT", kWraps), code("magFilter", kFilters)};
constexpr Property kImage[] = {text("name"), text("uri"), index("bufferView")};

constexpr Property kDraco[] = {index("bufferView"), plain("attributes", Type::IndexMap)};
constexpr Property kPrimitiveExtensions[] = {object("KHR_draco_mesh_compression", kDraco)};
constexpr int kModes[] = {0, 1, 2, 3, 4, 5, 6};
constexpr Property kPrimitive[] = {plain("attributes", Type::IndexMap),
                                   index("indices"),
                                   index("material"),
                                   code("mode", kModes),
                                   plain("targets", Type::IndexMaps),
                                   object("extensions", kPrimitiveExtensions)};
constexpr Property kMesh[] = {text("name"), objects("primitives", kPrimitive), numbers("weights", 0)};
constexpr Property kSkin[] = {text("name"), plain("joints", Type::Indices), index("inverseBindMatrices")};

constexpr Property kNodeLight[] = {index("light")};
constexpr Property kNodeExtensions[] = {object("KHR_lights_punctual", kNodeLight)};
constexpr Property kNode[] = {text("name"),
                              plain("children", Type::Indices),
                              index("mesh"),
                              index("skin"),
                              index("camera"),
                              numbers("matrix", 16),
                              numbers("translation", 3),
                              numbers("rotation", 4),
                              numbers("scale", 3),
                              numbers("weights", 0),
                              object("extensions", kNodeExtensions)};
constexpr Property kScene[] = {text("name"), plain("nodes", Type::Indices)};

constexpr std::string_view kCameraTypes[] = {"perspective", "orthographic"};
constexpr Property kPerspective[] = {number("yfov"), number("aspectRatio"), number("znear"), number("zfar")};
constexpr Property kOrthographic[] = {number("xmag"), number("ymag"), number("znear"), number("zfar")};
constexpr Property kCamera[] = {text("name"), word("type", kCameraTypes), object("perspective", kPerspective),
                                object("orthographic", kOrthographic)};

constexpr std::string_view kLightTypes[] = {"point", "spot", "directional"};
constexpr Property kSpot[] = {number("innerConeAngle"), number("outerConeAngle")};
constexpr std::string_view kShadowFilters[] = {"hard", "pcf", "pcss", "pcss-shared"};
constexpr Property kLightExtras[] = {number("shadowBiasMetres"), word("shadowFilter", kShadowFilters),
                                     number("sourceRadius")};
constexpr Property kLight[] = {text("name"),    word("type", kLightTypes), numbers("color", 3), number("intensity"),
                               number("range"), object("spot", kSpot),     extras(kLightExtras)};
constexpr Property kLights[] = {objects("lights", kLight)};
constexpr Property kRootExtensions[] = {object("KHR_lights_punctual", kLights)};

constexpr std::string_view kInterpolations[] = {"LINEAR", "STEP", "CUBICSPLINE"};
constexpr Property kAnimationSampler[] = {index("input"), index("output"), word("interpolation", kInterpolations)};
constexpr Property kTarget[] = {index("node"), text("path")};
constexpr Property kChannel[] = {index("sampler"), object("target", kTarget)};
constexpr Property kAnimation[] = {text("name"), objects("samplers", kAnimationSampler), objects("channels", kChannel)};

constexpr Property kRoot[] = {object("asset", kAsset),
                              plain("extensionsUsed", Type::Texts),
                              plain("extensionsRequired", Type::Texts),
                              objects("accessors", kAccessor),
                              objects("animations", kAnimation),
                              objects("bufferViews", kBufferView),
                              objects("buffers", kBuffer),
                              objects("cameras", kCamera),
                              objects("images", kImage),
                              objects("materials", kMaterial),
                              objects("meshes", kMesh),
                              objects("nodes", kNode),
                              objects("samplers", kSampler),
                              index("scene"),
                              objects("scenes", kScene),
                              objects("skins", kSkin),
                              objects("textures", kTexture),
                              object("extensions", kRootExtensions)};

// Where a value stands: a chain on the stack, made text only when something is refused.
struct Place {
    const Place* parent = nullptr;
    std::string_view name;  // empty: the element `index` of an array
    std::size_t index = 0;

    [[nodiscard]] std::string path() const {
        if (parent == nullptr) return {};
        const std::string above = parent->path();
        if (name.empty()) return above + "[" + std::to_string(index) + "]";
        return above + (above.empty() ? "" : ".") + std::string(name.substr(0, 40));
    }
};

template <class T>
std::string listed(std::span<const T> all) {
    std::string out;
    for (std::size_t i = 0; i < all.size(); ++i)
        out += fmt::format("{}{}", i == 0 ? "" : i + 1 == all.size() ? " and " : ", ", all[i]);
    return out;
}

[[noreturn]] void refuseAt(const Place& place, const json& value, const std::string& expected) {
    refuseValue(place.path(), value, expected);
}

bool isCount(const json& value) {
    return value.is_number_unsigned() || (value.is_number_integer() && value.get<std::int64_t>() >= 0);
}

bool isIndex(const json& value) {
    return isCount(value) && value.get<std::uint64_t>() <= 0x7FFFFFFFu;
}

bool isCode(const json& value, std::span<const int> codes) {
    return isIndex(value) && std::find(codes.begin(), codes.end(), value.get<int>()) != codes.end();
}

bool isWord(const json& value, std::span<const std::string_view> words) {
    return value.is_string() &&
           std::find(words.begin(), words.end(), value.get_ref<const std::string&>()) != words.end();
}

bool areNumbers(const json& value, std::size_t length) {
    return value.is_array() && value.size() == length &&
           std::all_of(value.begin(), value.end(), [](const json& v) { return v.is_number(); });
}

void checkObject(const json& value, Shape shape, const Place& place);

// Every element of an array: by its own place.
template <class Good>
void checkElements(const json& value, const Place& place, const char* array, const char* element, const Good& good) {
    if (!value.is_array()) refuseAt(place, value, array);
    for (std::size_t i = 0; i < value.size(); ++i)
        if (!good(value[i])) refuseAt({&place, {}, i}, value[i], element);
}

void checkIndexMap(const json& value, const Place& place) {
    if (!value.is_object()) refuseAt(place, value, "an object");
    for (const auto& [name, element] : value.items())
        if (!isIndex(element)) refuseAt({&place, name}, element, "an index");
}

void check(const json& value, const Property& property, const Place& place) {
    switch (property.type) {
        case Type::Boolean:
            if (!value.is_boolean()) refuseAt(place, value, "true or false");
            break;
        case Type::Number:
            if (!value.is_number()) refuseAt(place, value, "a number");
            break;
        case Type::Count:
            if (!isCount(value)) refuseAt(place, value, "a whole number of 0 or more");
            break;
        case Type::Index:
            if (!isIndex(value)) refuseAt(place, value, "an index");
            break;
        case Type::Text:
            if (!value.is_string()) refuseAt(place, value, "a text");
            break;
        case Type::Word:
            if (!isWord(value, property.words)) refuseAt(place, value, "one of " + listed(property.words));
            break;
        case Type::Code:
            if (!isCode(value, property.codes)) refuseAt(place, value, "one of " + listed(property.codes));
            break;
        case Type::Numbers:
            if (property.length == 0)
                checkElements(value, place, "an array of numbers", "a number",
                              [](const json& v) { return v.is_number(); });
            else if (!areNumbers(value, property.length))
                refuseAt(place, value, fmt::format("an array of {} numbers", property.length));
            break;
        case Type::Indices:
            checkElements(value, place, "an array of indices", "an index", isIndex);
            break;
        case Type::Texts:
            checkElements(value, place, "an array of texts", "a text", [](const json& v) { return v.is_string(); });
            break;
        case Type::IndexMap:
            checkIndexMap(value, place);
            break;
        case Type::IndexMaps:
            if (!value.is_array()) refuseAt(place, value, "an array of objects");
            for (std::size_t i = 0; i < value.size(); ++i) checkIndexMap(value[i], {&place, {}, i});
            break;
        case Type::Object:
            checkObject(value, property.shape, place);
            break;
        case Type::Extras:
            if (value.is_object()) checkObject(value, property.shape, place);
            break;
        case Type::Objects:
            if (!value.is_array()) refuseAt(place, value, "an array of objects");
            for (std::size_t i = 0; i < value.size(); ++i) checkObject(value[i], property.shape, {&place, {}, i});
            break;
    }
}

void checkObject(const json& value, Shape shape, const Place& place) {
    if (!value.is_object()) refuseAt(place, value, "an object");
    for (const Property& property : shape)
        if (const auto found = value.find(property.name); found != value.end())
            check(*found, property, {&place, property.name});
}

}  // namespace

void refuseValue(std::string_view path, const json& value, std::string_view expected) {
    constexpr std::size_t kMostShown = 40;
    std::string shown = value.dump(-1, ' ', true, json::error_handler_t::replace);  // ASCII: may be cut anywhere
    if (shown.size() > kMostShown) shown = shown.substr(0, kMostShown) + "...";
    refuse("{} is {}, not {}", path, shown, expected);
}

void checkTypes(const json& root) {
    checkObject(root, kRoot, {});
}

}  // namespace gnomon::renderer::gltf
