// The command line: exit codes and what is said on stderr. Nothing that is refused may start long work, leave a file
// behind or print anything on stdout.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "picture/picture.h"
#include "unit/app/program.h"

namespace gnomon::app {
namespace {

namespace fs = std::filesystem;

class Program : public testing::Test {
protected:
    void SetUp() override {
        std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
        std::replace(name.begin(), name.end(), '/', '_');
        folder_ = fs::path(testing::TempDir()) / ("gnomon_app_" + name);
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    Outcome run(const std::string& arguments) { return runProgram(folder_, arguments); }

    void expectRefused(const std::string& arguments, int exitCode) {
        const Outcome result = run(arguments);
        EXPECT_EQ(result.exitCode, exitCode) << arguments << "\n" << result.err;
        EXPECT_TRUE(isOneSentence(result.err)) << arguments << "\n" << result.err;
        EXPECT_EQ(result.out, "") << arguments;
    }

    void expectGood(const std::string& arguments) {
        const Outcome result = run(arguments);
        EXPECT_EQ(result.exitCode, 0) << arguments << "\n" << result.out << result.err;
    }

    nlohmann::json readJson(const char* name) { return nlohmann::json::parse(std::ifstream(folder_ / name)); }

    fs::path folder_;
};

TEST_F(Program, HelpAndVersionAreGood) {
    for (const char* arguments : {"--help", "--version", "render --help", "bench --help", "verify --help",
                                  "compare --help", "devices --help", "scenes --help", "settings --help"}) {
        const Outcome result = run(arguments);
        EXPECT_EQ(result.exitCode, 0) << arguments;
        EXPECT_NE(result.out, "") << arguments;
        EXPECT_EQ(result.err, "") << arguments;
    }
}

TEST_F(Program, ListsScenesAndDevices) {
    EXPECT_NE(run("scenes").out.find("courtyard"), std::string::npos);
    const Outcome devices = run("devices --json");
    EXPECT_EQ(devices.exitCode, 0);
    EXPECT_TRUE(nlohmann::json::parse(devices.out).is_array());
    EXPECT_EQ(run("devices").exitCode, 0);
}

TEST_F(Program, WrongUsageIsRefused) {
    for (const char* arguments : {"",
                                  "nosuch",
                                  "render --bogus",
                                  "verify --bogus",
                                  "verify nosuch",
                                  "verify --rays 4",
                                  "verify --subset 3",
                                  "verify --edge-set square",
                                  "verify --json ''",
                                  "verify --sweep-slopes 1",
                                  "verify --sweep --sweep-slopes 1,",
                                  "verify --sweep --sweep-slopes nan",
                                  "verify --sweep --sweep-constants -1",
                                  "verify --sweep --sweep-constants 1:2",
                                  "verify --unquantised",
                                  "verify boxes --light 99 --quiet --size 64x64",
                                  "verify boxes --light -1",
                                  "verify boxes --maps /dev/null",
                                  "render one two",
                                  "render --lights -1",
                                  "render --lights 100001",
                                  "render --lights 1e9",
                                  "render --lights 1000000000",
                                  "render --seed -1",
                                  "render --frames 0",
                                  "render --filter soft",
                                  "render --filter hard,",
                                  "render --filter hard,soft",
                                  "render --pcss-taps low/",
                                  "render --pcss-taps low/low/low/low/low",
                                  "settings extra",
                                  "render --pcf-radius 0",
                                  "render --pcf-radius 4",
                                  "render --pcss-taps 16",
                                  "render --pcss-taps 0,24",
                                  "render --pcss-taps 16,65",
                                  "render --pcss-taps 16,24,",
                                  "render --pcss-taps -1,4",
                                  "render --pcss-taps lowest",
                                  "render --visibility-bits 5",
                                  "render --visibility-bits 0",
                                  "render --pattern-per-frame yes",
                                  "render --shadows never",
                                  "render --exposure nan",
                                  "render --exposure 1e9",
                                  "render --atlas 100",
                                  "render --subgroup-size 5",
                                  "render --list-entries -1",
                                  "render --reservation none",
                                  "render --depth odd",
                                  "render --time nan",
                                  "render --time 1e99",
                                  "render --fps 0",
                                  "render --fps nan",
                                  "--frob",
                                  "--frob render",
                                  "render --light-density 0",
                                  "render --lights 1 --light-density 0.05",
                                  "render --lights 1 --light-density 65",
                                  "render --lights 1 --light-density nan",
                                  "render --sequence",
                                  "render boxes --animation walk",
                                  "bench --fps -1",
                                  "bench --variants never",
                                  "bench --variants inline,inline",
                                  "bench --frames 0",
                                  "bench --preset table9",
                                  "bench --preset table1 --variants inline",
                                  "bench --preset figure13 --variants off",
                                  "compare one.png",
                                  "compare one.png two.png",
                                  "compare one.png two.png --tolerance 256",
                                  "devices extra"})
        expectRefused(arguments, 2);
}

TEST_F(Program, RefusalsSayWhere) {
    const std::pair<const char*, const char*> cases[] = {{"", "--help"},
                                                         {"--frob", "'--frob'"},
                                                         {"nosuch", "no command 'nosuch'"},
                                                         {"render --size 64", "--size: "},
                                                         {"render --size 16384x16384", "4186127"},
                                                         {"render --filter soft", "--filter: "},
                                                         {"render --pcss-taps 16", "--pcss-taps: "},
                                                         {"render --pcss-taps low/low/low/low/low", "--pcss-taps: "},
                                                         {"render --hardware-bias 1", "--hardware-bias: "},
                                                         {"render --lights 1 --light-density 65", "--light-density: "}};
    for (const auto& [arguments, words] : cases) {
        const std::string said = run(arguments).err;
        EXPECT_NE(said.find(words), std::string::npos) << arguments << "\n" << said;
        EXPECT_EQ(said.find("subcommand"), std::string::npos) << said;
    }
}

TEST_F(Program, WrongBiasesAreRefused) {
    for (const char* bias : {"nonsense", "''", "Oriented", "oriented,none"})
        expectRefused(std::string("render --bias ") + bias, 2);
    for (const char* factors :
         {"''", "1", "1,", ",1", "1,x", "1,2,", "1,2,3,4", "1:2", "' 1,2'", "nan,1", "1,inf", "1e10,1", "-1,2", "1,-2"})
        expectRefused(std::string("render --hardware-bias ") + factors, 2);
    for (const char* option : {"--bias-metres", "--subsurface-fronts --subsurface-bias"})
        for (const char* metres : {"''", "-0.001", "nan", "1001", "2mm"})
            expectRefused(std::string("verify ") + option + " " + metres, 2);
    for (const char* source : {"guessed", "''"}) expectRefused(std::string("render --face-normals ") + source, 2);
    for (const char* variant : {"deferred@nonsense", "deferred@", "@none", "deferred@none@none", "deferred,inline@",
                                "inline@none,inline@none"})
        expectRefused(std::string("bench --variants ") + variant, 2);
    expectRefused("bench --hardware-bias 1,2 --variants deferred@hardware", 2);
    expectRefused("bench --hardware-bias 1,2 --preset table2", 2);
    expectRefused("verify --sweep --hardware-bias 1,2", 2);
    expectRefused("verify --sweep --bias hardware", 2);
    expectRefused("verify --subsurface-bias 0.01", 2);
    expectRefused("verify --maps ''", 2);
}

TEST_F(Program, SizesOfNothingAndAbsurdSizesAreRefused) {
    for (const char* size : {"0x0", "0x64", "64x0", "16385x64", "64x16385", "4294967297x64", "-64x64", "64", "64x",
                             "x64", "64x64x64", "axb", "1e3x64", "' 64x64'", "''", "16384x16384", "16384x16353"})
        expectRefused(std::string("render --size ") + size, 2);
}

TEST_F(Program, WrongScenesAreRefused) {
    for (const char* scene : {"nosuch", "''", "missing.glb", "missing/missing.gltf", ".", "/dev/null"})
        expectRefused(std::string("render ") + scene, 2);
}

TEST_F(Program, MalformedFilesAreRefused) {
    // A GLB header that promises a megabyte, cut off within its first chunk.
    const std::string glb("glTF\x02\x00\x00\x00\x00\x00\x10\x00\xE0\xFF\x0F\x00JSON{\"asset\":{\"ver", 35);
    std::ofstream(folder_ / "cut.glb", std::ios::binary) << glb;
    std::ofstream(folder_ / "header.glb", std::ios::binary) << glb.substr(0, 7);
    std::ofstream(folder_ / "empty.glb", std::ios::binary);
    std::ofstream(folder_ / "text.gltf") << "{\"asset\": ";
    std::ofstream(folder_ / "old.gltf") << "{\"asset\": {\"version\": \"1.0\"}}";
    fs::create_directory(folder_ / "folder.glb");
    for (const char* file : {"cut.glb", "header.glb", "empty.glb", "text.gltf", "old.gltf", "folder.glb"})
        expectRefused(std::string("render ") + file, 2);
}

TEST_F(Program, WrongCamerasAndDevicesAreRefused) {
    for (const char* camera : {"nosuch", "'#99'", "nan,0,0:0,0,0", "0,0,0:0,0,0", "0,inf,0:0,0,0", "0,1,2:3,4",
                               "0,0,1:0,0,0:180", "0,0,1:0,0,0:nan"})
        expectRefused(std::string("render boxes --camera ") + camera, 2);
    for (const char* device : {"nosuch", "99", "99999999999999999999"})
        expectRefused(std::string("render --device ") + device, 2);
}

TEST_F(Program, OutputsThatCannotBeWrittenAreFoundFirst) {
    for (const char* option : {"-o", "--exr", "--stats"}) {
        expectRefused(std::string("render ") + option + " missing/out", 2);
        expectRefused(std::string("render ") + option + " /dev/null", 2);
        expectRefused(std::string("render ") + option + " .", 2);
    }
    expectRefused("bench --json missing/out.json", 2);
    expectRefused("verify boxes --maps new --json missing/out.json", 2);
    EXPECT_FALSE(fs::exists(folder_ / "new"));
}

TEST_F(Program, OutputsAreFilesOfTheirOwn) {
    expectRefused("render boxes -o ''", 2);
    expectRefused("render boxes -o out.jpg", 2);
    expectRefused("render boxes -o same.png --stats ./same.png", 2);
    std::ofstream(folder_ / "scene.glb") << "kept";
    expectRefused("render scene.glb --exr ./scene.glb", 2);
    expectRefused("bench scene.glb --json scene.glb", 2);
    std::string kept;
    std::ifstream(folder_ / "scene.glb") >> kept;
    EXPECT_EQ(kept, "kept");
    expectGood("render boxes --size 16x16 -o a.png");
    expectRefused("compare a.png a.png --diff ./a.png", 2);
}

TEST_F(Program, NothingFartherThanFloatsReach) {
    expectRefused("render boxes --size 16x16 --quiet --camera 1e10,2,3:0,0,0", 2);
    expectRefused("render boxes --size 16x16 --unquantised", 2);
}

TEST_F(Program, VerifiesAFrame) {
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

TEST_F(Program, SweepsBiases) {
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

TEST_F(Program, VerifiesWhatIsNotThere) {
    expectGood("verify lights-only --filter hard --size 64x36 --quiet --json none.json");
    EXPECT_EQ(readJson("none.json")["total"]["counts"]["pairs"], 0);
    EXPECT_EQ(readJson("none.json")["castingLightsUnseen"], 3);
    expectGood("verify boxes --filter hard --size 64x36 --quiet --light 1 --light 1 --maps new --json new/one.json");
    EXPECT_EQ(readJson("new/one.json")["lights"].size(), 1u) << "named twice, counted once";
    std::filesystem::remove(folder_ / "new" / "total.png");
    std::filesystem::create_directory(folder_ / "new" / "total.png");
    expectRefused("verify boxes --filter hard --size 64x36 --quiet --maps new", 1);
}

TEST_F(Program, RendersAndDescribesAFrame) {
    expectGood("render boxes --size 160x90 -o out.png --exr out.exr --stats out.json --frames 2");
    const renderer::Picture picture = renderer::readPng(folder_ / "out.png");
    EXPECT_EQ(picture.width, 160u);
    EXPECT_EQ(picture.height, 90u);
    EXPECT_TRUE(fs::exists(folder_ / "out.exr"));
    const nlohmann::json json = readJson("out.json");
    EXPECT_EQ(json["hash"], renderer::hashOf(picture));
    EXPECT_EQ(json["lights"]["given"], 3);
    EXPECT_EQ(json["counters"]["accurateExceedsApproximate"], 0);
    EXPECT_GT(json["counters"]["meanShadowedLightsPerTile"], 0.0);
    EXPECT_EQ(json["settings"]["filter"], "pcss");
    EXPECT_EQ(json["extent"], (nlohmann::json{160, 90}));
    EXPECT_GE(json["memory"]["library"]["lights"]["copies"], 2) << "one for each frame in flight";
    EXPECT_EQ(json["memory"]["library"]["visibility"]["copies"], 1);
    EXPECT_GT(json["memory"]["library"]["visibility"]["bytes"], 0);
    for (const nlohmann::json& pass : json["passes"]) {
        if (pass["name"] == "gbuffer") {
            EXPECT_EQ(pass["kind"], "drawing");
        }
        if (pass["name"] == "generate_shadows") {
            EXPECT_EQ(pass["kind"], "compute");
        }
        EXPECT_FALSE(pass.contains("drawing"));
    }
}

// A triangle that slides three metres to the right within a second; `reach` in place of the three.
std::string slidingTriangle(float reach) {
    const float numbers[17] = {-1, 0, 0, 1, 0, 0, 0, 2, 0, 0, 1, 0, 0, 0, reach, 0, 0};
    std::string bytes;  // percent-encoded
    for (float number : numbers)
        for (std::uint32_t bits = std::bit_cast<std::uint32_t>(number), i = 0; i < 4; ++i, bits >>= 8) {
            bytes += '%';
            for (std::uint32_t digit : {bits >> 4 & 15u, bits & 15u}) bytes += "0123456789abcdef"[digit];
        }
    return R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],)"
           R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
           R"("buffers":[{"byteLength":68,"uri":"data:application/octet-stream,)" +
           bytes +
           R"("}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":8},)"
           R"({"buffer":0,"byteOffset":44,"byteLength":24}],"accessors":[)"
           R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
           R"({"bufferView":1,"componentType":5126,"count":2,"type":"SCALAR"},)"
           R"({"bufferView":2,"componentType":5126,"count":2,"type":"VEC3"}],)"
           R"("animations":[{"name":"slide","samplers":[{"input":1,"output":2}],)"
           R"("channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}]})";
}

