#include "fuzz/gltf/mutation.h"

#include <string>
#include <vector>

namespace gnomon::fuzz {
namespace {

using nlohmann::json;

std::size_t below(Random& random, std::size_t count) {
    return static_cast<std::size_t>(random() % count);
}

template <class T, std::size_t N>
const T& oneOf(const T (&values)[N], Random& random) {
    return values[below(random, N)];
}

json anyNumber(Random& random) {
    // Limits of types, of the loader, and numbers that are nearly right.
    static const json numbers[] = {0,          1,     2,    3,         4,          7,          12,         16,
                                   64,         255,   256,  65535,     65536,      5120,       5121,       5123,
                                   5125,       5126,  -1,   -2,        2147483647, -0.0,       0.5,        1e-30,
                                   -1e-30,     1e10,  1e15, 1.1e15,    3.5e38,     -3.5e38,    1e300,      -1e300,
                                   1e-45,      0.001, 1.5,  1.5707963, 1.6,        4294967295, 4294967296, 1ull << 53,
                                   1ull << 63, 1e8,   -1e8, 1e-6,      100};
    return oneOf(numbers, random);
}

json anyWord(Random& random) {
    static const char* const words[] = {"SCALAR",
                                        "VEC2",
                                        "VEC3",
                                        "VEC4",
                                        "MAT2",
                                        "MAT3",
                                        "MAT4",
                                        "OPAQUE",
                                        "MASK",
                                        "BLEND",
                                        "LINEAR",
                                        "STEP",
                                        "CUBICSPLINE",
                                        "translation",
                                        "rotation",
                                        "scale",
                                        "weights",
                                        "point",
                                        "spot",
                                        "directional",
                                        "perspective",
                                        "orthographic",
                                        "pcf",
                                        "hard",
                                        "POSITION",
                                        "",
                                        "data:",
                                        "data:application/octet-stream;base64,",
                                        "data:;base64,////",
                                        "missing.bin",
                                        "..",
                                        "/dev/null",
                                        "\u0000",
                                        "image/png",
                                        "2.0",
                                        "1.0"};
    return oneOf(words, random);
}

json anything(Random& random) {
    switch (below(random, 8)) {
        case 0:
            return nullptr;
        case 1:
            return below(random, 2) == 0;
        case 2:
            return json::array();
        case 3:
            return json::object();
        case 4:
            return anyWord(random);
        case 5:
            return json::array({anyNumber(random), anyNumber(random), anyNumber(random)});
        default:
            return anyNumber(random);
    }
}

const char* anyProperty(Random& random) {
    static const char* const names[] = {
        "mesh",       "skin",          "camera",      "children",      "matrix",     "translation",
        "rotation",   "scale",         "weights",     "targets",       "indices",    "material",
        "mode",       "attributes",    "JOINTS_0",    "WEIGHTS_0",     "NORMAL",     "TANGENT",
        "TEXCOORD_0", "TEXCOORD_1",    "COLOR_0",     "bufferView",    "count",      "byteOffset",
        "sparse",     "type",          "byteStride",  "componentType", "normalized", "min",
        "max",        "interpolation", "input",       "output",        "path",       "node",
        "range",      "intensity",     "color",       "extras",        "skeleton",   "target",
        "extensions", "doubleSided",   "alphaCutoff", "aspectRatio",   "zfar",       "yfov",
        "spot",       "uri",           "byteLength",  "joints",        "sampler",    "inverseBindMatrices"};
    return oneOf(names, random);
}

void collect(json& part, std::vector<json*>& out) {
    out.push_back(&part);
    if (!part.is_structured()) return;
    for (json& inner : part) collect(inner, out);
}

/// Other bytes in a data URI, of the same length.
void changeBytes(std::string& uri, Random& random) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || uri.size() < comma + 6) return;
    const std::size_t from = comma + 1, size = uri.size() - from - 2;  // the padding stays
    // A float's worth: infinity, not a number, a huge number, zeros; or any one digit.
    static const char* const runs[] = {"AACAfwAA", "AAAAf8B/", "////f///", "AAAAAAAA", "gP8AAID/"};
    if (below(random, 2) == 0 && size > 8) {
        const std::size_t at = from + below(random, (size - 8) / 4 + 1) * 4;
        uri.replace(at, 8, oneOf(runs, random));
    } else {
        uri[from + below(random, size)] = digits[below(random, 64)];
    }
}

bool isSmall(std::int64_t value) {
    constexpr std::int64_t kMost = 1'000'000'000;
    return -kMost < value && value < kMost;
}

void changeOne(json& root, Random& random) {
    std::vector<json*> parts;
    collect(root, parts);
    json& part = *parts[below(random, parts.size())];
    switch (below(random, 8)) {
        case 0:
        case 1:
            if (part.is_string() && part.get_ref<const std::string&>().starts_with("data:"))
                changeBytes(part.get_ref<std::string&>(), random);
            else if (part.is_number())
                part = anyNumber(random);
            else if (part.is_string())
                part = anyWord(random);
            break;
        case 2:
            part = anything(random);
            break;
        case 3:  // left out
            if (part.is_structured() && !part.empty()) {
                auto at = part.begin();
                std::advance(at, static_cast<std::ptrdiff_t>(below(random, part.size())));
                part.erase(at);
            }
            break;
        case 4:  // doubled
            if (part.is_array() && !part.empty()) part.push_back(json(part[below(random, part.size())]));
            break;
        case 5: {  // what belongs elsewhere
            const json other = *parts[below(random, parts.size())];
            if (other.dump().size() < 20'000) part = other;
            break;
        }
        case 6:
            if (part.is_object()) part[anyProperty(random)] = anything(random);
            break;
        default:  // a neighbouring number, as in an index that is off by one
            if (part.is_number_integer() && isSmall(part.get<std::int64_t>()))
                part = part.get<std::int64_t>() + (below(random, 2) == 0 ? 1 : -1);
            break;
    }
}

}  // namespace

json mutated(json file, Random& random) {
    for (std::size_t i = 1 + below(random, 4); i > 0; --i) changeOne(file, random);
    return file;
}

}  // namespace gnomon::fuzz
