// Instances that a scale of zero makes flat: drawn. Only what is a point everywhere is left out.
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "gltf_files.h"
#include "scene/flatness.h"
#include "scene/pose.h"

using namespace scene_tests;

namespace {

Scene withNodes(const std::string& nodes) {
    Scene scene;
    const gnomon::Result result = loadText(triangleGltf("", "", nodes), scene);
    EXPECT_TRUE(result.ok()) << result.message();
    return scene;
}

const std::string kLamp =
    R"(,"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","name":"lamp","spot":{}}]}})";

// A triangle whose node's scale goes from its rest to 1, and a light that hangs on it.
Scene growing(const glm::vec3& rest) {
    Scene scene;
    scene.materials.resize(1);
    scene.nodes.resize(2);
    scene.nodes[0].rotation = glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3)));
    scene.nodes[0].translation = {3, 2, 1};
    scene.nodes[1].parent = 0;
    scene.nodes[1].scale = rest;
    const glm::dmat4 world = glm::translate(glm::dmat4(1.0), scene.nodes[0].translation) *
                             glm::mat4_cast(scene.nodes[0].rotation) * glm::scale(glm::dmat4(1.0), glm::dvec3(rest));
    Primitive p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
    p.indices = {0, 1, 2};
    for (const glm::vec3& v : p.positions) p.bounds.add(v);
    scene.meshes.push_back({"thing", {p}, {}});
    scene.instances.push_back({"thing", 0, world, 1});
    SceneLight light;
    light.kind = LightKind::Spot;
    light.position = glm::vec3(world[3]);
    light.direction = glm::vec3(glm::mat3_cast(scene.nodes[0].rotation) * glm::dvec3(0, 0, -1));
    light.node = 1;
    scene.lights.push_back(light);
    Animation animation;
    animation.durationSeconds = 2.0f;
    animation.channels.push_back({1,
                                  AnimationChannel::Path::Scale,
                                  AnimationChannel::Interpolation::Linear,
                                  {0, 1, 2},
                                  {rest.x, rest.y, rest.z, 1, 1, 1, 1, 1, 1}});
    scene.animations.push_back(animation);
    return scene;
}

}  // namespace

TEST(SceneFlat, OneOrTwoAxesOfZeroAreLoaded) {
    for (const char* scale :
         {"[1,0,1]", "[0,1,1]", "[1,1,0]", "[-1,0,1]", "[1e-20,1e-20,1e-20]", "[1,0,0]", "[0,0,-2]", "[1e-13,1,0]"}) {
        const Scene scene = withNodes(std::string(R"([{"mesh":0,"scale":)") + scale + "}]");
        EXPECT_EQ(scene.instances.size(), 1u) << scale;
        EXPECT_TRUE(scene.notes.empty()) << scale << ": " << scene.notes.front();
    }
    // By the parent, by a matrix, and by two that each flatten something.
    EXPECT_EQ(
        withNodes(R"([{"children":[1],"scale":[1,0,1]},{"mesh":0,"rotation":[0.5,0.5,0.5,0.5]}])").instances.size(),
        1u);
    EXPECT_EQ(withNodes(R"([{"mesh":0,"matrix":[1,0,0,0,0,0,0,0,0,0,1,0,5,0,0,1]}])").instances.size(), 1u);
    EXPECT_EQ(withNodes(R"([{"children":[1],"scale":[1,0,1]},{"mesh":0,"scale":[0,1,1]}])").instances.size(), 1u);
}

TEST(SceneFlat, AllAxesOfZeroAreLeftOutAndNoted) {
    for (const char* nodes : {R"([{"children":[1]},{"mesh":0,"scale":[0,0,0]}])",
                              R"([{"children":[1],"scale":[1,0,0]},{"mesh":0,"scale":[0,1,1]}])"}) {
        Scene scene;
        ASSERT_FALSE(loadText(triangleGltf("", "", nodes), scene).ok());  // nothing is left
        ASSERT_TRUE(loadText(triangleGltf(R"(,"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}})", "",
                                          replaced(nodes, R"({"children")",
                                                   R"({"extensions":{"KHR_lights_punctual":{"light":0}},"children")")),
                             scene)
                        .ok());
        EXPECT_TRUE(scene.instances.empty());
        ASSERT_EQ(scene.notes.size(), 1u);
        EXPECT_NE(scene.notes[0].find("scale of zero on all axes"), std::string::npos) << scene.notes[0];
    }
}

