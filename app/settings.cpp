#include "app/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "app/errors.h"
#include "app/progress.h"
#include "gpu_interface/numbers.h"

namespace gnomon::app {
namespace {

constexpr std::uint32_t kMostPoolEntries = 1u << 30;
// The paper's footnote 3.
constexpr renderer::HardwareBias kPaperBias = {.slopeFactor = 1.0f};
// With 32-bit reversed Z about 0.04 % of the distance to the light, and twice the triangle's slope.
constexpr renderer::HardwareBias kTypicalHardwareBias = {.constantFactor = 4096.0f, .slopeFactor = 2.0f};

// All of `text` as a number from 1 to `most`; 0 otherwise.
std::uint32_t positiveInteger(std::string_view text, std::uint32_t most) {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool good = error == std::errc() && end == text.data() + text.size() && value <= most;
    return good ? value : 0;
}

PcssTaps parseTaps(const std::string& text) {
    if (text == "low") return kPcssLow;
    if (text == "medium") return kPcssMedium;
    if (text == "high") return kPcssHigh;
    const std::size_t comma = text.find(',');
    PcssTaps taps = {0, 0};
    if (comma != std::string::npos) {
        taps.searchTaps = positiveInteger(std::string_view(text).substr(0, comma), gpu::kMaxPcssTaps);
        taps.filterTaps = positiveInteger(std::string_view(text).substr(comma + 1), gpu::kMaxPcssTaps);
    }
    if (taps.searchTaps == 0 || taps.filterTaps == 0)
        throw UsageError(
            fmt::format("'{}' are no taps: give low, medium, high or SEARCH,FILTER as in 16,24, each from 1 to {}.",
                        text, gpu::kMaxPcssTaps));
    return taps;
}

// CONSTANT,SLOPE or CONSTANT,SLOPE,CLAMP.
renderer::HardwareBias parseHardwareBias(const std::string& text) {
    float values[3] = {};
    const char *at = text.data(), *const end = at + text.size();
    std::size_t count = 0;
    bool good = !text.empty();
    while (good && count < 3) {
        const auto [next, error] = std::from_chars(at, end, values[count]);
        good = error == std::errc() && values[count] >= 0.0f && values[count] <= 1e9f;
        ++count;
        at = next;
        if (!good || at == end) break;
        good = *at++ == ',' && at != end;
    }
    if (!good || at != end || count < 2)
        throw UsageError(
            fmt::format("'{}' is no hardware bias: give CONSTANT,SLOPE or CONSTANT,SLOPE,CLAMP, each at least 0, as in "
                        "4096,2 or 0,1,0.01.",
                        text));
    return {values[0], values[1], values[2]};
}

void parseSize(const std::string& text, std::uint32_t& width, std::uint32_t& height) {
    const std::size_t cross = text.find('x');
    if (cross != std::string::npos) {
        width = positiveInteger(std::string_view(text).substr(0, cross), kMostPixelsAcross);
        height = positiveInteger(std::string_view(text).substr(cross + 1), kMostPixelsAcross);
    }
    if (cross == std::string::npos || width == 0 || height == 0)
        throw UsageError(fmt::format("'{}' is no size: give WIDTHxHEIGHT as in 1280x720, each from 1 to {} pixels.",
                                     text, kMostPixelsAcross));
}

}  // namespace

CLI::Validator numberWithin(double low, double high) {
    const std::string range = fmt::format("FLOAT in [{:g} - {:g}]", low, high);
    return {[low, high](const std::string& text) {
                double value = 0.0;
                const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
                const bool good =
                    error == std::errc() && end == text.data() + text.size() && low <= value && value <= high;
                return good ? std::string() : fmt::format("'{}' is no number from {:g} to {:g}", text, low, high);
            },
            range};
}

namespace {

void addBiasSettings(CLI::App& command, Settings& s) {
    command
        .add_option(
            "--bias", s.bias,
            "Depth bias: oriented; oriented-constant (one depth for all texels, maps drawn with slope factor 1); paper "
            "(that, and faces that look away ask the map, too: its listing 7); hardware (maps drawn "
            "with factors 4096 and 2); hardware-no-normals (and faces that look away ask the map too); none")
        ->check(CLI::IsMember(biasNames()))
        ->capture_default_str();
    command
        .add_option("--hardware-bias", s.hardwareBias,
                    "CONSTANT,SLOPE[,CLAMP] to draw shadowmaps with, in place of what --bias has")
        ->check([](const std::string& text) { return text.empty() ? "'' is no hardware bias" : std::string(); });
    command.add_option("--bias-metres", s.biasMetres, "Oriented bias of lights that state none")
        ->check(numberWithin(0.0, 1000.0))
        ->capture_default_str();
    command.add_flag("--subsurface-fronts", s.subsurfaceFronts,
                     "Draw subsurface casters with the faces that look at the light, and bias subsurface pixels by "
                     "--subsurface-bias");
    command.add_option("--subsurface-bias", s.subsurfaceBiasMetres, "Metres, with --subsurface-fronts")
        ->check(numberWithin(0.0, 1000.0))
        ->needs("--subsurface-fronts")
        ->capture_default_str();
    command.add_option("--face-normals", s.faceNormals, "From the G-buffer, or derived from its depth")
        ->check(CLI::IsMember({"stored", "derived"}))
        ->capture_default_str();
}

}  // namespace

void addSettings(CLI::App& command, Settings& s) {
    command.add_option("scene", s.scene, "A built-in scene or a .gltf or .glb file")->capture_default_str();
    command.add_option("--size", s.size, "WIDTHxHEIGHT in pixels")->capture_default_str();
    command.add_option("--camera", s.camera, "A camera's name, #index, or eye:target[:degrees] as in 0,3,8:0,1,0:60")
        ->capture_default_str();
    command.add_option("--time", s.time, "Seconds into the scene's animations, of the first frame")
        ->check(numberWithin(-1e9, 1e9))
        ->capture_default_str();
    command.add_option("--animation", s.animation, "The animation to play: its name, #index, default or none")
        ->capture_default_str();
    command.add_option("--lights", s.lights, "Scatter so many shadowed lights over the scene")
        ->check(CLI::Range(0u, kMostLights));
    command
        .add_option(
            "--light-density", s.lightDensity,
            "Shadowed lights per tile, in the mean, that --lights shall give in this picture; they take the place "
            "of the scene's own point and spot lights")
        ->check(numberWithin(0.1, 64.0))
        ->needs("--lights");
    command.add_option("--seed", s.seed, "Of scattered lights, and of what verify chooses by chance")
        ->check(CLI::Range(std::int64_t{0}, std::int64_t{0xFFFFFFFF}))
        ->capture_default_str();
    command.add_option("--filter", s.filter, "Shadow filter")
        ->check(CLI::IsMember({"hard", "pcf", "pcss"}))
        ->capture_default_str();
    command.add_option("--pcf-radius", s.pcfRadius, "Texels")->check(CLI::Range(1, 3))->capture_default_str();
    command
        .add_option("--pcss-taps", s.taps,
                    "low, medium, high, or SEARCH,FILTER: taps of the search and of the filter, as in 16,24")
        ->capture_default_str();
    command.add_flag("--pattern-per-frame", s.patternPerFrame, "Turn the sample pattern of pcss from frame to frame");
    command.add_flag("--no-shadow-bounds", s.noShadowBounds,
                     "pcss searches everywhere, also where the bounds of the shadowmaps tell the result");
    command.add_option("--visibility-bits", s.visibilityBits, "Bits of a pixel's visibility in a slot")
        ->check(CLI::IsMember({4, 8}))
        ->capture_default_str();
    addBiasSettings(command, s);
    command.add_option("--device", s.device, "Index or part of the name of a Vulkan device (see: gnomon devices)");
    command.add_flag("--validate", s.validate, "Run under the validation layers; any message is a failure");
    command.add_flag_callback("--quiet", silenceProgress, "No progress on stderr");
    command.add_option("--list-entries", s.listEntries, "Capacity of the light lists; 0: 8 per tile")
        ->check(CLI::Range(0u, kMostPoolEntries));
    command.add_option("--visibility-slots", s.visibilitySlots, "Capacity of the visibility slots; 0: 8 per tile")
        ->check(CLI::Range(0u, kMostPoolEntries));
    command.add_option("--reservation", s.reservation, "How space in the light lists is given out")
        ->check(CLI::IsMember({"approximate", "accurate", "fixed"}))
        ->capture_default_str();
    command.add_option("--subgroup-size", s.subgroupSize, "Lanes; 0: the device's own choice")
        ->check(CLI::IsMember({0, 4, 8, 16, 32, 64}));
    command.add_option("--depth", s.depth, "Depth buffer of the camera")
        ->check(CLI::IsMember({"reversed", "standard"}))
        ->capture_default_str();
    command.add_option("--atlas", s.atlas, "Shadow atlas, pixels across; 0: by resolution")
        ->check(CLI::IsMember({0, 256, 512, 1024, 2048, 4096, 8192, 16384}));
    command.add_flag("--unquantised", s.unquantised, "Inline shadows without the 8 bits of a visibility slot");
}

const std::vector<std::string>& biasNames() {
    static const std::vector<std::string> names = {"oriented", "oriented-constant",   "paper",
                                                   "hardware", "hardware-no-normals", "none"};
    return names;
}

void setBias(const std::string& name, renderer::RendererDesc& desc) {
    if (std::ranges::find(biasNames(), name) == biasNames().end())
        throw UsageError(fmt::format("There is no depth bias '{}': choose {}.", name, fmt::join(biasNames(), ", ")));
    const bool constant = name == "oriented-constant" || name == "paper";
    desc.depthBias = name == "oriented" ? DepthBias::Oriented
                     : constant         ? DepthBias::OrientedConstant
                                        : DepthBias::Unbiased;
    desc.facedAwayIsDark = name != "paper" && name != "hardware-no-normals";
    desc.shadowDrawing.bias = constant                       ? kPaperBias
                              : name.starts_with("hardware") ? kTypicalHardwareBias
                                                             : renderer::HardwareBias{};
}

renderer::RendererDesc rendererDescOf(const Settings& s) {
    renderer::RendererDesc desc;
    parseSize(s.size, desc.widthPx, desc.heightPx);
    desc.filter = s.filter == "hard" ? Filter::Hard : s.filter == "pcf" ? Filter::Pcf : Filter::Pcss;
    desc.pcfRadius = s.pcfRadius;
    desc.pcss = parseTaps(s.taps);
    desc.patternPerFrame = s.patternPerFrame;
    desc.visibilityBits = s.visibilityBits;
    desc.shadowBounds = !s.noShadowBounds && desc.filter == Filter::Pcss;
    setBias(s.bias, desc);
    if (!s.hardwareBias.empty()) desc.shadowDrawing.bias = parseHardwareBias(s.hardwareBias);
    desc.shadowDrawing.subsurfaceFronts = s.subsurfaceFronts;
    desc.biasMetres = s.biasMetres;
    desc.subsurfaceBiasMetres = s.subsurfaceBiasMetres;
    desc.readFaceNormals = s.faceNormals == "stored";
    desc.listReservation = s.reservation == "accurate" ? ListReservation::Accurate
                           : s.reservation == "fixed"  ? ListReservation::Fixed
                                                       : ListReservation::Approximate;
    desc.subgroupSize = s.subgroupSize;
    desc.listEntries = s.listEntries;
    desc.visibilitySlots = s.visibilitySlots;
    desc.atlasSizePx = s.atlas;
    desc.deviceDepth = s.depth == "standard" ? DeviceDepth::StandardZ : DeviceDepth::ReversedZ;
    desc.quantiseInline = !s.unquantised;
    return desc;
}

renderer::ShadowMode shadowModeOf(const std::string& name) {
    if (name == "deferred") return renderer::ShadowMode::Deferred;
    if (name == "inline") return renderer::ShadowMode::Inline;
    if (name == "off") return renderer::ShadowMode::Off;
    throw UsageError(fmt::format("'{}' is no way to shadow: choose deferred, inline or off.", name));
}

}  // namespace gnomon::app
