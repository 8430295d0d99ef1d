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

// One tile wide open: by hand.
TEST(Floor, OfOneTileByHand) {
    FrameCounts counts = frameCounts(8, 8);
    counts.tilesWithGeometry = 1;
    counts.visibleLights = 2;
    counts.shadowViews = 3;
    counts.earlyEntries = 6;
    counts.earlyCastingEntries = 2;
    counts.finalEntries = 5;
    counts.slots = 1;
    const FilterSamples filter = {1.0, 4.0, 3.0, 9.0};

    const PassNeed hierarchical = *needOf("hierarchical_depth", counts, filter);
    EXPECT_DOUBLE_EQ(hierarchical.bytes, 64 * 4 + 8);
    EXPECT_DOUBLE_EQ(hierarchical.fetches, 64);

    const PassNeed generate = *needOf("generate_shadows", counts, filter);
    const double receivers = 64 * (4 + 4 + 2), lights = 2 * 96, words = 3 * 4, early = 8, views = 3 * 208;
    EXPECT_DOUBLE_EQ(generate.bytes, receivers + lights + words + early + views + 2 * 64 * 4 + 5 * 4 + 64);
    EXPECT_DOUBLE_EQ(generate.fetches, 3 * 64 + 2 * 64);
    EXPECT_DOUBLE_EQ(generate.gathers, 2 * 64 * 4);
    EXPECT_DOUBLE_EQ(generate.scatteredGathers, 2 * 64 * 3 + 64 * 9);

    const PassNeed lighting = *needOf("lighting", counts, filter);
    EXPECT_DOUBLE_EQ(lighting.bytes, 64 * (4 + 2) + 64 * (16 + 8) + 2 * 32 + lights + 2 * 4 + 5 * 4 + 64);
    EXPECT_DOUBLE_EQ(lighting.fetches, 6 * 64);
    EXPECT_DOUBLE_EQ(lighting.gathers, 0);
    EXPECT_DOUBLE_EQ(lighting.scatteredGathers, 0);

    const PassNeed inlined = *needOf("lighting_inline", counts, filter);
    EXPECT_DOUBLE_EQ(inlined.gathers, generate.gathers);
    EXPECT_DOUBLE_EQ(inlined.scatteredGathers, generate.scatteredGathers);
    EXPECT_DOUBLE_EQ(inlined.fetches, 64 * (3 + 4) + 2 * 64);
}

TEST(Floor, IsNotGuessed) {
    for (const char* pass : {"lighting_evaluate", "gather_statistics", "gbuffer", ""})
        EXPECT_FALSE(needOf(pass, frameCounts(8, 8), {}).has_value()) << pass;
}

}  // namespace
}  // namespace gnomon::app
