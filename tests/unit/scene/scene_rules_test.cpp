// Lights without a range, cameras from text.

#include <glm/gtc/constants.hpp>

#include "gltf_files.h"
#include "scene/pose.h"

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
    for (const SceneLight& light : metres.lights) EXPECT_TRUE(light.rangeIsGuessed && light.sourceIsGuessed);
}

namespace {

// A square of half size `half` at height y.
void addPlate(Scene& scene, float y, float half) {
    Primitive p;
    p.positions = {{-half, y, -half}, {half, y, -half}, {half, y, half}, {-half, y, half}};
    p.indices = {0, 1, 2, 0, 2, 3};
    for (const glm::vec3& v : p.positions) p.bounds.add(v);
    scene.instances.push_back({"plate", static_cast<std::uint32_t>(scene.meshes.size()), glm::mat4(1.0f)});
    scene.meshes.push_back({"plate", {p}});
}

}  // namespace

// However faint: no vertex is beyond what nobody gave. One note says so.
TEST(SceneRules, GuessedRangesReachAllThatIsDrawn) {
    for (const float intensity : {0.0f, 1e-6f, 10.0f, 1e4f}) {
        Scene scene = room(10.0f, {intensity, 10000.0f});
        scene.lights[1].rangeMetres = 5.0f;
        completeLights(scene);
        EXPECT_GE(scene.lights[0].rangeMetres, glm::length(glm::vec3(10, 1, 10)));
        EXPECT_LE(scene.lights[0].rangeMetres, 15.0f);
        EXPECT_TRUE(scene.lights[0].rangeIsGuessed);
        EXPECT_FALSE(scene.lights[1].rangeIsGuessed);
        ASSERT_EQ(scene.notes.size(), 1u);
        EXPECT_TRUE(scene.notes[0].starts_with("1 of 2 point and spot lights state no range")) << scene.notes[0];
        completeLights(scene);  // what was guessed stays
        EXPECT_EQ(scene.notes.size(), 1u);
        EXPECT_TRUE(scene.lights[0].rangeIsGuessed);
    }
}

TEST(SceneRules, SourcesFollowFromTheNearestSurface) {
    const auto radiusOf = [](Scene scene) {
        completeLights(scene);
        return scene.lights[0].sourceRadius;
    };
    Scene scene = room(10.0f, {100.0f});  // 1 m above the floor
    const float usual = radiusOf(scene);
    EXPECT_NEAR(usual, 1.0f / 40.0f, 1e-6f);
    addPlate(scene, 500.0f, 500.0f);  // the sky says nothing
    EXPECT_EQ(radiusOf(scene), usual);
    addPlate(scene, 1.06f, 0.01f);
    EXPECT_NEAR(radiusOf(scene), 0.06f / 40.0f, 1e-7f);
    // A spot that shines down does not meet what is above it, nor what is beside its cone.
    scene.lights[0].kind = LightKind::Spot;
    for (const float angle : {0.3f, 0.8f, 1.3f, 1.5f}) {
        scene.lights[0].outerConeAngle = angle;
        EXPECT_NEAR(radiusOf(scene), usual, 1e-6f) << angle;
    }
    scene.lights[0].direction = {0.0f, 1.0f, 0.0f};
    EXPECT_NEAR(radiusOf(scene), 0.06f / 40.0f, 1e-7f);
    scene.lights[0].direction = {0.8f, 0.6f, 0.0f};
    scene.lights[0].outerConeAngle = 0.3f;
    EXPECT_NEAR(radiusOf(scene), 499.0f / std::cos(std::acos(0.6f) - std::atan(std::tan(0.3f))) / 40.0f, 1.0f);
    // A surface that the lamp lies on is none that it shines on.
    Scene ceiling = room(10.0f, {100.0f});
    addPlate(ceiling, 1.0f, 10.0f);
    EXPECT_NEAR(radiusOf(ceiling), usual, 1e-6f);
    // Beyond the range nothing counts.
    ceiling.lights[0].rangeMetres = 0.5f;
    EXPECT_LT(radiusOf(ceiling), 0.001f);
    EXPECT_GT(radiusOf(ceiling), 0.0f);
}