TEST_F(Program, TimePasses) {
    std::ofstream(folder_ / "slide.gltf") << slidingTriangle(3.0f);
    const std::string render = "render slide.gltf --size 64x36 --exposure 0 ";
    expectGood(render + "-o start.png");
    expectGood(render + "--time 0.5 -o middle.png");
    expectGood(render + "--time 2 -o looped.png");
    expectGood(render + "--time 0.5 --animation none -o still.png");
    expectGood(render + "--time 0.5 --animation slide -o named.png");
    expectGood(render + "--frames 3 --fps 4 --sequence -o film.png");
    EXPECT_EQ(run("compare start.png middle.png").exitCode, 1);
    expectGood("compare start.png looped.png");
    expectGood("compare start.png still.png");
    expectGood("compare middle.png named.png");
    expectGood("compare start.png film_0000.png");
    expectGood("compare middle.png film_0002.png");
    EXPECT_FALSE(fs::exists(folder_ / "film.png"));
    EXPECT_FALSE(fs::exists(folder_ / "film_0003.png"));
    expectGood("bench slide.gltf --size 64x36 --warmup 0 --frames 2 --fps 30 --time 0.1");
    std::ofstream(folder_ / "thrown.gltf") << slidingTriangle(9.0e14f);
    expectGood("render thrown.gltf --size 64x36 --time 0.9");
    std::ofstream(folder_ / "slide.gltf") << slidingTriangle(2.0e15f);
    expectRefused("render slide.gltf --size 64x36 --time 0.9 --quiet", 2);  // a value beyond 1e15
}

