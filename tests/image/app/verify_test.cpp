// What the program says of shadows that rays have judged.

#include <algorithm>

#include "picture/picture.h"
#include "unit/app/program.h"

namespace gnomon::app {
namespace {

class Verifying : public Program {};

TEST_F(Verifying, VerifiesAFrame) {
    const std::string verify = "verify boxes --size 96x54 --filter pcss --quiet --flicker 2 --json ";
    expectGood(verify + "a.json --maps maps");
    expectGood(verify + "b.json");
    const nlohmann::json a = readJson("a.json"), b = readJson("b.json");
    for (const char* key : {"acne", "leak", "contactLeak", "edgeError", "penumbraRmse", "penumbraSsim", "flicker"}) {
        ASSERT_TRUE(a["total"][key].is_number()) << key;
        EXPECT_GE(a["total"][key], 0.0) << key;
        EXPECT_LE(a["total"][key], 1.0) << key;
    }
    EXPECT_LE(a["total"]["acne"].get<double>() + a["total"]["leak"].get<double>(), 0.001);
    EXPECT_GT(a["total"]["counts"]["pairs"], 10'000);
    EXPECT_EQ(a["total"], b["total"]);
    EXPECT_EQ(a["lights"], b["lights"]);
    ASSERT_EQ(a["lights"].size(), 3u);
    std::uint64_t pairs = 0;
    for (const nlohmann::json& light : a["lights"]) pairs += light["counts"]["pairs"].get<std::uint64_t>();
    EXPECT_EQ(a["total"]["counts"]["pairs"], pairs);
    const renderer::Picture map = renderer::readPng(folder_ / "maps" / "light_000_point.png");
    EXPECT_EQ(map.width, 3u * 96u + 2u * 4u);
    EXPECT_EQ(map.height, 54u);
    const renderer::Picture total = renderer::readPng(folder_ / "maps" / "total.png");
    expectGood("render boxes --size 96x54 --filter pcss --quiet -o frame.png");
    const renderer::Picture frame = renderer::readPng(folder_ / "frame.png");
    ASSERT_EQ(total.width, 2u * 96u + 4u);
    for (std::size_t y = 0; y < 54; ++y)
        EXPECT_TRUE(std::equal(frame.rgb.begin() + 3 * 96 * y, frame.rgb.begin() + 3 * 96 * (y + 1),
                               total.rgb.begin() + 3 * total.width * y))
            << "the frame stands on the left";
}

TEST_F(Verifying, SweepsBiases) {
    const std::string sweep = "verify boxes --size 80x45 --filter hard --quiet --sweep --sweep-slopes 0,2 ";
    expectGood(sweep + "--sweep-constants 0,1024 --json sweep.json");
    const nlohmann::json json = readJson("sweep.json"), &rows = json["sweep"];
    ASSERT_EQ(rows.size(), 6u) << "oriented, paper, none, and three of hardware";
    EXPECT_EQ(rows[0]["bias"], "oriented");
    EXPECT_EQ(rows[0]["acne"], json["total"]["acne"]);
    EXPECT_EQ(rows[2]["bias"], "none");
    EXPECT_GT(rows[2]["acne"], 0.1);
    EXPECT_EQ(rows[5]["constant"], 1024);
    EXPECT_EQ(rows[5]["slope"], 2);
    double best = 1.0;
    for (std::size_t i = 2; i < rows.size(); ++i) {
        EXPECT_EQ(rows[i]["counts"]["pairs"], rows[0]["counts"]["pairs"]);
        best = std::min(best, rows[i]["acne"].get<double>() + rows[i]["leak"].get<double>());
    }
    EXPECT_DOUBLE_EQ(json["sweepBest"]["wrong"].get<double>(), best);
    EXPECT_LT(best, 0.01);
    EXPECT_EQ(json["ratio"], json["sweepBest"]["ratio"]);
    expectGood(
        "verify boxes --size 80x45 --filter hard --quiet --bias hardware --hardware-bias 1024,2 --json one.json");
    EXPECT_EQ(readJson("one.json")["total"], [&] {
        nlohmann::json row = rows[5];
        for (const char* key : {"bias", "constant", "slope", "subsurface"}) row.erase(key);
        row["flicker"] = nullptr;
        return row;
    }());
}

}  // namespace
}  // namespace gnomon::app
