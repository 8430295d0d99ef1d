#include "app/settings_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "app/errors.h"
#include "app/option_checks.h"
#include "app/progress.h"
#include "gpu_interface/numbers.h"

namespace gnomon::app {
namespace {

constexpr const char* kScene = "Scene and camera";
constexpr const char* kFilter = "Shadow filters";
constexpr const char* kBias = "Depth bias";
constexpr const char* kMaps = "Shadowmaps and depth";
constexpr const char* kPools = "Pools and lists";
constexpr const char* kDevice = "Device";
constexpr double kMostPoolEntries = 1u << 30;

// A check by parsing: what `parse` throws about a text is the sentence against it.
template <class Parse>
std::function<std::string(const std::string&)> checkedBy(Parse parse) {
    return [parse](const std::string& text) {
        try {
            parse(text);
            return std::string();
        } catch (const UsageError& error) {
            return std::string(error.what());
        }
    };
}

void checkSize(const std::string& text) {
    std::uint32_t width = 0, height = 0;
    parseSize(text, width, height);
}

void checkPresets(const std::string& text) {
    ShadowSettings unused;
    parsePresets(text, unused);
}

std::string checkBiasMetres(const std::string& text) {
    return text == "auto" ? std::string() : checkedBy(parseBiasMetres)(text);
}

constexpr double kLeastDensity = 0.1, kMostDensity = 64.0;

std::string checkDensity(const std::string& text) {
    const bool good = numberWithin(0.0, 0.0)(text).empty() || numberWithin(kLeastDensity, kMostDensity)(text).empty();
    return good ? std::string()
                : fmt::format("'{}' is neither 0 nor a number from {} to {}", text, kLeastDensity, kMostDensity);
}

std::vector<Setting> makeTable() {
    using S = Settings;
    std::vector<Setting> t;
    const auto add = [&t](Setting setting) { t.push_back(std::move(setting)); };
    add({.group = kScene,
         .name = "size",
         .key = "size",
         .member = &S::size,
         .help = "Size of the picture",
         .check = checkedBy(checkSize),
         .range = fmt::format("WIDTHxHEIGHT, each from 1 to {} pixels, with at most {} tiles of 8x8", kMostPixelsAcross,
                              kMostTiles)});
    add({.group = kScene,
         .name = "camera",
         .key = "camera",
         .member = &S::camera,
         .help = "Where the picture is taken from",
         .range = "default, a camera's name, #index, or eye:target[:degrees or :height=UNITS][:roll=DEGREES] in the "
                  "file's coordinates, as in 0,3,8:0,1,0:60; height makes it orthographic"});
    add({.group = kScene,
         .name = "time",
         .key = "time",
         .member = &S::time,
         .help = "Seconds into the scene's animations, of the first frame",
         .least = -1e9,
         .most = 1e9});
    add({.group = kScene,
         .name = "animation",
         .key = "animation",
         .member = &S::animation,
         .help = "The animation to play",
         .range = "its name, #index, default or none"});
    add({.group = kScene,
         .name = "lights",
         .key = "lights",
         .member = &S::lights,
         .help = "Scatter so many shadowed lights over the scene",
         .most = kMostLights});
    add({.group = kScene,
         .name = "light-density",
         .key = "lightDensity",
         .member = &S::lightDensity,
         .help = "Shadowed lights per tile, in the mean, that --lights shall give in this picture; they take the place "
                 "of the scene's own point and spot lights. 0, the default: off, --lights go by the scene's area alone",
         .needs = "--lights",
         .check = checkDensity,
         .range = fmt::format("0 (off), or {} to {}", kLeastDensity, kMostDensity)});
    add({.group = kScene,
         .name = "ambient",
         .key = "ambient",
         .member = &S::ambient,
         .help = "Ambient light and background. off: black, so that the lights alone are seen",
         .choices = {"on", "off"}});
    add({.group = kScene,
         .name = "source-radius",
         .key = "sourceRadiusMetres",
         .member = &S::sourceRadius,
         .help =
             "Source radius in metres of point and spot lights that state none; it makes penumbrae. 0: a fortieth of "
             "the distance to the nearest surface that the light shines on",
         .most = 1000.0});
    add({.group = kScene,
         .name = "seed",
         .key = "seed",
         .member = &S::seed,
         .help = "Seed of scattered lights, and of what verify chooses by chance",
         .most = 4294967295.0});

    add({.group = kFilter,
         .name = "filter",
         .key = "filter",
         .member = &S::filter,
         .help = "Shadow filter. Several, parted by commas, take turns among the lights",
         .check = checkedBy(filtersOf),
         .range = "hard, pcf, pcss, pcss-shared, or several of them as in hard,pcss"});
    add({.group = kFilter,
         .name = "pcf-radius",
         .key = "pcfRadius",
         .member = &S::pcfRadius,
         .help = "Radius of the pcf filter in texels",
         .least = 1,
         .most = gpu::kMaxPcfRadius});
    add({.group = kFilter,
         .name = "pcss-taps",
         .key = "pcssTaps",
         .member = &S::taps,
         .help = "Taps of the search and of the filter of pcss and pcss-shared. Several, parted by slashes, take turns "
                 "among the lights with them",
         .check = checkedBy(checkPresets),
         .range =
             fmt::format("low, medium, high, or SEARCH,FILTER as in 16,24, each from 1 to {}; or up to {} of these "
                         "as in low/high/16,24",
                         gpu::kMaxPcssTaps, gpu::kMaxPcssPresets)});
    add({.group = kFilter,
         .name = "pattern-per-frame",
         .key = "patternPerFrame",
         .member = &S::patternPerFrame,
         .help = "Turn the sample pattern of pcss and pcss-shared from frame to frame"});
    add({.group = kFilter,
         .name = "no-shadow-bounds",
         .key = "noShadowBounds",
         .member = &S::noShadowBounds,
         .help = "pcss and pcss-shared search everywhere, also where the bounds of the shadowmaps tell the result"});
    add({.group = kFilter,
         .name = "visibility-bits",
         .key = "visibilityBits",
         .member = &S::visibilityBits,
         .help = "Bits of a pixel's visibility in a slot",
         .choices = {"4", "8"}});
    add({.group = kFilter,
         .name = "unquantised",
         .key = "unquantised",
         .member = &S::unquantised,
         .help = "Do not round inline shadows to the bits of a visibility slot"});

    add({.group = kBias,
         .name = "bias",
         .key = "bias",
         .member = &S::bias,
         .help =
             "How the depth bias is made. oriented: each texel against the receiver's own plane; oriented-constant: "
             "one depth for all texels, and maps drawn with slope factor 1; paper: as oriented-constant, but faces "
             "that look away from the light are looked up in the map, not taken for dark (the paper's listing 7); "
             "hardware: maps drawn with constant factor 4096 and slope factor 2; hardware-no-normals: as hardware, "
             "but faces that look away are looked up, so that no normal is read; none: no bias at all",
         .choices = biasNames()});
    add({.group = kBias,
         .name = "hardware-bias",
         .key = "hardwareBias",
         .member = &S::hardwareBias,
         .help = "Factors to draw shadowmaps with, in place of those of --bias",
         .check = checkedBy(parseHardwareBias),
         .range = "CONSTANT,SLOPE or CONSTANT,SLOPE,CLAMP, each at least 0"});
    add({.group = kBias,
         .name = "bias-metres",
         .key = "biasMetres",
         .member = &S::biasMetres,
         .help = "Oriented bias in metres, of lights that state none. auto: 2 mm, but at most a five-hundredth of the "
                 "distance "
                 "from a point or spot light, and of half the width of a cascade",
         .check = checkBiasMetres,
         .range = fmt::format("auto, or 0 to {}", kMostBiasMetres)});
    add({.group = kBias,
         .name = "subsurface-fronts",
         .key = "subsurfaceFronts",
         .member = &S::subsurfaceFronts,
         .help = "Draw subsurface casters with the faces that look at the light, and bias subsurface pixels by "
                 "--subsurface-bias"});
    add({.group = kBias,
         .name = "subsurface-bias",
         .key = "subsurfaceBiasMetres",
         .member = &S::subsurfaceBiasMetres,
         .help = "Bias of subsurface pixels in metres, where a light's own is smaller",
         .most = 1000.0,
         .needs = "--subsurface-fronts"});
    add({.group = kBias,
         .name = "face-normals",
         .key = "faceNormals",
         .member = &S::faceNormals,
         .help = "Face normals: stored in the G-buffer, or derived from its depth",
         .choices = {"stored", "derived"}});

    add({.group = kMaps,
         .name = "atlas",
         .key = "atlas",
         .member = &S::atlas,
         .help = "Width and height of the shadow atlas in pixels; 0: by the size of the picture",
         .choices = {"0", "256", "512", "1024", "2048", "4096", "8192", "16384"}});
    add({.group = kMaps,
         .name = "face-guard",
         .key = "faceGuardTexels",
         .member = &S::faceGuardTexels,
         .help =
             "Texels by which each of the six shadow views of a point light or a wide spot reaches farther on every "
             "side than pcf needs, but at most an eighth of its width. Taps of pcss then look at the view beside it "
             "less often. The views keep their size, so their texels get larger",
         .most = kMostFaceGuardTexels});
    add({.group = kMaps,
         .name = "depth",
         .key = "depth",
         .member = &S::depth,
         .help = "Depth buffer of the camera",
         .choices = {"reversed", "standard"}});

    add({.group = kMaps,
         .name = "history",
         .key = "history",
         .member = &S::history,
         .help =
             "Whether shadow resolutions and places in the atlas are kept from frame to frame where they are nearly "
             "right. off: a frame follows from scene, time and settings alone. auto: on in bench, off elsewhere",
         .choices = {"auto", "on", "off"}});

    add({.group = kPools,
         .name = "list-entries",
         .key = "listEntries",
         .member = &S::listEntries,
         .help = "Capacity of the light lists in entries; 0: 8 per tile",
         .most = kMostPoolEntries});
    add({.group = kPools,
         .name = "visibility-slots",
         .key = "visibilitySlots",
         .member = &S::visibilitySlots,
         .help = "Capacity of the visibility slots; 0: 4 per tile",
         .most = kMostPoolEntries});
    add({.group = kPools,
         .name = "most-list-entries",
         .key = "mostListEntries",
         .member = &S::mostListEntries,
         .help = "Entries to which the light lists may grow by themselves, between frames; 0: they do not grow",
         .most = kMostPoolEntries});
    add({.group = kPools,
         .name = "most-visibility-slots",
         .key = "mostVisibilitySlots",
         .member = &S::mostVisibilitySlots,
         .help = "Slots to which the visibility slots may grow by themselves, between frames; 0: they do not grow",
         .most = kMostPoolEntries});
    add({.group = kPools,
         .name = "light-lists",
         .key = "lightLists",
         .member = &S::lightLists,
         .help =
             "Which lights a tile's list holds before shadows are evaluated: froxel: those that may reach the tile; "
             "pixel: those that reach a pixel of it, which costs a pass more (the paper's phase 3)",
         .choices = {"froxel", "pixel"}});
    add({.group = kPools,
         .name = "reservation",
         .key = "reservation",
         .member = &S::reservation,
         .help = fmt::format(
             "How space in the light lists is given out: approximate: as the froxel tests count; accurate: as "
             "the lights are; fixed: {} entries to each tile, rounded up to {}",
             kFixedListEntriesPerTile, gpu::roundUpToEarlyWord(kFixedListEntriesPerTile)),
         .choices = {"approximate", "accurate", "fixed"}});

    add({.group = kDevice,
         .name = "device",
         .key = "device",
         .member = &S::device,
         .help = "The Vulkan device (see: gnomon devices)",
         .range = "its index, or part of its name"});
    add({.group = kDevice,
         .name = "subgroup-size",
         .key = "subgroupSize",
         .member = &S::subgroupSize,
         .help = "Lanes of a subgroup; 0: the device's own choice",
         .choices = {"0", "4", "8", "16", "32", "64"}});
    add({.group = kDevice,
         .name = "validate",
         .key = "validate",
         .member = &S::validate,
         .help = "Run under the validation layers; any message is a failure"});
    return t;
}

CLI::Validator validatorOf(const Setting& setting) {
    const std::string range = rangeOf(setting);
    if (!setting.choices.empty())
        return {[choices = setting.choices](const std::string& text) {
                    if (std::ranges::find(choices, text) != choices.end()) return std::string();
                    return fmt::format("'{}' is none of {}", text, fmt::join(choices, ", "));
                },
                range};
    if (setting.check) return {[check = setting.check](const std::string& text) { return check(text); }, range};
    if (std::holds_alternative<std::string Settings::*>(setting.member))
        return {[](const std::string&) { return std::string(); }, range};
    if (std::holds_alternative<float Settings::*>(setting.member) ||
        std::holds_alternative<double Settings::*>(setting.member))
        return numberWithin(setting.least, setting.most).description(range);
    return {[least = setting.least, most = setting.most](const std::string& text) {
                std::uint64_t value = 0;
                const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
                const auto number = static_cast<double>(value);
                const bool good =
                    error == std::errc() && end == text.data() + text.size() && least <= number && number <= most;
                return good ? std::string() : fmt::format("'{}' is no whole number from {} to {}", text, least, most);
            },
            range};
}

}  // namespace

std::span<const Setting> settingsTable() {
    static const std::vector<Setting> table = makeTable();
    return table;
}

std::string rangeOf(const Setting& setting) {
    if (!setting.range.empty()) return setting.range;
    if (!setting.choices.empty()) return fmt::format("{}", fmt::join(setting.choices, ", "));
    if (std::holds_alternative<bool Settings::*>(setting.member)) return "";
    return fmt::format("{} to {}", setting.least, setting.most);
}

double shortest(float value) {
    return std::strtod(fmt::format("{}", value).c_str(), nullptr);
}

nlohmann::ordered_json valueOf(const Setting& setting, const Settings& settings) {
    return std::visit(
        [&](auto member) {
            const auto& value = settings.*member;
            if constexpr (std::is_same_v<decltype(member), float Settings::*>)
                return nlohmann::ordered_json(shortest(value));
            else
                return nlohmann::ordered_json(value);
        },
        setting.member);
}

nlohmann::ordered_json valuesOf(const Settings& settings) {
    nlohmann::ordered_json out = nlohmann::ordered_json::object();
    for (const Setting& setting : settingsTable()) out[setting.key] = valueOf(setting, settings);
    return out;
}

void addSettings(CLI::App& command, Settings& settings) {
    command.add_option("scene", settings.scene, "A built-in scene or a .gltf or .glb file")->capture_default_str();
    for (const Setting& setting : settingsTable()) {
        const std::string option = std::string("--") + setting.name;
        CLI::Option* made = std::visit(
            [&](auto member) {
                if constexpr (std::is_same_v<decltype(member), bool Settings::*>) {
                    return command.add_flag(option, settings.*member, setting.help);
                } else {
                    return command.add_option(option, settings.*member, setting.help)
                        ->check(validatorOf(setting))
                        ->capture_default_str();
                }
            },
            setting.member);
        made->group(setting.group);
        if (setting.needs != nullptr) made->needs(command.get_option(setting.needs));
    }
    command.add_flag_callback("--quiet", silenceProgress, "No progress on stderr")->group(kDevice);
}

std::string settingsPage() {
    std::string page =
        "# Settings\n\nWhat `gnomon render`, `verify` and `bench` share. `gnomon settings` prints this page.\n";
    const char* group = "";
    for (const Setting& setting : settingsTable()) {
        if (std::string_view(group) != setting.group) {
            group = setting.group;
            page += fmt::format("\n## {}\n\n| option | what | value | default |\n|---|---|---|---|\n", group);
        }
        const nlohmann::ordered_json value = valueOf(setting, Settings{});
        const std::string text = value.is_string()         ? value.get<std::string>()
                                 : value.is_boolean()      ? "off"
                                 : value.is_number_float() ? fmt::format("{}", value.get<double>())
                                                           : value.dump();
        page += fmt::format("| `--{}` | {} | {} | {} |\n", setting.name, setting.help,
                            rangeOf(setting).empty() ? "(a flag)" : rangeOf(setting), text);
    }
    return page;
}

}  // namespace gnomon::app