TEST_F(Program, SoftShadowsHaveTheirOptions) {
    const std::string render = "render boxes --size 96x54 --exposure 3 ";
    expectGood(render + "--filter pcss --pcss-taps medium -o soft.png");
    expectGood(render + "--pcss-taps 16,24 --no-shadow-bounds -o searched.png");
    expectGood("compare soft.png searched.png");
    expectGood(render + "--filter hard -o hard.png");
    expectGood(render + "--pattern-per-frame --frames 2 -o turned.png");
    for (const char* other : {"hard.png", "turned.png"})
        EXPECT_EQ(run(std::string("compare soft.png ") + other).exitCode, 1) << other;
    expectGood(render + "--visibility-bits 4 -o four.png");
    expectGood("compare soft.png four.png --tolerance 15");
    EXPECT_EQ(run("compare soft.png four.png --tolerance 1").exitCode, 1);
}

TEST_F(Program, FramesAreCleanUnderValidation) {
    for (const char* shadows : {"deferred", "inline", "off"})
        expectGood(std::string("render boxes --size 97x61 --frames 3 --validate --shadows ") + shadows);
}

TEST_F(Program, AFullDiskIsAFailure) {
    EXPECT_EQ(run("scenes >/dev/full 2>/dev/null #").exitCode, 1);  // the comment hides the redirection that run() adds
}

