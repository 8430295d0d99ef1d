// The floors of passes. Each counts what has to move if every byte is read or written once per pass, and all else comes
// from caches:
//
//     receivers  4 B of depth of every pixel; 4 B of face normal and 2 B of receiver flags of those that show geometry
//                (taken as all 64 of every tile that shows any)
//     lights     96 B of every visible light, and 32 B of the host's own data while lighting
//     lists      4 B per tile for each of counts and SlotIDs; early entries 4/3 B, their tiles as much, final entries 4
//     B queues     4 B of every pair of tile and light, written by one pass and read by the next slots      64 B (32 B
//     with 4 bits) of every stored pair; what a search hands on in a slot, 32 B shadowmap  of every pair of pixel and
//     casting light the filter's samples, and 4 B: shadow views are sized to
//                about a texel per pixel, and neighbours share their taps
//
// Samples take the time of the device's rate for them. Fetches, and gathers of PCF, are coherent: neighbouring pixels
// read neighbouring texels. Gathers of PCSS are scattered: every pixel turns its pattern of taps another way.
//
// Pairs of pixel and casting light are counted as 64 per casting entry of the early lists. That is an upper bound.
// - Pixels that the light does not reach, or whose face looks away from it, take no samples.
// - With lists by froxel there are also entries of lights that reach no pixel of the tile. They take none at all.
// - Searches end early, and narrow penumbrae take fewer taps with "pcss-shared".
// No statistic counts any of these. So the floor of a pass that evaluates shadows may lie above its time.
// Mixed tiles are those with a slot, and the filters' share of them is taken as their share of the lights.
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
constexpr double kSearchedBytes = 2.0 * gpu::kQuadsPerTile;  // what search_pairs tells of a pair

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

double mixedPairs(const FrameCounts& c) {
    return std::min(c.slots, c.earlyCastingEntries);
}

// Of so many pairs of tile and light.
PassNeed samples(const Samples& s, double pairs) {
    const double pixels = kTilePixels * pairs;
    return {0.0, s.fetches * pixels, s.gathers * pixels, s.scatteredGathers * pixels};
}

PassNeed shadowViews(const FrameCounts& c) {
    return {sizeof(gpu::GpuShadowView) * c.shadowViews, 0.0, 0.0};
}

PassNeed searches(const FrameCounts& c, const FilterWork& work, double times = 1.0) {
    PassNeed need = samples(work.always, times * c.earlyCastingEntries);
    need.bytes = kTexelBytes * kTilePixels * work.share * c.earlyCastingEntries;
    return need;
}

