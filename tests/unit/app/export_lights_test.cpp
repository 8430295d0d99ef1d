// --export-lights: what the program writes is read again as the lights of the picture.
#include <gtest/gtest.h>

#include <fstream>

#include "scene/load_gltf.h"
#include "unit/app/program.h"
#include "unit/scene/gltf_files.h"

namespace gnomon::app {
namespace {

class ExportLights : public Program {
protected:
    renderer::Scene read(const char* name) const {
        renderer::Scene scene;
        const Result result = renderer::loadGltf(folder_ / name, scene);
        EXPECT_TRUE(result.ok()) << result.message();
        return scene;
    }
};

TEST_F(ExportLights, ScatteredOnesAndTheScenesOwn) {
    expectGood(
        "render boxes --lights 12 --filter hard --shadows off --size 16x16 --stats out.json --export-lights "
        "lights.gltf");
    const renderer::Scene scene = read("lights.gltf");
    const nlohmann::json stats = readJson("out.json")["sceneLights"];
    ASSERT_EQ(scene.lights.size(), 15u);
    ASSERT_EQ(stats.size(), 15u);
    for (std::size_t i = 0; i < 15; ++i) {
        EXPECT_EQ(scene.lights[i].name, stats[i]["name"]);
        EXPECT_FLOAT_EQ(scene.lights[i].rangeMetres, stats[i]["rangeMetres"]);
        EXPECT_FLOAT_EQ(scene.lights[i].sourceRadius, stats[i]["sourceRadiusMetres"]);
    }
    // What is given back gives the same lights.
    expectGood("render lights.gltf --size 16x16 --filter hard --shadows off --export-lights again.gltf");
    std::ifstream first(folder_ / "lights.gltf"), second(folder_ / "again.gltf");
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(first), {}),
              std::string(std::istreambuf_iterator<char>(second), {}));
}

// A lamp that goes from 0 to 4 within two seconds, far from zero.
TEST_F(ExportLights, AsTheyAreInTheLastFrame) {
    std::vector<std::uint8_t> bytes;
    scene_tests::append<float>(bytes, {0, 2, 0, 0, 0, 4, 0, 0});
    std::ofstream(folder_ / "moving.gltf")
        << R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"children":[1],)"
        << R"("translation":[4510731.25,0,0]},{"name":"lamp","extensions":{"KHR_lights_punctual":{"light":0}}}],)"
        << R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":7}]}},)"
        << R"("animations":[{"channels":[{"sampler":0,"target":{"node":1,"path":"translation"}}],)"
        << R"("samplers":[{"input":0,"output":1}]}],"accessors":[)"
        << R"({"bufferView":0,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[2]},)"
        << R"({"bufferView":1,"componentType":5126,"count":2,"type":"VEC3"}],"bufferViews":[)"
        << R"({"buffer":0,"byteLength":8},{"buffer":0,"byteOffset":8,"byteLength":24}],"buffers":[)"
        << scene_tests::dataBuffer(bytes) << "]}";
    expectGood("render moving.gltf --size 16x16 --filter hard --shadows off --time 1 --export-lights one.gltf");
    expectGood(
        "render moving.gltf --size 16x16 --filter hard --shadows off --time 1 --frames 3 --fps 4 --export-lights "
        "three.gltf");
    for (const auto& [name, x] : {std::pair("one.gltf", 2.0), std::pair("three.gltf", 3.0)}) {
        const renderer::Scene scene = read(name);
        ASSERT_EQ(scene.lights.size(), 1u);
        EXPECT_EQ(scene.lights[0].name, "lamp");
        EXPECT_EQ(scene.lights[0].rangeMetres, 0.0f) << "nobody gave one";
        EXPECT_NEAR(scene.origin.x + static_cast<double>(scene.lights[0].position.x), 4510731.25 + x, 1e-6);
    }
}

TEST_F(ExportLights, OnlyWhatShines) {
    expectGood("render boxes --light 1 --filter hard --shadows off --size 16x16 --export-lights lights.gltf");
    const renderer::Scene scene = read("lights.gltf");
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].position, glm::vec3(1.5f, 2.0f, -1.3f));
}

TEST_F(ExportLights, WithEveryCommandThatHasLights) {
    expectGood("verify boxes --lights 2 --filter hard --size 64x36 --quiet --export-lights verify.gltf");
    EXPECT_EQ(read("verify.gltf").lights.size(), 5u);
    expectGood(
        "bench boxes --filter hard --lights 2 --variants off --size 64x64 --warmup 1 --frames 2 --export-lights "
        "bench.gltf");
    EXPECT_EQ(read("bench.gltf").lights.size(), 5u);
}

TEST_F(ExportLights, NamesAreChecked) {
    std::ofstream(folder_ / "scene.gltf") << "kept";
    for (const char* name : {"lights.json", "lights.glb", "''", "missing/lights.gltf", "scene.gltf"})
        for (const char* command : {"render", "verify", "bench"})
            expectRefused(std::string(command) + " scene.gltf --export-lights " + name, 2);
    expectRefused("render boxes --stats same.gltf --export-lights ./same.gltf", 2);
}

}  // namespace
}  // namespace gnomon::app