TEST_F(Program, PoolsOfOneLoseNoLight) {
    expectGood("render boxes --size 160x90 -o all.png");
    expectGood("render boxes --size 160x90 -o one.png --stats one.json --list-entries 1 --visibility-slots 1");
    expectGood("render boxes --size 160x90 -o slot.png --stats slot.json --visibility-slots 1");
    EXPECT_GT(readJson("one.json")["counters"]["listOverflowTiles"], 0);
    EXPECT_GT(readJson("slot.json")["counters"]["slotOverflowEntries"], 0);
    expectGood("compare all.png one.png --tolerance 1");
    expectGood("compare all.png slot.png --tolerance 1");
}

TEST_F(Program, CompareTellsPicturesApart) {
    renderer::Picture picture{2, 2, std::vector<std::uint8_t>(12, 100)};
    renderer::writePng(picture, folder_ / "a.png");
    picture.rgb[4] = 103;
    renderer::writePng(picture, folder_ / "b.png");
    renderer::writePng({1, 1, {0, 0, 0}}, folder_ / "small.png");
    expectGood("compare a.png a.png");
    expectGood("compare a.png b.png --tolerance 3");
    EXPECT_EQ(run("compare a.png b.png --tolerance 2 --diff d.png").exitCode, 1);
    EXPECT_EQ(renderer::readPng(folder_ / "d.png").width, 2u);
    expectRefused("compare a.png small.png", 2);
}

