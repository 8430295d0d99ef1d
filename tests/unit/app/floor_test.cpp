// The arithmetic of the tables: spreads of times, and what a pass cannot do without.
#include "app/bench/floor.h"

#include <gtest/gtest.h>

#include "app/bench/spread.h"

namespace gnomon::app {
namespace {

TEST(Spread, IsOfNearestRanks) {
    EXPECT_EQ(spreadOf({}).median, 0.0);
    const Spread one = spreadOf({7.0});
    EXPECT_EQ(one.median, 7.0);
    EXPECT_EQ(one.min, 7.0);
    EXPECT_EQ(one.p95, 7.0);
    std::vector<double> values;
    for (int i = 200; i >= 1; --i) values.push_back(i);
    const Spread many = spreadOf(values);
    EXPECT_EQ(many.min, 1.0);
    EXPECT_EQ(many.median, 100.0);
    EXPECT_EQ(many.p95, 190.0);
}

TEST(Floor, CountsWhatFollowsFromTheExtent) {
    const FrameCounts counts = frameCounts(3840, 2160);
    EXPECT_EQ(counts.pixels, 8'294'400.0);
    EXPECT_EQ(counts.tiles, 129'600.0);
    EXPECT_EQ(counts.tileGroups, 2'040.0);
    EXPECT_EQ(counts.maskTiles, 8'160.0);
    EXPECT_EQ(frameCounts(1, 9).tiles, 2.0);
}

TEST(Floor, IsTheLongerOfMemoryAndTexture) {
    const renderer::DeviceRates rates = {100.0, {10.0, 1.0}, {5.0, 2.0}};
    EXPECT_DOUBLE_EQ(floorMs({50.0, 0.0, 0.0, 0.0}, rates), 500.0);
    EXPECT_DOUBLE_EQ(floorMs({50.0, 10.0, 5.0, 0.0}, rates), 2000.0);
    EXPECT_DOUBLE_EQ(floorMs({50.0, 10.0, 5.0, 3.0}, rates), 3500.0);  // scattered gathers have a rate of their own
    EXPECT_DOUBLE_EQ(floorMs({400.0, 10.0, 5.0, 3.0}, rates), 4000.0);
}

// One tile wide open. Two casting lights of six; half of the casting lights have each of two filters.
FrameCounts oneTile() {
    FrameCounts counts = frameCounts(8, 8);
    counts.tilesWithGeometry = 1;
    counts.visibleLights = 2;
    counts.shadowViews = 3;
    counts.earlyEntries = 6;
    counts.earlyCastingEntries = 2;
    counts.finalEntries = 5;
    counts.slots = 1;
    return counts;
}

constexpr double kReceivers = 64 * (4 + 4 + 2), kLights = 2 * 96, kViews = 3 * 208, kEarlyList = 8;

TEST(Floor, OfOneTileByHand) {
    const FrameCounts counts = oneTile();
    const PassNeed hierarchical = *needOf("hierarchical_depth", counts, {});
    EXPECT_DOUBLE_EQ(hierarchical.bytes, 64 * 4 + 8);
    EXPECT_DOUBLE_EQ(hierarchical.fetches, 64);

    const PassNeed lighting = *needOf("lighting", counts, {});
    EXPECT_DOUBLE_EQ(lighting.bytes, 64 * (4 + 2) + 64 * (16 + 8) + 2 * 32 + kLights + 2 * 4 + 5 * 4 + 64);
    EXPECT_DOUBLE_EQ(lighting.fetches, 6 * 64);
    EXPECT_DOUBLE_EQ(lighting.gathers, 0);
    EXPECT_DOUBLE_EQ(lighting.scatteredGathers, 0);
}

// The phase that writes the lists writes four words of every tile, and of every entry its index and its tile.
TEST(Floor, OfTheListsByHand) {
    FrameCounts counts = oneTile();
    const double masks = 132 + 4 * 2048, ranges = 8, groupMasks = 132, lists = 4 * 4 + 2 * kEarlyList;
    EXPECT_DOUBLE_EQ(needOf("find_lights_approximate", counts, {})->bytes,
                     ranges + masks + kLights + groupMasks + lists);
    counts.listsByFroxel = false;
    EXPECT_DOUBLE_EQ(needOf("find_lights_approximate", counts, {})->bytes, ranges + masks + kLights + groupMasks + 4);
    EXPECT_DOUBLE_EQ(needOf("find_lights_accurate", counts, {})->bytes,
                     kReceivers + ranges + masks + groupMasks + kLights + lists);
}

TEST(Floor, OfFiltersByTileByHand) {
    FilterNeeds filters;
    filters.byTile = {1.0, {1.0, 4.0, 0.0}, {}};
    const PassNeed tiles = *needOf("filter_tiles", oneTile(), filters);
    const double texels = 2 * 64 * 4, results = 6 * 4 + 64;
    EXPECT_DOUBLE_EQ(tiles.bytes, kReceivers + kLights + 2 * 4 + kEarlyList + kViews + texels + results);
    EXPECT_DOUBLE_EQ(tiles.fetches, 3 * 64 + 2 * 64);
    EXPECT_DOUBLE_EQ(tiles.gathers, 2 * 64 * 4);
    // With tiles, lights without shadows are theirs: nothing is left to be queued.
    EXPECT_DOUBLE_EQ(needOf("classify_pairs", oneTile(), filters)->bytes, kLights + 2 * 4 + 2 * kEarlyList);
}

TEST(Floor, OfFiltersByPixelByHand) {
    FilterNeeds filters;
    filters.byPixel = {1.0, {0.0, 0.0, 3.0}, {0.0, 0.0, 9.0}};
    EXPECT_DOUBLE_EQ(needOf("classify_pairs", oneTile(), filters)->bytes,
                     kLights + 2 * 4 + 2 * kEarlyList + 4 * (2 + 4));  // two pairs are queued, four lights are lit

    const PassNeed pairs = *needOf("filter_pairs", oneTile(), filters);
    const double queued = 2 * (4 + 8.0 / 3), texels = 2 * 64 * 4, results = 2 * 4 + 64;
    EXPECT_DOUBLE_EQ(pairs.bytes, kReceivers + kLights + queued + kViews + texels + results);
    EXPECT_DOUBLE_EQ(pairs.fetches, 3 * 64);
    EXPECT_DOUBLE_EQ(pairs.gathers, 0);
    EXPECT_DOUBLE_EQ(pairs.scatteredGathers, 2 * 64 * 3 + 64 * 9);

    const PassNeed inlined = *needOf("lighting_inline", oneTile(), filters);
    EXPECT_DOUBLE_EQ(inlined.scatteredGathers, pairs.scatteredGathers);
    EXPECT_DOUBLE_EQ(inlined.fetches, 64 * (3 + 4));
}

TEST(Floor, OfFiltersByQuadByHand) {
    FilterNeeds filters;
    filters.byQuad = {1.0, {0.0, 0.0, 3.0}, {0.0, 0.0, 9.0}};
    const PassNeed search = *needOf("search_pairs", oneTile(), filters);
    const double perPair = 4 + 8.0 / 3, texels = 64 * 4, found = 16 * 2;
    EXPECT_DOUBLE_EQ(search.bytes,
                     kReceivers + kLights + 2 * perPair + kViews + 2 * texels + 2 * 4 + (4 + found));  // one is mixed
    EXPECT_DOUBLE_EQ(search.scatteredGathers, 2 * 64 * 3);

    const PassNeed filter = *needOf("filter_pairs", oneTile(), filters);
    EXPECT_DOUBLE_EQ(filter.bytes, kReceivers + kLights + perPair + kViews + texels + found + 4 + 64);
    EXPECT_DOUBLE_EQ(filter.scatteredGathers, 64 * 9);

    // While lighting, every pixel searches for its quad.
    EXPECT_DOUBLE_EQ(needOf("lighting_inline", oneTile(), filters)->scatteredGathers, 4 * 2 * 64 * 3 + 64 * 9);
}

// Filters take turns: each is in its own pass, and inline shading has them all.
TEST(Floor, OfSeveralFiltersIsTheSum) {
    FilterNeeds filters;
    filters.byTile = {0.5, {0.5, 2.0, 0.0}, {}};
    filters.byPixel = {0.25, {0.0, 0.0, 4.0}, {0.0, 0.0, 8.0}};
    filters.byQuad = {0.25, {0.0, 0.0, 1.0}, {0.0, 0.0, 6.0}};
    const auto needed = [&](const char* pass) { return *needOf(pass, oneTile(), filters); };
    EXPECT_DOUBLE_EQ(needed("filter_tiles").gathers, 2 * 64 * 2.0);
    EXPECT_DOUBLE_EQ(needed("search_pairs").scatteredGathers, 2 * 64 * 1.0);
    EXPECT_DOUBLE_EQ(needed("filter_pairs").scatteredGathers, 2 * 64 * 4.0 + 64 * (8 + 6));
    EXPECT_DOUBLE_EQ(needed("lighting_inline").gathers, 2 * 64 * 2.0);
    EXPECT_DOUBLE_EQ(needed("lighting_inline").scatteredGathers, 2 * 64 * (4 + 4 * 1) + 64 * (8 + 6));
}

TEST(Floor, IsNotGuessed) {
    for (const char* pass : {"lighting_evaluate", "gather_statistics", "generate_shadows", "gbuffer", ""})
        EXPECT_FALSE(needOf(pass, frameCounts(8, 8), {}).has_value()) << pass;
}

}  // namespace
}  // namespace gnomon::app
