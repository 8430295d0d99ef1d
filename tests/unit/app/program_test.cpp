// The command line: exit codes and what is said on stderr. Nothing that is refused may start long work, leave a file
// behind or print anything on stdout.

#include <fstream>

#include "picture/picture.h"
#include "unit/app/program.h"

namespace gnomon::app {
namespace {

namespace fs = std::filesystem;

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
                                  "render boxes --light 99 --quiet --size 64x64",
                                  "render --ambient dim",
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
                                  "render --face-guard 65",
                                  "render --face-guard -1",
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

TEST_F(Program, ExtensionsOfFilesMayBeInCapitals) {
    const std::string lamp =
        R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"extensions":{"KHR_lights_punctual":)"
        R"({"light":0}}}],"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}}})";
    for (const char* file : {"CASE.GLTF", "Mixed.Gltf", "x.GlB"}) {
        std::ofstream(folder_ / file) << lamp;
        expectGood(std::string("render ") + file + " --size 16x16 --filter hard --shadows off -o PICTURE.Png");
    }
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
    expectGood("render boxes --size 16x16 --filter hard --shadows off -o a.png");
    expectRefused("compare a.png a.png --diff ./a.png", 2);
}

TEST_F(Program, NothingFartherThanFloatsReach) {
    expectRefused("render boxes --size 16x16 --quiet --camera 1e10,2,3:0,0,0", 2);
    expectRefused("render boxes --size 16x16 --unquantised", 2);
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

TEST_F(Program, TellsWhatEachLightGot) {
    expectGood("render boxes --size 16x16 --filter hard --stats stated.json");
    nlohmann::json lights = readJson("stated.json")["sceneLights"];
    ASSERT_EQ(lights.size(), 3u);
    EXPECT_EQ(lights[0]["rangeMetres"], 7.0);
    EXPECT_EQ(lights[0]["rangeGuessed"], false);
    EXPECT_EQ(lights[0]["biasMetres"], 0.002);
    EXPECT_EQ(lights[0]["biasAtMostPerMetre"], 0.002);
    std::ofstream(folder_ / "lamps.gltf")
        << R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0,1]}],"nodes":[{"extensions":{"KHR_lights_punctual":)"
        << R"({"light":0}}},{"translation":[3,0,0],"extensions":{"KHR_lights_punctual":{"light":1}}}],)"
        << R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","extras":{"sourceRadius":0.25}},)"
        << R"({"type":"point","range":9}]}}})";
    expectGood(
        "render lamps.gltf --size 16x16 --filter hard --source-radius 0.125 --bias-metres 0.5 --stats guessed.json");
    lights = readJson("guessed.json")["sceneLights"];
    EXPECT_EQ(lights[0]["rangeGuessed"], true);
    EXPECT_EQ(lights[0]["sourceRadiusMetres"], 0.25);
    EXPECT_EQ(lights[1]["rangeGuessed"], false);
    EXPECT_EQ(lights[1]["sourceRadiusMetres"], 0.125);
    EXPECT_EQ(lights[1]["sourceRadiusGuessed"], false);
    EXPECT_EQ(lights[1]["biasMetres"], 0.5);
    EXPECT_EQ(lights[1]["biasStated"], true);
    EXPECT_FALSE(lights[1].contains("biasAtMostPerMetre"));
    for (const char* bad : {"--bias-metres -1", "--bias-metres 2mm", "--bias-metres nan", "--source-radius -1"})
        expectRefused(std::string("render boxes ") + bad, 2);
}

TEST_F(Program, AFullDiskIsAFailure) {
    EXPECT_EQ(run("scenes >/dev/full 2>/dev/null #").exitCode, 1);  // the comment hides the redirection that run() adds
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
    expectGood(
        "bench boxes --filter hard --size 64x64 --warmup 1 --frames 3 --variants deferred,inline,off --json out.json");
    const nlohmann::json json = readJson("out.json");
    EXPECT_EQ(json["frames"], 3);
    EXPECT_EQ(json["variants"].size(), 3u);
    EXPECT_GT(json["variants"]["inline"]["shadowPhasesAndLighting"]["medianMs"], 0.0);
    EXPECT_GT(json["ratios"]["deferred/inline"]["ofMedians"], 0.0);
    EXPECT_NE(json["commit"], "");
    EXPECT_FALSE(json.contains("rates"));
    EXPECT_EQ(json["variants"]["inline"]["passes"]["gbuffer"]["kind"], "drawing");
}

}  // namespace
}  // namespace gnomon::app
