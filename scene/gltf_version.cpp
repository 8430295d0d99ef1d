// Which version of glTF a file is. Asked first: in version 1.0 everything else has other types.
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "scene/gltf_document.h"
#include "scene/gltf_schema.h"

namespace gnomon::renderer::gltf {
namespace {

using nlohmann::json;

// "major.minor", both of digits alone; false for anything else.
bool readVersion(std::string_view text, std::string_view& major, std::string_view& minor) {
    const std::size_t dot = text.find('.');
    if (dot == std::string_view::npos) return false;
    major = text.substr(0, dot);
    minor = text.substr(dot + 1);
    const auto digits = [](std::string_view part) {
        return !part.empty() && part.find_first_not_of("0123456789") == std::string_view::npos;
    };
    return digits(major) && digits(minor);
}

// Version 1.0 kept everything in objects by name, and its asset could be left out.
bool looksLikeVersion1(const json& root) {
    for (const char* name : {"accessors", "buffers", "meshes", "nodes", "scenes"})
        if (root.contains(name) && root[name].is_object()) return true;
    return root.contains("techniques") || root.contains("programs");
}

}  // namespace

void checkVersion(const json& root) {
    if (!root.is_object()) refuse("the JSON's root is not an object");
    const auto found = root.find("asset");
    if (found != root.end() && !found->is_object()) refuseValue("asset", *found, "an object");
    if (found == root.end() || !found->contains("version")) {
        if (looksLikeVersion1(root)) refuse("the file is glTF version 1.0; only 2.0 is read");
        refuse("the file gives no glTF version; only 2.0 is read");
    }
    const json& given = (*found)["version"];
    if (given.is_number() && given.get<double>() < 2.0)
        refuse("the file is glTF version {}; only 2.0 is read", given.dump());
    if (!given.is_string()) refuseValue("asset.version", given, "a text");
    const auto& text = given.get_ref<const std::string&>();
    if (text.starts_with("1.") || text.starts_with("0."))
        refuse("the file is glTF version {}; only 2.0 is read", text.substr(0, 20));
    std::string_view major, minor;
    if (!readVersion(text, major, minor)) refuseValue("asset.version", given, "a version such as 2.0");
    if (major != "2") refuse("the file is glTF version {}; only 2.0 is read", text.substr(0, 20));
    const auto asked = found->find("minVersion");
    if (asked == found->end()) return;
    if (!asked->is_string()) refuseValue("asset.minVersion", *asked, "a text");
    const auto& minimum = asked->get_ref<const std::string&>();
    if (!readVersion(minimum, major, minor)) refuseValue("asset.minVersion", *asked, "a version such as 2.0");
    const bool early = major == "0" || major == "1" || (major == "2" && minor.find_first_not_of('0') == minor.npos);
    if (!early) refuse("the file asks for glTF version {} at least; only 2.0 is read", minimum.substr(0, 20));
}

}  // namespace gnomon::renderer::gltf
