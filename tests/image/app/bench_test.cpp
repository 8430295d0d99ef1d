// What the program measures. No time is compared with another: that is for benchmarks.

#include "unit/app/program.h"

namespace gnomon::app {
namespace {

class Benching : public Program {};

// Explicit options stand above the preset's; what it prints and writes is the same measurement.
TEST_F(Benching, PresetsGiveThePapersTables) {
    expectGood("bench boxes --preset table1 --size 64x64 --filter hard --warmup 1 --frames 3 --json table1.json");
    const nlohmann::json table1 = readJson("table1.json");
    EXPECT_EQ(table1["scene"], "boxes");
    EXPECT_EQ(table1["settings"]["filter"], "hard");
    EXPECT_EQ(table1["extent"], (nlohmann::json{64, 64}));
    ASSERT_EQ(table1["preset"]["rows"].size(), 2u);
    const nlohmann::json& deferred = table1["preset"]["rows"][1];
    EXPECT_EQ(deferred["paperMs"]["shadow"], 2.25);
    EXPECT_EQ(deferred["total"], table1["variants"]["deferred"]["shadowPhasesAndLighting"]);
    EXPECT_GT(deferred["shadow"]["medianMs"], 0.0);
    EXPECT_GT(deferred["lighting"]["medianMs"], 0.0);
    // The lists that were measured are by froxel. The paper counts by pixel: there are no more of these.
    EXPECT_GT(table1["meanShadowedLightsPerTileByPixel"], 0.0);
    EXPECT_LE(table1["meanShadowedLightsPerTileByPixel"], table1["meanShadowedLightsPerTile"]);

    expectGood("bench boxes --preset figure13 --size 64x64 --warmup 0 --frames 2 --json figure13.json");
    const nlohmann::json figure13 = readJson("figure13.json");
    EXPECT_EQ(figure13["variants"].size(), 1u);
    double percent = 0.0;
    for (const nlohmann::json& row : figure13["preset"]["rows"])
        if (!row["cpu"]) percent += row["percentOfGpu"].get<double>();
    // prepare, hierarchical_depth, find_lights_approximate, shadow_bounds, classify_pairs, filter_pairs, lighting
    EXPECT_EQ(figure13["preset"]["rows"].size(), 7u);
    EXPECT_NEAR(percent, 100.0, 1e-6);
}

// Inline shading is measured without its way out of full lists, so lists that are full are refused, not measured
// wrongly.
TEST_F(Benching, NeedsListsThatFit) {
    const std::string full = " --size 64x64 --warmup 0 --frames 1 --quiet --list-entries 1";
    expectGood("bench boxes --variants deferred" + full);
    const Outcome refused = run("bench boxes --variants deferred,inline" + full);
    EXPECT_EQ(refused.exitCode, 2);
    EXPECT_NE(refused.err.find("--list-entries"), std::string::npos) << refused.err;
}

TEST_F(Benching, PresetsSayWhereTheSceneIsUnlikeThePapers) {
    const std::string said = "That is outside 2.5 to 3.5";
    const std::string few = "--preset figure13 --size 64x64 --warmup 0 --frames 1";
    EXPECT_NE(run("bench courtyard " + few).out.find(said), std::string::npos);
}

TEST_F(Benching, FloorsAreMeasured) {
    expectGood("bench boxes --floor --size 64x64 --warmup 0 --frames 2 --validate --json out.json");
    const nlohmann::json json = readJson("out.json");
    for (const char* rate : {"copyBytesPerSecond", "coherentFetchesPerSecond", "scatteredFetchesPerSecond",
                             "coherentGathersPerSecond", "scatteredGathersPerSecond"})
        EXPECT_GT(json["rates"][rate], 0.0) << rate;
    const auto expectFloors = [](const nlohmann::json& passes, std::initializer_list<const char*> names) {
        for (const char* pass : names) {
            ASSERT_TRUE(passes.contains(pass)) << pass;
            EXPECT_GT(passes[pass]["floor"]["ms"], 0.0) << pass;
            EXPECT_GT(passes[pass]["floor"]["ratio"], 0.0) << pass;
        }
    };
    const nlohmann::json& passes = json["variants"]["deferred"]["passes"];
    expectFloors(passes,
                 {"hierarchical_depth", "find_lights_approximate", "classify_pairs", "filter_pairs", "lighting"});
    EXPECT_FALSE(passes["gbuffer"].contains("floor"));
    EXPECT_FALSE(passes.contains("find_lights_accurate")) << "lists by froxel have no phase 3";

    // All passes of phase 4, and phase 3.
    expectGood(
        "bench boxes --floor --filter hard,pcss,pcss-shared --light-lists pixel --variants deferred --size 64x64 "
        "--warmup 0 --frames 1 --json all.json");
    expectFloors(readJson("all.json")["variants"]["deferred"]["passes"],
                 {"find_lights_accurate", "filter_tiles", "classify_pairs", "search_pairs", "filter_pairs"});
}

}  // namespace
}  // namespace gnomon::app
