// The floors of passes. Each counts what has to move if every byte is read or written once per pass, and all else comes
// from caches:
//
//     receivers  4 B of depth of every pixel; 4 B of face normal and 2 B of receiver flags of those that show geometry
//                (taken as all 64 of every tile that shows any)
//     lights     96 B of every visible light, and 32 B of the host's own data while lighting
//     lists      4 B per tile for each of counts and SlotIDs; early entries 4/3 B, final entries 4 B
//     slots      64 B (32 B with 4 bits) of every stored pair of tile and light
//     shadowmap  of every pair of pixel and casting light the filter's samples, and 4 B: shadow views are sized to
//                about a texel per pixel, and neighbours share their taps
//
// Samples take the time of the device's rate for them. Fetches, and gathers of PCF, are coherent: neighbouring pixels
// read neighbouring texels. Gathers of PCSS are scattered: every pixel turns its pattern of taps another way.
//
// Pairs of pixel and casting light are counted as 64 per casting early entry. That is an upper bound. Pixels that the
// light does not reach, or whose face looks away from it, take no samples, and no statistic counts them. So the floor
// of a pass that evaluates shadows may lie above its time.
#include "app/bench/floor.h"

#include <algorithm>
#include <cmath>

#include "gpu_interface/numbers.h"
#include "gpu_interface/structs.h"
#include "renderer/lighting/lighting_data.h"

namespace gnomon::app {
namespace {

constexpr double kTilePixels = gpu::kShadowTileSizePx * gpu::kShadowTileSizePx;
constexpr double kMaskEntryBytes = 4.0 * gpu::kLightMaskEntryWords;
constexpr double kDepthRangeBytes = 8.0, kWordBytes = 4.0;
constexpr double kDepthBytes = 4.0, kFaceNormalBytes = 4.0, kFlagsBytes = 2.0;
constexpr double kSurfaceBytes = 4.0 * 4.0;  // base colour, shading normal, material, emissive
constexpr double kSurfaceFetches = 4.0;
constexpr double kPictureBytes = 8.0;
constexpr double kEarlyEntryBytes = kWordBytes / gpu::kEarlyIndicesPerWord;
constexpr double kTexelBytes = 4.0;

PassNeed operator+(const PassNeed& a, const PassNeed& b) {
    return {a.bytes + b.bytes, a.fetches + b.fetches, a.gathers + b.gathers, a.scatteredGathers + b.scatteredGathers};
}

double geometryPixels(const FrameCounts& c) {
    return std::min(c.pixels, kTilePixels * c.tilesWithGeometry);
}

PassNeed receivers(const FrameCounts& c, bool faceNormals) {
    const double geometry = geometryPixels(c);
    return {kDepthBytes * c.pixels + (kFlagsBytes + (faceNormals ? kFaceNormalBytes : 0.0)) * geometry,
            c.pixels + (faceNormals ? 2.0 : 1.0) * geometry, 0.0};
}

PassNeed lights(const FrameCounts& c) {
    return {sizeof(gpu::GpuLight) * c.visibleLights, 0.0, 0.0};
}

PassNeed shadows(const FrameCounts& c, const FilterSamples& s) {
    const double pairs = kTilePixels * c.earlyCastingEntries;
    const double mixed = std::min(kTilePixels * c.slots, pairs);
    return {kTexelBytes * pairs + sizeof(gpu::GpuShadowView) * c.shadowViews, s.fetches * pairs, s.gathers * pairs,
            s.scatteredGathers * pairs + s.scatteredIfMixed * mixed};
}

PassNeed surfaces(const FrameCounts& c) {
    const double geometry = geometryPixels(c);
    return {kSurfaceBytes * geometry + kPictureBytes * c.pixels + sizeof(renderer::HostLight) * c.visibleLights,
            kSurfaceFetches * geometry, 0.0};
}

PassNeed listWords(const FrameCounts& c, double words) {
    return {kWordBytes * words * c.tiles, 0.0, 0.0};
}
PassNeed earlyList(const FrameCounts& c) {
    return {kEarlyEntryBytes * c.earlyEntries, 0.0, 0.0};
}
PassNeed finalList(const FrameCounts& c) {
    return {kWordBytes * c.finalEntries + c.slotBytes * c.slots, 0.0, 0.0};
}

}  // namespace

FrameCounts frameCounts(std::uint32_t widthPx, std::uint32_t heightPx) {
    const auto over = [&](std::uint32_t size) {
        return std::ceil(static_cast<double>(widthPx) / size) * std::ceil(static_cast<double>(heightPx) / size);
    };
    FrameCounts counts;
    counts.pixels = static_cast<double>(widthPx) * heightPx;
    counts.tiles = over(gpu::kShadowTileSizePx);
    counts.tileGroups = over(gpu::kTileGroupSizePx);
    counts.maskTiles = over(gpu::kMaskTileSizePx);
    return counts;
}

std::optional<PassNeed> needOf(const std::string& pass, const FrameCounts& c, const FilterSamples& samples) {
    const PassNeed ranges = {kDepthRangeBytes * c.tiles, 0.0, 0.0};
    const PassNeed groupMasks = {kMaskEntryBytes * c.tileGroups, 0.0, 0.0};
    const PassNeed masks = {kMaskEntryBytes * c.maskTiles + kWordBytes * gpu::kZBinWords, 0.0, 0.0};
    if (pass == "hierarchical_depth") return PassNeed{kDepthBytes * c.pixels, c.pixels, 0.0} + ranges;
    if (pass == "find_lights_approximate") return ranges + masks + lights(c) + groupMasks + listWords(c, 1);  // counts
    if (pass == "find_lights_accurate")  // approximate counts; SlotIDs and early counts
        return receivers(c, true) + ranges + masks + groupMasks + lights(c) + listWords(c, 3) + earlyList(c);
    if (pass == "filter_pairs")  // SlotIDs and early counts; final counts
        return receivers(c, true) + lights(c) + listWords(c, 3) + earlyList(c) + shadows(c, samples) + finalList(c);
    if (pass == "lighting") return receivers(c, false) + surfaces(c) + lights(c) + listWords(c, 2) + finalList(c);
    if (pass == "lighting_inline")
        return receivers(c, true) + surfaces(c) + lights(c) + listWords(c, 2) + earlyList(c) + shadows(c, samples);
    if (pass == "lighting_unshadowed")
        return receivers(c, false) + surfaces(c) + lights(c) + listWords(c, 2) + earlyList(c);
    return std::nullopt;
}

double floorMs(const PassNeed& need, const renderer::DeviceRates& rates) {
    const double memory = need.bytes / rates.bytesPerSecond;
    const double texture = need.fetches / rates.fetches.coherent + need.gathers / rates.gathers.coherent +
                           need.scatteredGathers / rates.gathers.scattered;
    return 1e3 * std::max(memory, texture);
}

}  // namespace gnomon::app