TEST_F(Program, BenchMeasuresVariantsInTurn) {
    expectGood("bench boxes --size 64x64 --warmup 1 --frames 3 --variants deferred,inline,off --json out.json");
    const nlohmann::json json = readJson("out.json");
    EXPECT_EQ(json["frames"], 3);
    EXPECT_EQ(json["variants"].size(), 3u);
    EXPECT_GT(json["variants"]["inline"]["shadowPhasesAndLighting"]["medianMs"], 0.0);
    EXPECT_GT(json["ratios"]["deferred/inline"]["ofMedians"], 0.0);
    EXPECT_NE(json["commit"], "");
    EXPECT_FALSE(json.contains("rates"));
    EXPECT_EQ(json["variants"]["inline"]["passes"]["gbuffer"]["kind"], "drawing");
}

// Explicit options stand above the preset's; what it prints and writes is the same measurement.
TEST_F(Program, BenchPresetsGiveThePapersTables) {
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

    expectGood("bench boxes --preset figure13 --size 64x64 --warmup 0 --frames 2 --json figure13.json");
    const nlohmann::json figure13 = readJson("figure13.json");
    EXPECT_EQ(figure13["variants"].size(), 1u);
    double percent = 0.0;
    for (const nlohmann::json& row : figure13["preset"]["rows"])
        if (!row["cpu"]) percent += row["percentOfGpu"].get<double>();
    EXPECT_EQ(figure13["preset"]["rows"].size(), 7u);
    EXPECT_NEAR(percent, 100.0, 1e-6);
}

// Inline shading is measured without its way out of full lists, so lists that are full are refused, not measured
// wrongly.
TEST_F(Program, BenchNeedsListsThatFit) {
    const std::string full = " --size 64x64 --warmup 0 --frames 1 --quiet --list-entries 1";
    expectGood("bench boxes --variants deferred" + full);
    const Outcome refused = run("bench boxes --variants deferred,inline" + full);
    EXPECT_EQ(refused.exitCode, 2);
    EXPECT_NE(refused.err.find("--list-entries"), std::string::npos) << refused.err;
}

TEST_F(Program, BenchPresetsSayWhereTheSceneIsUnlikeThePapers) {
    const std::string said = "That is outside 2.5 to 3.5";
    const std::string few = "--preset figure13 --size 64x64 --warmup 0 --frames 1";
    EXPECT_NE(run("bench courtyard " + few).out.find(said), std::string::npos);
}

TEST_F(Program, BenchFloorsAreMeasured) {
    expectGood("bench boxes --floor --size 64x64 --warmup 0 --frames 2 --validate --json out.json");
    const nlohmann::json json = readJson("out.json");
    for (const char* rate : {"copyBytesPerSecond", "fetchesPerSecond", "gathersPerSecond"})
        EXPECT_GT(json["rates"][rate], 0.0) << rate;
    for (const char* pass :
         {"hierarchical_depth", "find_lights_approximate", "find_lights_accurate", "generate_shadows", "lighting"}) {
        const nlohmann::json& floor = json["variants"]["deferred"]["passes"][pass]["floor"];
        EXPECT_GT(floor["ms"], 0.0) << pass;
        EXPECT_GT(floor["ratio"], 0.0) << pass;
    }
    EXPECT_FALSE(json["variants"]["deferred"]["passes"]["gbuffer"].contains("floor"));
}

}  // namespace
}  // namespace gnomon::app
