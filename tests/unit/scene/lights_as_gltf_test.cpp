// Lights that are written and read again are the same.
#include "scene/lights_as_gltf.h"

#include <nlohmann/json.hpp>

#include "gltf_files.h"
#include "scene/pose.h"
#include "scene/random.h"

using namespace scene_tests;

namespace {

SceneLight randomLight(Random& random, LightKind kind) {
    SceneLight light;
    light.kind = kind;
    light.name = "lamp \"" + std::to_string(random.next()) + "\"";
    light.position = {random.between(-9, 9), random.between(-9, 9), random.between(-9, 9)};
    if (kind != LightKind::Point)
        light.direction =
            glm::normalize(glm::vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)));
    light.colour = {random.unit(), random.unit(), random.unit()};
    light.intensity = random.between(0, 1e5f);
    light.innerConeAngle = random.between(0, 0.5f);
    light.outerConeAngle = random.between(0.51f, 1.5f);
    if (random.unit() < 0.7f) light.rangeMetres = random.between(0.01f, 1e3f);
    if (random.unit() < 0.7f) light.sourceRadius = random.between(1e-4f, 0.4f);
    if (random.unit() < 0.5f) light.biasMetres = random.between(0, 0.1f);
    if (random.unit() < 0.5f) light.filter = gnomon::Filter::Pcf;
    return light;
}

void expectSame(const SceneLight& a, const SceneLight& b, const glm::dvec3& originA, const glm::dvec3& originB) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.kind, b.kind);
    const glm::dvec3 apart = originA + glm::dvec3(a.position) - originB - glm::dvec3(b.position);
    EXPECT_LT(glm::length(apart), originA == originB ? 1e-9 : 1e-5);
    if (a.kind != LightKind::Point) {
        EXPECT_LT(glm::length(a.direction - b.direction), 1e-6f);
    }
    EXPECT_EQ(a.colour, b.colour);
    EXPECT_EQ(a.intensity, b.intensity);
    if (a.kind != LightKind::Directional) {
        EXPECT_EQ(a.rangeMetres, b.rangeMetres);
    }
    if (a.kind == LightKind::Spot) {
        EXPECT_EQ(a.innerConeAngle, b.innerConeAngle);
        EXPECT_EQ(a.outerConeAngle, b.outerConeAngle);
    }
    EXPECT_EQ(a.sourceRadius, b.sourceRadius);
    EXPECT_EQ(a.biasMetres, b.biasMetres);
    EXPECT_EQ(a.filter, b.filter);
}

}  // namespace

TEST(LightsAsGltf, AreReadBackAsTheyWere) {
    Random random(8);
    for (const glm::dvec3& origin : {glm::dvec3(0.0), glm::dvec3(4510731.2537, 4510731.8731, 0.333)}) {
        std::vector<SceneLight> lights;
        for (int i = 0; i < 60; ++i) lights.push_back(randomLight(random, static_cast<LightKind>(i % 3)));
        Scene loaded;
        const gnomon::Result result = loadText(lightsAsGltf(lights, origin), loaded);
        ASSERT_TRUE(result.ok()) << result.message();
        ASSERT_EQ(loaded.lights.size(), lights.size());
        for (std::size_t i = 0; i < lights.size(); ++i) expectSame(lights[i], loaded.lights[i], origin, loaded.origin);
    }
}

TEST(LightsAsGltf, ShineAllWays) {
    std::vector<SceneLight> lights(7);
    const glm::vec3 ways[] = {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {1e-5f, 0, 1}};
    for (std::size_t i = 0; i < lights.size(); ++i) {
        lights[i].kind = LightKind::Directional;
        lights[i].direction = glm::normalize(ways[i]);
    }
    Scene loaded;
    ASSERT_TRUE(loadText(lightsAsGltf(lights, glm::dvec3(0.0)), loaded).ok());
    for (std::size_t i = 0; i < lights.size(); ++i)
        EXPECT_LT(glm::length(lights[i].direction - loaded.lights[i].direction), 1e-6f) << i;
}

// Guessed ranges are no property of a light. Half-angles of 90 degrees and colours above 1 are written as glTF has
// them.
TEST(LightsAsGltf, KeepToWhatGltfAllows) {
    SceneLight light;
    light.kind = LightKind::Spot;
    light.outerConeAngle = 1.57079637f;
    light.colour = {0.5f, 4.0f, 1.0f};
    light.intensity = 3.0f;
    light.rangeMetres = 7.0f;
    light.rangeIsGuessed = true;
    const std::string text = lightsAsGltf({&light, 1}, glm::dvec3(0.0));
    const auto json = nlohmann::json::parse(text);
    const auto& written = json["extensions"]["KHR_lights_punctual"]["lights"][0];
    EXPECT_FALSE(written.contains("range"));
    EXPECT_FALSE(written.contains("extras"));
    EXPECT_LE(written["spot"]["outerConeAngle"].get<double>(), 1.5707963267948966);
    EXPECT_EQ(written["color"], (nlohmann::json{0.125, 1.0, 0.25}));
    EXPECT_EQ(written["intensity"], 12.0);
    EXPECT_EQ(json["asset"]["version"], "2.0");
    Scene loaded;
    ASSERT_TRUE(loadText(text, loaded).ok());
    EXPECT_EQ(loaded.lights[0].outerConeAngle, light.outerConeAngle);
    EXPECT_TRUE(loaded.notes.empty()) << loaded.notes.front();
}

// Short decimals, as a person would write them.
TEST(LightsAsGltf, NumbersAreShort) {
    SceneLight light;
    light.position = {0.1f, 2.7f, -3.3f};
    const std::string text = lightsAsGltf({&light, 1}, glm::dvec3(0.0));
    for (const char* number : {"0.1", "2.7", "-3.3"})
        EXPECT_NE(text.find(std::string(number) + (number[0] == '-' ? "\n" : ",")), std::string::npos) << text;
}
