// What the program draws: time, soft shadows, small pools, validation.

#include <fstream>
#include <map>
#include <string>

#include "picture/picture.h"
#include "unit/app/program.h"

namespace gnomon::app {
namespace {

namespace fs = std::filesystem;

class Rendering : public Program {};

// A triangle that slides three metres to the right within a second; `reach` in place of the three.
std::string slidingTriangle(float reach) {
    const float numbers[17] = {-1, 0, 0, 1, 0, 0, 0, 2, 0, 0, 1, 0, 0, 0, reach, 0, 0};
    return R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],)"
           R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
           R"("buffers":[{"byteLength":68,"uri":")" +
           dataUri(numbers) +
           R"("}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":8},)"
           R"({"buffer":0,"byteOffset":44,"byteLength":24}],"accessors":[)"
           R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
           R"({"bufferView":1,"componentType":5126,"count":2,"type":"SCALAR"},)"
           R"({"bufferView":2,"componentType":5126,"count":2,"type":"VEC3"}],)"
           R"("animations":[{"name":"slide","samplers":[{"input":1,"output":2}],)"
           R"("channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}]})";
}

TEST_F(Rendering, RendersAndDescribesAFrame) {
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
    std::map<std::string, std::string> kinds;
    for (const nlohmann::json& pass : json["passes"]) {
        kinds[pass["name"]] = pass["kind"];
        EXPECT_FALSE(pass.contains("drawing"));
    }
    EXPECT_EQ(kinds["gbuffer"], "drawing");
    EXPECT_EQ(kinds["classify_pairs"], "compute");
    EXPECT_EQ(kinds["filter_pairs"], "compute");
    EXPECT_FALSE(kinds.contains("filter_tiles")) << "pcss has nothing for it";
}

TEST_F(Rendering, TimePasses) {
    std::ofstream(folder_ / "slide.gltf") << slidingTriangle(3.0f);
    // The default camera has all of the animation in view, or the triangle at rest where none plays.
    const std::string render = "render slide.gltf --size 64x36 --filter hard --exposure 0 --camera 1,1,6:1,0.5,0 ";
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
    expectGood("render thrown.gltf --size 64x36 --time 0.9");  // its default camera looks at where it starts
    std::ofstream(folder_ / "slide.gltf") << slidingTriangle(2.0e15f);
    expectRefused("render slide.gltf --size 64x36 --time 0.9 --quiet", 2);  // a value beyond 1e15
}

TEST_F(Rendering, SoftShadowsHaveTheirOptions) {
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

// Light is a sum: each lamp alone and the ambient light alone make up the picture of all.
TEST_F(Rendering, LightsOneByOne) {
    const std::string render = "render boxes --size 64x36 --filter hard --exposure -2 ";
    expectGood(render + "--light 0 --ambient off -o first.png --stats first.json");
    expectGood(render + "--light 1 --light 2 --ambient off -o others.png");
    expectGood(render + "--ambient off -o all.png");
    EXPECT_EQ(readJson("first.json")["lights"]["given"], 3) << "numbers name the same lights";
    const auto brightness = [this](const char* name) {
        double sum = 0.0;
        for (const std::uint8_t value : renderer::readPng(folder_ / name).rgb) sum += value;
        return sum;
    };
    EXPECT_GT(brightness("first.png"), 0.0);
    EXPECT_GT(brightness("others.png"), 0.0);
    EXPECT_GT(brightness("all.png"), brightness("first.png"));
    EXPECT_GT(brightness("all.png"), brightness("others.png"));
    std::ofstream(folder_ / "slide.gltf") << slidingTriangle(3.0f);
    const Outcome unlit = run("render slide.gltf --size 64x36 --ambient off -o sun.png");
    EXPECT_EQ(unlit.exitCode, 0) << unlit.err;
    EXPECT_NE(unlit.err.find("a sun was added"), std::string::npos) << unlit.err;
    EXPECT_GT(brightness("sun.png"), 0.0);
}

TEST_F(Rendering, FramesAreCleanUnderValidation) {
    for (const char* shadows : {"deferred", "inline", "off"})
        expectGood(std::string("render boxes --size 97x61 --frames 3 --validate --shadows ") + shadows);
}

TEST_F(Rendering, PoolsOfOneLoseNoLight) {
    expectGood("render boxes --size 160x90 -o all.png");
    expectGood("render boxes --size 160x90 -o one.png --stats one.json --list-entries 1 --visibility-slots 1");
    expectGood("render boxes --size 160x90 -o slot.png --stats slot.json --visibility-slots 1");
    EXPECT_GT(readJson("one.json")["counters"]["listOverflowTiles"], 0);
    EXPECT_GT(readJson("slot.json")["counters"]["slotOverflowEntries"], 0);
    expectGood("compare all.png one.png --tolerance 1");
    expectGood("compare all.png slot.png --tolerance 1");
}

}  // namespace
}  // namespace gnomon::app
