// Nodes are composed in double, and a scene far from zero counts from an origin of its own.
#include <algorithm>

#include "gltf_files.h"
#include "scene/pose.h"

using namespace scene_tests;

namespace {

const glm::dvec3 kEarth(4510731.2537, 4510731.8731, 0.333);

Scene loadedNodes(const std::string& nodes) {
    const std::string more = R"(,"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}],)"
                             R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","spot":{}}]}})";
    Scene scene;
    const gnomon::Result result = loadText(triangleGltf(more, "", nodes), scene);
    EXPECT_TRUE(result.ok()) << result.message();
    return scene;
}

// Three things, a light and a camera below a root.
std::string family(const std::string& root) {
    return R"([{)" + root +
           R"("children":[1,2,3,4,5]},{"mesh":0,"translation":[-1.05,0.3,0.1]},)"
           R"({"mesh":0,"rotation":[0.1,0.7,0.1,0.7],"scale":[0.3,0.4,0.5]},)"
           R"({"mesh":0,"matrix":[0.1,0,0,0,0,0.1,0,0,0,0,0.1,0,0.35,0.4,0.26,1]},)"
           R"({"extensions":{"KHR_lights_punctual":{"light":0}},"translation":[1.5,3,1],"rotation":[0.4,0.1,0.2,0.9]},)"
           R"({"camera":0,"translation":[1.5,2.6,3.6],"rotation":[-0.26,0.19,0.05,0.95]}])";
}

bool hasNote(const Scene& scene, const std::string& note) {
    return std::find(scene.notes.begin(), scene.notes.end(), note) != scene.notes.end();
}

}  // namespace

TEST(SceneOrigin, OppositeTranslationsCancel) {
    const Scene scene = loadedNodes(
        R"([{"translation":[10000000.5,0,0.5],"children":[1,2,3]},{"mesh":0,"translation":[-10000000.25,0,0]},)"
        R"({"extensions":{"KHR_lights_punctual":{"light":0}},"translation":[-9999999.75,0,0]},)"
        R"({"camera":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,-9999999.875,0,2,1]}])");
    EXPECT_EQ(scene.origin, glm::dvec3(0.0));
    EXPECT_EQ(glm::dvec3(scene.instances.at(0).worldFromObject[3]), glm::dvec3(0.25, 0.0, 0.5));
    EXPECT_EQ(scene.lights.at(0).position, glm::vec3(0.75f, 0.0f, 0.5f));
    EXPECT_EQ(scene.cameras.at(0).worldFromCamera[3], glm::vec4(0.625f, 0.0f, 2.5f, 1.0f));
}

TEST(SceneOrigin, EarthCoordinatesAreAsAtZero) {
    const Scene near = loadedNodes(family(""));
    const Scene far = loadedNodes(family(R"("translation":[4510731.2537,4510731.8731,0.333],)"));
    EXPECT_EQ(near.origin, glm::dvec3(0.0));
    EXPECT_EQ(far.origin, kEarth);
    EXPECT_TRUE(near.notes.empty());
    EXPECT_TRUE(hasNote(far, "The scene is drawn relative to 4510731.2537, 4510731.8731, 0.333."));
    ASSERT_EQ(far.instances.size(), near.instances.size());
    const Pose pose = restPose(far);
    for (std::size_t i = 0; i < near.instances.size(); ++i)
        for (int c = 0; c < 4; ++c) {
            const glm::dvec4 off = pose.worldFromObject[i][c] - near.instances[i].worldFromObject[c];
            EXPECT_LT(glm::length(off), 1e-8) << i << " " << c;
        }
    EXPECT_LT(glm::length(far.lights.at(0).position - near.lights.at(0).position), 1e-6f);
    EXPECT_EQ(far.lights.at(0).direction, near.lights.at(0).direction);
    for (int c = 0; c < 4; ++c) {
        const glm::vec4 off = far.cameras.at(0).worldFromCamera[c] - near.cameras.at(0).worldFromCamera[c];
        EXPECT_LT(glm::length(off), 1e-6f) << c;
    }
    EXPECT_LT(glm::length(worldBounds(far).max - worldBounds(near).max), 1e-6f);
}

TEST(SceneOrigin, MatricesInEarthCoordinates) {
    const Scene scene = loadedNodes(R"([{"children":[1]},{"mesh":0,"matrix":[0,0,-1,0,0,1,0,0,1,0,0,0,)"
                                    R"(4510731.2537,4510731.8731,0.333,1]}])");
    const glm::dvec3 place = glm::dvec3(scene.instances.at(0).worldFromObject[3]) + scene.origin;
    EXPECT_LT(glm::length(place - kEarth), 1e-8);
    EXPECT_LT(glm::length(glm::dvec3(scene.instances.at(0).worldFromObject[3])), 10.0);
}

// Vertices in earth coordinates leave no node near the content: a round place near it serves.
TEST(SceneOrigin, VerticesInEarthCoordinates) {
    std::vector<std::uint8_t> bytes;
    append<float>(bytes, {4510731, 0, 0, 4510732, 0, 0, 4510731, 2, 0});
    append<std::uint16_t>(bytes, {0, 1, 2, 0});
    Scene scene;
    ASSERT_TRUE(loadText(triangleJson(dataBuffer(bytes)), scene).ok());
    EXPECT_EQ(scene.origin, glm::dvec3(4510732.0, 2.0, 0.0));
    EXPECT_EQ(glm::dvec3(scene.instances.at(0).worldFromObject[3]), -scene.origin);
    const Bounds bounds = worldBounds(scene);
    EXPECT_LT(glm::length(bounds.centre()), 4.0f);
}

TEST(SceneOrigin, CamerasAreGivenInTheFilesCoordinates) {
    const Scene near = loadedNodes(family(""));
    const Scene far = loadedNodes(family(R"("translation":[4510731,4510732,0.25],)"));
    SceneCamera expected, camera;
    ASSERT_TRUE(parseCamera("1.125,2,3:0,0.25,0", near, expected).ok());
    ASSERT_TRUE(parseCamera("4510732.125,4510734,3.25:4510731,4510732.25,0.25", far, camera).ok());
    EXPECT_EQ(camera.worldFromCamera, expected.worldFromCamera);
    EXPECT_FALSE(parseCamera("1e39,0,0:0,0,0", near, camera).ok());
}

// What is parked far away, and a lamp alone, have no say.
TEST(SceneOrigin, SmallSharesDoNotMoveIt) {
    const std::string three = R"([{"children":[1,2,3]},{"mesh":0},{"mesh":0,"translation":[1,0,0]},)";
    EXPECT_EQ(loadedNodes(three + R"({"mesh":0,"translation":[0,-9999999,0]}])").origin, glm::dvec3(0.0));
    EXPECT_EQ(loadedNodes(three + R"({"mesh":0,"scale":[90000,90000,90000]}])").origin, glm::dvec3(0.0));
    Scene scene;
    ASSERT_TRUE(
        loadText(replaced(lightGltf(""), R"([{"extensions")", R"([{"translation":[0,5,0],"extensions")"), scene).ok());
    EXPECT_EQ(scene.origin, glm::dvec3(0.0));
}
