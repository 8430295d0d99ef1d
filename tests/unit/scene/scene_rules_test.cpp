// Lights without a range, cameras from text.

#include <glm/gtc/constants.hpp>

#include "gltf_files.h"

using namespace scene_tests;

namespace {

// A square of the given half size and lamps of the given intensities above it.
Scene room(float halfSize, const std::vector<float>& intensities) {
    Scene scene;
    scene.materials.emplace_back();
    Primitive p;
    p.positions = {{-halfSize, 0, -halfSize}, {halfSize, 0, -halfSize}, {0, 0, halfSize}};
    p.indices = {0, 1, 2};
    for (const glm::vec3& v : p.positions) p.bounds.add(v);
    scene.meshes.push_back({"floor", {p}});
    scene.instances.push_back({"floor", 0, glm::mat4(1.0f)});
    for (float intensity : intensities) {
        SceneLight light;
        light.position = {0, 0.1f * halfSize, 0};
        light.intensity = intensity;
        scene.lights.push_back(light);
    }
    return scene;
}

}  // namespace

TEST(SceneRules, RangeDoesNotDependOnTheUnits) {
    Scene metres = room(10.0f, {1, 2, 30, 4, 5, 6, 7, 8}),
          inches = room(10.0f / 0.0254f, {100, 200, 3000, 400, 500, 600, 700, 800});
    completeLights(metres);
    completeLights(inches);
    for (std::size_t i = 0; i < metres.lights.size(); ++i)
        EXPECT_NEAR(inches.lights[i].rangeMetres * 0.0254f, metres.lights[i].rangeMetres,
                    1.0e-3f * metres.lights[i].rangeMetres);
    EXPECT_LT(metres.lights[0].rangeMetres, metres.lights[3].rangeMetres);
}

TEST(SceneRules, EveryLightEndsUpUsable) {
    for (float size : {1.0e-6f, 0.9f, 10.0f, 250000.0f, 1.0e14f})
        for (float intensity : {0.0f, 1.0e-9f, 1.0f, 109000.0f, 1.0e30f}) {
            Scene scene = room(size, {intensity, 1.0f, intensity});
            scene.lights[1].kind = LightKind::Directional;
            completeLights(scene);
            for (const SceneLight& light : scene.lights) {
                EXPECT_TRUE(std::isfinite(light.rangeMetres) && std::isfinite(light.sourceRadius));
                EXPECT_GT(light.sourceRadius, 0.0f);
                if (light.kind == LightKind::Directional) continue;
                EXPECT_GT(light.rangeMetres, 0.0f);
                EXPECT_LT(light.sourceRadius, light.rangeMetres);
            }
        }
    Scene alone;  // no geometry at all
    alone.lights.emplace_back();
    completeLights(alone);
    EXPECT_GT(alone.lights[0].rangeMetres, 1.0f);
}

TEST(SceneRules, WhatTheFileGivesStays) {
    Scene scene = room(10.0f, {5.0f});
    scene.lights[0].rangeMetres = 3.0f;
    scene.lights[0].sourceRadius = 0.5f;
    completeLights(scene);
    EXPECT_EQ(scene.lights[0].rangeMetres, 3.0f);
    EXPECT_EQ(scene.lights[0].sourceRadius, 0.5f);
}

TEST(SceneRules, CamerasFromText) {
    Scene scene = room(10.0f, {});
    SceneCamera camera;
    ASSERT_TRUE(parseCamera("0,14,12:0,0,0:60", scene, camera).ok());
    EXPECT_EQ(glm::vec3(camera.worldFromCamera[3]), glm::vec3(0, 14, 12));
    EXPECT_NEAR(camera.verticalFieldOfView, glm::radians(60.0f), 1.0e-6f);
    const glm::vec3 forward = -glm::vec3(camera.worldFromCamera[2]);
    EXPECT_NEAR(glm::dot(forward, glm::normalize(glm::vec3(0, -14, -12))), 1.0f, 1.0e-6f);
    EXPECT_NEAR(glm::determinant(glm::mat3(camera.worldFromCamera)), 1.0f, 1.0e-5f);
    EXPECT_TRUE(parseCamera("0,9,0:0,0,0", scene, camera).ok());  // straight down
    EXPECT_NEAR(glm::determinant(glm::mat3(camera.worldFromCamera)), 1.0f, 1.0e-5f);
    EXPECT_TRUE(parseCamera("default", scene, camera).ok());
    scene.cameras.push_back({});
    scene.cameras[0].name = "door";
    scene.cameras[0].nearMetres = 0.7f;
    EXPECT_TRUE(parseCamera("door", scene, camera).ok());
    EXPECT_EQ(camera.nearMetres, 0.7f);
    EXPECT_TRUE(parseCamera("#0", scene, camera).ok());
    for (const char* bad :
         {"", "#1", "#", "#x", "window", "1,2,3", "1,2:3,4,5", "1,2,3:1,2,3", "1,2,3:4,5,6:0", "1,2,3:4,5,6:180",
          "1,2,3:4,5,6:60:1", "1,2,nan:4,5,6", "1,2,3,4:5,6,7", "1,2,3x:4,5,6", "1,,3:4,5,6"}) {
        SceneCamera untouched;
        untouched.nearMetres = 123.0f;
        EXPECT_FALSE(parseCamera(bad, scene, untouched).ok()) << bad;
        EXPECT_EQ(untouched.nearMetres, 123.0f);
    }
}

TEST(SceneRules, DefaultCameraFramesTheScene) {
    for (float size : {0.01f, 1.0f, 250000.0f}) {
        const Scene scene = room(size, {});
        const SceneCamera camera = defaultCamera(scene);
        const glm::mat4 cameraFromWorld = glm::inverse(camera.worldFromCamera);
        for (const glm::vec3& p : scene.meshes[0].primitives[0].positions) {
            const glm::vec4 q = cameraFromWorld * glm::vec4(p, 1.0f);
            EXPECT_GT(-q.z, camera.nearMetres);
            EXPECT_LT(std::abs(q.y) / -q.z, std::tan(0.5f * camera.verticalFieldOfView));
        }
    }
}
