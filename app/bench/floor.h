#pragma once
// The floor of a compute pass. The pass cannot do without certain bytes and texture samples. The floor is the time that
// these take at the device's own measured rates (renderer/rates). Arithmetic is not in it.

#include <cstdint>
#include <optional>
#include <string>

#include "renderer/rates/device_rates.h"

namespace gnomon::app {

/// What a frame's statistics say of its amount of work.
struct FrameCounts {
    double pixels = 0, tiles = 0, tilesWithGeometry = 0, tileGroups = 0, maskTiles = 0;
    double visibleLights = 0, shadowViews = 0;
    double earlyEntries = 0, earlyCastingEntries = 0, finalEntries = 0, slots = 0;  // of (tile, light) pairs
    double slotBytes = 64;
    bool listsByFroxel = true;  // LightLists::Froxel: phase 2 writes the early lists
};
FrameCounts frameCounts(std::uint32_t widthPx, std::uint32_t heightPx);  // what follows from the extent

/// Samples of shadowmaps for one pixel and light.
struct Samples {
    double fetches = 0, gathers = 0;  // beside those of the neighbours
    double scatteredGathers = 0;      // in places of the pixel's own
};

/// What some of the frame's filters take. Samples are means over all casting lights: lights take turns with the
/// filters.
struct FilterWork {
    double share = 0;  // of the casting lights that have such a filter
    Samples always;    // of every pixel,
    Samples ifMixed;   // and more where the tile is neither wholly lit nor wholly dark
};

/// The frame's filters, by the passes that evaluate them.
struct FilterNeeds {
    FilterWork byTile;   // filter_tiles
    FilterWork byPixel;  // filter_pairs
    FilterWork byQuad;   // search_pairs searches, a quarter of it for each of 2x2 pixels, and filter_pairs filters
};

struct PassNeed {
    double bytes = 0, fetches = 0, gathers = 0, scatteredGathers = 0;
};
/// Nothing for passes whose amount of work no statistic tells.
std::optional<PassNeed> needOf(const std::string& pass, const FrameCounts& counts, const FilterNeeds& filters);

/// Memory and texture units work side by side, so it is the longer of the two.
double floorMs(const PassNeed& need, const renderer::DeviceRates& rates);

}  // namespace gnomon::app