// A plate that falls on a lamp while the animation plays is nearest at its lowest, and one that rises likewise.
TEST(SceneRules, SourcesLookAtAllOfAnAnimation) {
    for (const bool lampMoves : {false, true}) {
        Scene scene = room(10.0f, {100.0f});
        addPlate(scene, 9.0f, 3.0f);
        scene.nodes.resize(1);
        if (lampMoves)
            scene.lights[0].node = 0;
        else
            scene.instances[1].node = 0;
        Animation animation;
        animation.durationSeconds = 2.0f;
        const float way = lampMoves ? 7.5f : -7.5f;
        animation.channels.push_back({0,
                                      AnimationChannel::Path::Translation,
                                      AnimationChannel::Interpolation::Linear,
                                      {0, 1, 2},
                                      {0, 0, 0, 0, way, 0, 0, 0, 0}});
        scene.animations.push_back(animation);
        completeLights(scene);
        EXPECT_NEAR(scene.lights[0].sourceRadius, 0.5f / 40.0f, 1e-6f) << lampMoves;
    }
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
    EXPECT_FALSE(camera.orthographic);
    EXPECT_TRUE(parseCamera("default", scene, camera).ok());
    scene.cameras.push_back({});
    scene.cameras[0].name = "door";
    scene.cameras[0].nearMetres = 0.7f;
    EXPECT_TRUE(parseCamera("door", scene, camera).ok());
    EXPECT_EQ(camera.nearMetres, 0.7f);
    EXPECT_TRUE(parseCamera("#0", scene, camera).ok());
    for (const char* bad : {"",
                            "#1",
                            "#",
                            "#x",
                            "window",
                            "1,2,3",
                            "1,2:3,4,5",
                            "1,2,3:1,2,3",
                            "1,2,3:4,5,6:0",
                            "1,2,3:4,5,6:180",
                            "1,2,3:4,5,6:60:1",
                            "1,2,3:4,5,6:60:height=2",
                            "1,2,3:4,5,6:height=0",
                            "1,2,3:4,5,6:height=1e38",
                            "1,2,3:4,5,6:height=",
                            "1,2,3:4,5,6:width=2",
                            "1,2,3:4,5,6:roll=1:roll=2",
                            "1,2,3:4,5,6:roll=361",
                            "1,2,3:4,5,6:roll=nan",
                            "1,2,3:roll=1",
                            "1,2,3:4,5,6:",
                            "1,2,nan:4,5,6",
                            "1,2,3,4:5,6,7",
                            "1,2,3x:4,5,6",
                            "1,,3:4,5,6"}) {
        SceneCamera untouched;
        untouched.nearMetres = 123.0f;
        EXPECT_FALSE(parseCamera(bad, scene, untouched).ok()) << bad;
        EXPECT_EQ(untouched.nearMetres, 123.0f);
    }
}

TEST(SceneRules, OrthographicCamerasFromText) {
    const Scene scene = room(10.0f, {});
    SceneCamera camera;
    ASSERT_TRUE(parseCamera("0,14,0:0,0,0:height=6:roll=90", scene, camera).ok());
    EXPECT_TRUE(camera.orthographic);
    EXPECT_EQ(camera.orthographicHalfHeight, 3.0f);
    EXPECT_GT(camera.farMetres, 14.0f + 5.0f);
    EXPECT_LT(camera.farMetres, 100.0f);
    // Straight down, -z is up in the picture. Clockwise by a quarter, up in the picture is +x.
    EXPECT_NEAR(glm::length(glm::vec3(camera.worldFromCamera[1]) - glm::vec3(1, 0, 0)), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::length(glm::vec3(camera.worldFromCamera[2]) - glm::vec3(0, 1, 0)), 0.0f, 1e-6f);
    ASSERT_TRUE(parseCamera("0,0,8:0,0,0:roll=-90:35", scene, camera).ok());
    EXPECT_FALSE(camera.orthographic);
    EXPECT_NEAR(camera.verticalFieldOfView, glm::radians(35.0f), 1.0e-6f);
    EXPECT_NEAR(glm::length(glm::vec3(camera.worldFromCamera[1]) - glm::vec3(-1, 0, 0)), 0.0f, 1e-6f);
}

