#pragma once
// The settings that `render`, `verify` and `bench` share: which scene, seen how, drawn by what. settings_table.h says
// what each may be.

#include <cstdint>
#include <string>
#include <vector>

#include "gpu_interface/packing.h"
#include "renderer/renderer.h"

namespace CLI {
class App;
}

namespace gnomon::app {

inline constexpr std::uint32_t kMostPixelsAcross = 16384;
/// Tiles of a picture: the library counts list space in 32 bits, and any tile may have all lights of a view.
inline constexpr std::uint32_t kMostTiles = 0xFFFFFFFFu / gpu::roundUpToEarlyWord(gpu::kMaxLightsPerView);
inline constexpr float kMostBiasMetres = 1000.0f;
inline constexpr std::uint32_t kMostLights = 100'000;
inline constexpr std::uint32_t kMostFaceGuardTexels = 64;
inline constexpr std::uint32_t kFixedListEntriesPerTile = 32;  // with --reservation fixed

struct Settings {
    std::string scene = "courtyard";
    std::string size = "1280x720";
    std::string camera = "default";
    double time = 0.0;  // seconds, of the first frame
    std::string animation = "default";
    std::uint32_t lights = 0;
    float lightDensity = 0.0f;  // 0: by area, whatever the picture
    float sourceRadius = 0.0f;  // metres, of local lights that state none; 0: by what is nearest to each
    std::uint64_t seed = 1;
    std::vector<std::uint32_t> onlyLights;  // empty: all; a command's own option
    std::string ambient = "on";
    std::string filter = "pcss";
    std::uint32_t pcfRadius = 1;
    std::string taps = "medium";
    bool patternPerFrame = false;
    bool noShadowBounds = false;
    std::uint32_t visibilityBits = 8;
    bool unquantised = false;
    std::string bias = "oriented";
    std::string hardwareBias;         // empty: as `bias` has it
    std::string biasMetres = "auto";  // or a number
    float subsurfaceBiasMetres = 0.02f;
    bool subsurfaceFronts = false;
    std::string faceNormals = "stored";
    std::uint32_t atlas = 0;
    std::uint32_t faceGuardTexels = 0;
    std::string depth = "reversed";
    std::string history = "auto";  // "auto": bench has it, others have not
    std::uint32_t listEntries = 0, visibilitySlots = 0, mostListEntries = 0, mostVisibilitySlots = 0;
    std::string lightLists = "froxel";
    std::string reservation = "accurate";
    std::string device;
    std::uint32_t subgroupSize = 0;
    bool validate = false;
};

/// The scene and all rows of the table, by groups. After a command's own options, so that these come first in its help.
void addSettings(CLI::App& command, Settings& settings);

/// Animation time of a frame, counted from 0; without frames per second time stands still.
inline double frameTime(double firstSeconds, std::uint64_t frame, double framesPerSecond) {
    return framesPerSecond > 0.0 ? firstSeconds + static_cast<double>(frame) / framesPerSecond : firstSeconds;
}

const std::vector<std::string>& biasNames();
/// Sets how depths are biased, one of biasNames(), each with its own way to draw; throws UsageError otherwise.
void setBias(const std::string& name, renderer::FrameSettings& settings);

/// WIDTHxHEIGHT; throws UsageError where it is none, or where a view has no room for so many tiles.
void parseSize(const std::string& text, std::uint32_t& width, std::uint32_t& height);
/// Presets of taps parted by slashes; throws UsageError otherwise.
void parsePresets(const std::string& text, ShadowSettings& shadows);
/// Metres; throws UsageError otherwise.
float parseBiasMetres(const std::string& text);
/// CONSTANT,SLOPE or CONSTANT,SLOPE,CLAMP; throws UsageError otherwise.
renderer::HardwareBias parseHardwareBias(const std::string& text);
/// Filters parted by commas; throws UsageError where one is none.
std::vector<Filter> filtersOf(const std::string& text);
/// Whether soft truth is to be judged: every light has PCSS.
bool allSoft(const std::vector<Filter>& filters);

/// Throws UsageError on what no device could do.
renderer::RendererDesc rendererDescOf(const Settings& settings);

/// "deferred", "inline" or "off"; throws UsageError otherwise.
renderer::ShadowMode shadowModeOf(const std::string& name);

}  // namespace gnomon::app
