#include "app/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "app/errors.h"
#include "gpu_interface/numbers.h"
#include "scene/filter_names.h"

namespace gnomon::app {
namespace {

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

}  // namespace

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

float parseBiasMetres(const std::string& text) {
    float value = 0.0f;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool good =
        error == std::errc() && end == text.data() + text.size() && value >= 0.0f && value <= kMostBiasMetres;
    if (!good)
        throw UsageError(fmt::format("'{}' is no bias: give auto, or metres from 0 to {}.", text, kMostBiasMetres));
    return value;
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
    const std::uint32_t tiles =
        gpu::divideRoundingUp(width, gpu::kShadowTileSizePx) * gpu::divideRoundingUp(height, gpu::kShadowTileSizePx);
    if (tiles > kMostTiles)
        throw UsageError(
            fmt::format("'{}' has {} tiles of 8x8 pixels, and a picture may have {}.", text, tiles, kMostTiles));
}

const std::vector<std::string>& biasNames() {
    static const std::vector<std::string> names = {"oriented", "oriented-constant",   "paper",
                                                   "hardware", "hardware-no-normals", "none"};
    return names;
}

void setBias(const std::string& name, renderer::FrameSettings& settings) {
    if (std::ranges::find(biasNames(), name) == biasNames().end())
        throw UsageError(fmt::format("There is no depth bias '{}': choose {}.", name, fmt::join(biasNames(), ", ")));
    const bool constant = name == "oriented-constant" || name == "paper";
    settings.shadows.depthBias = name == "oriented" ? DepthBias::Oriented
                                 : constant         ? DepthBias::OrientedConstant
                                                    : DepthBias::Unbiased;
    settings.shadows.facedAwayIsDark = name != "paper" && name != "hardware-no-normals";
    settings.drawing.bias = constant                       ? kPaperBias
                            : name.starts_with("hardware") ? kTypicalHardwareBias
                                                           : renderer::HardwareBias{};
}

std::vector<Filter> filtersOf(const std::string& text) {
    std::vector<Filter> filters;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t comma = std::min(text.find(',', at), text.size());
        const std::string name = text.substr(at, comma - at);
        at = comma + 1;
        const std::optional<Filter> filter = filterNamed(name);
        if (!filter)
            throw UsageError(
                fmt::format("There is no shadow filter '{}': choose hard, pcf, pcss or pcss-shared, or several as in "
                            "hard,pcss.",
                            name));
        filters.push_back(*filter);
    }
    return filters;
}

bool allSoft(const std::vector<Filter>& filters) {
    return std::ranges::all_of(filters, isSoft);
}

void parsePresets(const std::string& text, ShadowSettings& shadows) {
    shadows.pcssPresetCount = 0;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t slash = std::min(text.find('/', at), text.size());
        if (shadows.pcssPresetCount == kMaxPcssPresets)
            throw UsageError(fmt::format("'{}' has more than {} sets of taps.", text, kMaxPcssPresets));
        shadows.pcssPresets[shadows.pcssPresetCount++] = parseTaps(text.substr(at, slash - at));
        at = slash + 1;
    }
}

namespace {

renderer::FrameSettings frameSettingsOf(const Settings& s) {
    renderer::FrameSettings f;
    parseSize(s.size, f.widthPx, f.heightPx);
    f.filters = filtersOf(s.filter);
    f.shadows.pcfRadius = s.pcfRadius;
    parsePresets(s.taps, f.shadows);
    f.shadows.patternPerFrame = s.patternPerFrame;
    f.shadows.visibilityBits = s.visibilityBits;
    f.shadows.shadowBounds = !s.noShadowBounds;
    f.shadows.lightLists = s.lightLists == "pixel" ? LightLists::Pixel : LightLists::Froxel;
    f.shadows.listReservation = s.reservation == "accurate" ? ListReservation::Accurate
                                : s.reservation == "fixed"  ? ListReservation::Fixed
                                                            : ListReservation::Approximate;
    f.shadows.fixedListEntriesPerTile = s.reservation == "fixed" ? kFixedListEntriesPerTile : 0;
    setBias(s.bias, f);
    if (!s.hardwareBias.empty()) f.drawing.bias = parseHardwareBias(s.hardwareBias);
    f.drawing.subsurfaceFronts = s.subsurfaceFronts;
    if (s.biasMetres != "auto") f.biasMetres = parseBiasMetres(s.biasMetres);
    f.subsurfaceBiasMetres = s.subsurfaceBiasMetres;
    f.readFaceNormals = s.faceNormals == "stored";
    f.deviceDepth = s.depth == "standard" ? DeviceDepth::StandardZ : DeviceDepth::ReversedZ;
    f.inlineVariant.quantises = !s.unquantised;
    f.history = s.history == "on";
    f.faceGuardTexels = s.faceGuardTexels;
    return f;
}

}  // namespace

renderer::RendererDesc rendererDescOf(const Settings& s) {
    renderer::RendererDesc desc;
    desc.frame = frameSettingsOf(s);
    desc.subgroupSize = s.subgroupSize;
    desc.listEntries = s.listEntries;
    desc.visibilitySlots = s.visibilitySlots;
    desc.mostListEntries = s.mostListEntries;
    desc.mostVisibilitySlots = s.mostVisibilitySlots;
    desc.atlasSizePx = s.atlas;
    return desc;
}

renderer::ShadowMode shadowModeOf(const std::string& name) {
    if (name == "deferred") return renderer::ShadowMode::Deferred;
    if (name == "inline") return renderer::ShadowMode::Inline;
    if (name == "off") return renderer::ShadowMode::Off;
    throw UsageError(fmt::format("'{}' is no way to shadow: choose deferred, inline or off.", name));
}

}  // namespace gnomon::app