TEST(SceneFlat, LightsKeepTheirDirection) {
    // Turned by 90 degrees about x: -z becomes up. The scale is zero along z, the light's own axis.
    for (const char* scale : {"[1,1,0]", "[1,1,1]", "[2,2,1e-20]"}) {
        Scene scene;
        const gnomon::Result result = loadText(
            triangleGltf(kLamp, "",
                         std::string(R"([{"mesh":0,"children":[1]},{"rotation":[0.70710678,0,0,0.70710678],"scale":)") +
                             scale + R"(,"extensions":{"KHR_lights_punctual":{"light":0}}}])"),
            scene);
        ASSERT_TRUE(result.ok()) << scale << result.message();
        EXPECT_LT(glm::length(scene.lights.at(0).direction - glm::vec3(0, 1, 0)), 1e-5f) << scale;
    }
}

// Whatever the scale at rest, the pose at a time is the same.
TEST(SceneFlat, PosesDoNotDependOnTheScaleAtRest) {
    const Scene plain = growing({1, 1, 1});
    const Pose expected = poseAt(plain, 1.5);
    for (const glm::vec3& rest :
         {glm::vec3(1, 0, 1), glm::vec3(0, 0, 0), glm::vec3(1, 1, 0), glm::vec3(0, 0, 1), glm::vec3(1e-3f),
          glm::vec3(1, 1e-12f, 1), glm::vec3(1e-12f), glm::vec3(1e-7f, 1, 1), glm::vec3(1e6f, 1e-6f, 1)}) {
        const Scene scene = growing(rest);
        const Pose pose = poseAt(scene, 1.5);
        for (int c = 0; c < 4; ++c)
            EXPECT_LT(glm::length(pose.worldFromObject[0][c] - expected.worldFromObject[0][c]), 1e-6)
                << rest.x << " " << rest.y << " " << rest.z << ", column " << c;
        EXPECT_LT(glm::length(pose.lights[0].position - expected.lights[0].position), 1e-5f) << rest.x << " " << rest.y;
        EXPECT_LT(glm::length(pose.lights[0].direction - expected.lights[0].direction), 1e-5f)
            << rest.x << " " << rest.y;
    }
}

TEST(SceneFlat, AreaAndWindingOfMatrices) {
    const auto scaled = [](double x, double y, double z) {
        return glm::dmat3(glm::rotate(glm::dmat4(1.0), 0.6, glm::dvec3(1, 2, 3))) *
               glm::dmat3(glm::scale(glm::dmat4(1.0), glm::dvec3(x, y, z)));
    };
    for (const glm::dmat3& m : {scaled(1, 1, 1), scaled(1, 0, 1), scaled(1, 1, 0), scaled(0, -1, 1),
                                scaled(1e-20, 1e-20, 1e-20), scaled(1e-20, 0, 1e-20), scaled(1e5, 0, 1e-2)})
        EXPECT_TRUE(hasArea(m));
    for (const glm::dmat3& m : {scaled(0, 0, 0), scaled(1, 0, 0), scaled(0, -3, 0), scaled(0, 0, 1e-20)})
        EXPECT_FALSE(hasArea(m));
    EXPECT_FALSE(turnsWinding(scaled(1, 1, 1)));
    EXPECT_TRUE(turnsWinding(scaled(-1, 1, 1)));
    EXPECT_TRUE(turnsWinding(scaled(1e-20, -1e-20, 1e-20)));
    EXPECT_TRUE(turnsWinding(scaled(1, -1e-9, 1)));
    // Flat: rounding has no say.
    for (int i = 0; i < 100; ++i) {
        const glm::mat3 turn(glm::rotate(glm::mat4(1.0f), 0.1f * static_cast<float>(i), glm::vec3(1, -2, 0.5f)));
        const glm::mat3 squash(glm::scale(glm::mat4(1.0f), glm::vec3(i % 2 == 0 ? 1.0f : -1.0f, 0.0f, 1.0f)));
        EXPECT_FALSE(turnsWinding(glm::dmat3(turn * squash * turn))) << i;
    }
}