// Whatever is in front of the eye by a thousandth of the way to the target is seen, in a scene of any size.
TEST(SceneRules, NearPlanesFollowTheTarget) {
    for (const float size : {0.004f, 10.0f, 1.0e5f}) {
        SceneCamera camera;
        ASSERT_TRUE(parseCamera("0,0,0.002:0,0,0", room(size, {}), camera).ok());
        EXPECT_LE(camera.nearMetres, 2.001e-6f) << size;
        EXPECT_GT(camera.nearMetres, 0.0f) << size;
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

namespace {

// A floor whose node grows from `rest` to its full size, with a lamp over it that comes along if `lampToo`.
Scene growing(float rest, bool lampToo) {
    Scene scene = room(5.0f, {100.0f});
    scene.nodes.resize(1);
    scene.nodes[0].scale = glm::vec3(rest);
    scene.instances[0].node = 0;
    scene.instances[0].worldFromObject = glm::mat4(rest);
    scene.instances[0].worldFromObject[3][3] = 1.0;
    if (lampToo) {
        scene.lights[0].node = 0;
        scene.lights[0].position = rest * glm::vec3(0, 30, 0);
    }
    Animation animation;
    animation.durationSeconds = 2.0f;
    animation.channels.push_back({0,
                                  AnimationChannel::Path::Scale,
                                  AnimationChannel::Interpolation::Linear,
                                  {0, 1, 2},
                                  {0.1f, 0.1f, 0.1f, 1, 1, 1, 1, 1, 1}});
    scene.animations.push_back(animation);
    return scene;
}

}  // namespace

// What is derived from a scene's extent follows from all of the animation, never from the pose that was stored.
TEST(SceneRules, RestPosesDoNotCount) {
    for (const bool lampToo : {false, true}) {
        Scene usual = growing(1.0f, lampToo);
        completeLights(usual);
        SceneCamera usualCamera, given;
        ASSERT_TRUE(parseCamera("default", usual, usualCamera).ok());
        for (float rest : {1.0e-3f, 0.1f, 50.0f, 1.0e4f}) {
            Scene scene = growing(rest, lampToo);
            completeLights(scene);
            EXPECT_NEAR(scene.lights[0].rangeMetres, usual.lights[0].rangeMetres, 1e-4f * usual.lights[0].rangeMetres)
                << rest << " " << lampToo;
            EXPECT_NEAR(scene.lights[0].sourceRadius, usual.lights[0].sourceRadius, 1e-6f);
            SceneCamera camera;
            ASSERT_TRUE(parseCamera("default", scene, camera).ok());
            EXPECT_LT(glm::length(camera.worldFromCamera[3] - usualCamera.worldFromCamera[3]), 1e-3f) << rest;
            ASSERT_TRUE(parseCamera("0,1,2:0,0,0", scene, camera).ok());
            ASSERT_TRUE(parseCamera("0,1,2:0,0,0", usual, given).ok());
            EXPECT_NEAR(camera.nearMetres, given.nearMetres, 1e-6f);
            EXPECT_NEAR(animatedExtent(scene, 16).drawn.radius(), animatedExtent(usual, 16).drawn.radius(), 1e-3f)
                << rest;
        }
    }
    // With nothing that plays, the stored pose is what is drawn.
    Scene still = growing(50.0f, false), small = growing(1.0f, false);
    for (Scene* scene : {&still, &small}) {
        scene->animations[0].playing = false;
        completeLights(*scene);
    }
    EXPECT_GT(still.lights[0].rangeMetres, 10.0f * small.lights[0].rangeMetres);
}

// A short way out between two even samples still counts.
TEST(SceneRules, KeysOfAnimationsCount) {
    Scene scene = growing(1.0f, false);
    scene.animations[0].channels[0].times = {0.0f, 0.501f, 0.502f, 0.503f, 2.0f};
    scene.animations[0].channels[0].values = {1, 1, 1, 1, 1, 1, 9, 9, 9, 1, 1, 1, 1, 1, 1};
    EXPECT_NEAR(animatedExtent(scene, 16).drawn.max.x, 45.0f, 0.1f);
}

// What is thrown out of the world does not make the scene that large.
TEST(SceneRules, MomentsBeyondTheWorldDoNotCount) {
    Scene scene = growing(1.0f, false);
    const Bounds whole = animatedExtent(scene).drawn;
    AnimationChannel& channel = scene.animations[0].channels[0];
    channel.times = {0.0f, 0.501f, 0.502f, 0.503f, 2.0f};
    channel.values = {1, 1, 1, 1, 1, 1, 1e10f, 1e10f, 1e10f, 1, 1, 1, 1, 1, 1};
    EXPECT_LE(animatedExtent(scene).drawn.radius(), whole.radius());
    EXPECT_GT(animatedExtent(scene).drawn.radius(), 0.0f);
    channel.values.assign(15, 1e10f);
    EXPECT_EQ(animatedExtent(scene).drawn.radius(), worldBounds(scene).radius());
    EXPECT_FALSE(animatedExtent(scene).drawn.empty());
}

TEST(SceneRules, WhatMovesAloneIsBoundedByWhereItGoes) {
    const char* folder = std::getenv("GNOMON_SCENES_DIR");
    if (folder == nullptr) GTEST_SKIP() << "GNOMON_SCENES_DIR is not set";
    Scene scenes[2];
    for (int i = 0; i < 2; ++i) {
        const std::filesystem::path field = std::filesystem::path(folder) / "field/12-range-from-the-rest-pose";
        ASSERT_TRUE(loadGltf(field / (i == 0 ? "rest1.gltf" : "rest0.001.gltf"), scenes[i]).ok());
        completeLights(scenes[i]);
    }
    const Pose usual = poseAt(scenes[0], 1.5), other = poseAt(scenes[1], 1.5);
    EXPECT_FLOAT_EQ(scenes[0].lights.at(0).rangeMetres, scenes[1].lights.at(0).rangeMetres);
    EXPECT_FLOAT_EQ(scenes[0].lights.at(0).sourceRadius, scenes[1].lights.at(0).sourceRadius);
    for (std::size_t i = 0; i < usual.worldFromObject.size(); ++i)
        EXPECT_EQ(usual.worldFromObject[i], other.worldFromObject[i]) << i;
}

// Half of what a camera sees at distance 1 (perspective), or in metres (orthographic).
TEST(SceneRules, NarrowPicturesShowTheWholeWidthOfTheCamera) {
    SceneCamera camera;
    camera.verticalFieldOfView = 2.0f * std::atan(0.5f);
    camera.widthOverHeight = 3.0f;
    const auto halfHeight = [&](std::uint32_t width, std::uint32_t height) {
        const SceneCamera fitted = fittedCamera(camera, width, height);
        return camera.orthographic ? fitted.orthographicHalfHeight : std::tan(0.5f * fitted.verticalFieldOfView);
    };
    for (const bool orthographic : {false, true}) {
        camera.orthographic = orthographic;
        camera.orthographicHalfHeight = 0.5f;
        EXPECT_NEAR(halfHeight(1280, 720), 0.5f * 3.0f * 720.0f / 1280.0f, 1e-5f);
        EXPECT_NEAR(halfHeight(300, 100), 0.5f, 1e-6f);
        EXPECT_NEAR(halfHeight(400, 100), 0.5f, 1e-6f);  // wider than the camera: more at the sides
        EXPECT_NEAR(halfHeight(100, 1000), 0.5f * 30.0f, 1e-3f);
        camera.widthOverHeight = 0.0f;  // none given: the picture's own
        EXPECT_NEAR(halfHeight(100, 1000), 0.5f, 1e-6f);
        camera.widthOverHeight = 3.0f;
    }
    camera.orthographic = false;
    camera.verticalFieldOfView = 3.1f;
    camera.widthOverHeight = 1e6f;
    const float most = fittedCamera(camera, 1, 16384).verticalFieldOfView;
    EXPECT_TRUE(most > 3.1f && std::tan(0.5f * most) > 0.0f && std::isfinite(std::tan(0.5f * most)));
}

TEST(SceneRules, MasksAreOpaqueFromTheirCutoffOn) {
    Material material;
    EXPECT_LT(leastOpaqueAlpha(material), 0.0f);  // opaque, whatever its alpha
    material.alphaMode = AlphaMode::Mask;
    for (int texel = 0; texel < 255; ++texel) {  // what 8 bits tell apart is told apart
        material.alphaCutoff = static_cast<float>(texel + 1) / 255.0f;
        EXPECT_LT(leastOpaqueAlpha(material), material.alphaCutoff * (1.0f - 1.0e-5f));
        EXPECT_GT(leastOpaqueAlpha(material), static_cast<float>(texel) / 255.0f + 0.003f);
    }
    material.alphaCutoff = 1.0001f;  // above 1 nothing is opaque
    EXPECT_GT(leastOpaqueAlpha(material), 1.0f);
    material.alphaMode = AlphaMode::Blend;
    EXPECT_LT(leastOpaqueAlpha(material), 0.5f);
    EXPECT_GT(leastOpaqueAlpha(material), 0.499f);
}

TEST(SceneRules, WithoutLightsThereIsASun) {
    Scene scene;
    scene.materials.resize(1);
    lightIfDark(scene);
    EXPECT_TRUE(scene.lights.empty()) << "nothing is there to be seen";
    scene.meshes.resize(1);
    scene.instances.resize(1);
    lightIfDark(scene);
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].kind, LightKind::Directional);
    EXPECT_TRUE(scene.lights[0].casts);
    EXPECT_LT(scene.lights[0].direction.y, -0.5f);
    EXPECT_NEAR(glm::length(scene.lights[0].direction), 1.0f, 1e-6f);
    EXPECT_EQ(scene.notes.size(), 1u);
    lightIfDark(scene);
    EXPECT_EQ(scene.lights.size(), 1u) << "there is a light now";
}