PassNeed filtersIfMixed(const FrameCounts& c, const FilterWork& work) {
    return samples(work.ifMixed, mixedPairs(c));
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
// Where entries lie says nothing of their tiles: phase 4, which walks list space, reads them.
PassNeed earlyListAndTiles(double entries) {
    return {2.0 * kEarlyEntryBytes * entries, 0.0, 0.0};
}
PassNeed finalList(const FrameCounts& c) {
    return {kWordBytes * c.finalEntries + c.slotBytes * c.slots, 0.0, 0.0};
}

// --- Phase 4 ---------------------------------------------------------------------------------------------------------

double litEntries(const FrameCounts& c) {
    return c.earlyEntries - c.earlyCastingEntries;  // of lights without shadows
}

PassNeed filterTiles(const FrameCounts& c, const FilterWork& work) {
    const PassNeed results = {kWordBytes * (litEntries(c) + work.share * c.earlyCastingEntries) +
                              c.slotBytes * work.share * mixedPairs(c)};
    return receivers(c, true) + lights(c) + listWords(c, 2) + earlyList(c) + shadowViews(c) + searches(c, work) +
           results;  // SlotIDs and early counts
}

PassNeed classifyPairs(const FrameCounts& c, const FilterNeeds& filters) {
    const double queued = (filters.byPixel.share + filters.byQuad.share) * c.earlyCastingEntries;
    const double lit = filters.byTile.share > 0.0 ? 0.0 : litEntries(c);  // else filter_tiles writes them
    const PassNeed results = {kWordBytes * (queued + lit)};
    return lights(c) + listWords(c, 2) + earlyListAndTiles(c.earlyEntries) + results;
}

// Places in queues, and what is found at them.
PassNeed pairs(double count) {
    return PassNeed{kWordBytes * count} + earlyListAndTiles(count);
}

// Receivers of tiles that have pairs.
PassNeed receiversOfPairs(const FrameCounts& c) {
    const double geometry = geometryPixels(c);
    return {(kDepthBytes + kFlagsBytes + kFaceNormalBytes) * geometry, 3.0 * geometry, 0.0};
}

PassNeed searchPairs(const FrameCounts& c, const FilterWork& byQuad) {
    const double count = byQuad.share * c.earlyCastingEntries, mixed = byQuad.share * mixedPairs(c);
    const PassNeed results = {kWordBytes * count + (kWordBytes + kSearchedBytes) * mixed};
    return receiversOfPairs(c) + lights(c) + pairs(count) + shadowViews(c) + searches(c, byQuad) + results;
}

PassNeed filterPairs(const FrameCounts& c, const FilterNeeds& filters) {
    const FilterWork &own = filters.byPixel, &shared = filters.byQuad;
    const double ownCount = own.share * c.earlyCastingEntries, sharedCount = shared.share * mixedPairs(c);
    const double stored = (own.share + shared.share) * mixedPairs(c);
    const PassNeed results = {kWordBytes * (ownCount + sharedCount) + c.slotBytes * stored};
    const PassNeed searched = {(kSearchedBytes + kTexelBytes * kTilePixels) * sharedCount};
    return receiversOfPairs(c) + lights(c) + pairs(ownCount + sharedCount) + shadowViews(c) + searches(c, own) +
           filtersIfMixed(c, own) + searched + filtersIfMixed(c, shared) + results;
}

// While lighting, each pixel makes the whole search of its quad.
PassNeed inlineShadows(const FrameCounts& c, const FilterNeeds& filters) {
    return shadowViews(c) + searches(c, filters.byTile) + searches(c, filters.byPixel) +
           filtersIfMixed(c, filters.byPixel) + searches(c, filters.byQuad, 4.0) + filtersIfMixed(c, filters.byQuad);
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

std::optional<PassNeed> needOf(const std::string& pass, const FrameCounts& c, const FilterNeeds& filters) {
    const PassNeed ranges = {kDepthRangeBytes * c.tiles, 0.0, 0.0};
    const PassNeed groupMasks = {kMaskEntryBytes * c.tileGroups, 0.0, 0.0};
    const PassNeed masks = {kMaskEntryBytes * c.maskTiles + kWordBytes * gpu::kZBinWords, 0.0, 0.0};
    // Approximate counts, SlotIDs, early and final counts; the lists.
    const PassNeed lists = listWords(c, 4) + earlyListAndTiles(c.earlyEntries);
    if (pass == "hierarchical_depth") return PassNeed{kDepthBytes * c.pixels, c.pixels, 0.0} + ranges;
    if (pass == "find_lights_approximate")
        return ranges + masks + lights(c) + groupMasks + (c.listsByFroxel ? lists : listWords(c, 1));
    if (pass == "find_lights_accurate") return receivers(c, true) + ranges + masks + groupMasks + lights(c) + lists;
    if (pass == "filter_tiles") return filterTiles(c, filters.byTile);
    if (pass == "classify_pairs") return classifyPairs(c, filters);
    if (pass == "search_pairs") return searchPairs(c, filters.byQuad);
    if (pass == "filter_pairs") return filterPairs(c, filters);
    if (pass == "lighting") return receivers(c, false) + surfaces(c) + lights(c) + listWords(c, 2) + finalList(c);
    if (pass == "lighting_inline")
        return receivers(c, true) + surfaces(c) + lights(c) + listWords(c, 2) + earlyList(c) +
               inlineShadows(c, filters);
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
