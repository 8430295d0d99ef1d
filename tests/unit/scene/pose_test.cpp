// Poses against closed forms: interpolation, loops, hierarchies, skins, morph targets, lights and cameras.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/play_animation.h"
#include "scene/pose.h"
#include "scene/sample_animation.h"

using namespace gnomon::renderer;

namespace {

using Path = AnimationChannel::Path;
using Interpolation = AnimationChannel::Interpolation;

AnimationChannel channel(std::uint32_t node, Path path, std::vector<float> times, std::vector<float> values,
                         Interpolation interpolation = Interpolation::Linear) {
    return {node, path, interpolation, std::move(times), std::move(values)};
}

std::vector<float> sample(const AnimationChannel& c, double seconds) {
    std::vector<double> out(channelWidth(c));
    sampleChannel(c, seconds, out);
    return {out.begin(), out.end()};
}

void expectNear(const glm::dvec3& got, const glm::dvec3& expected, double tolerance = 1e-5) {
    EXPECT_LT(glm::length(got - expected), tolerance)
        << got.x << " " << got.y << " " << got.z << " not " << expected.x << " " << expected.y << " " << expected.z;
}

glm::dvec3 origin(const Pose& pose, std::uint32_t node) {
    return glm::dvec3(pose.worldFromNode[node][3]);
}

Scene withNodes(std::uint32_t count) {
    Scene scene;
    scene.materials.resize(1);
    scene.nodes.resize(count);
    return scene;
}

void play(Scene& scene, std::vector<AnimationChannel> channels) {
    Animation animation;
    for (const AnimationChannel& c : channels)
        animation.durationSeconds = std::max(animation.durationSeconds, c.times.back());
    animation.channels = std::move(channels);
    scene.animations.push_back(std::move(animation));
}

Primitive triangle() {
    Primitive p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    p.normals.assign(3, {0, 0, 1});
    p.tangents.assign(3, {1, 0, 0, -1});
    p.indices = {0, 1, 2};
    for (const glm::vec3& v : p.positions) p.bounds.add(v);
    return p;
}

glm::vec3 worldVertex(const Pose& pose, std::size_t deformed, std::size_t vertex) {
    const PosedPrimitive& p = pose.deformed.at(deformed);
    return glm::vec3(pose.worldFromObject[p.instance] * glm::dvec4(glm::dvec3(p.positions[vertex]), 1.0));
}

const float kHalfRoot = std::sqrt(0.5f);

}  // namespace

TEST(Pose, StepAndLinear) {
    const auto step = channel(0, Path::Translation, {1, 2, 4}, {1, 2, 3, 4, 5, 6, 7, 8, 9}, Interpolation::Step);
    EXPECT_EQ(sample(step, 0.0), (std::vector<float>{1, 2, 3}));  // before the first key
    EXPECT_EQ(sample(step, 1.999), (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(sample(step, 2.0), (std::vector<float>{4, 5, 6}));
    EXPECT_EQ(sample(step, 9.0), (std::vector<float>{7, 8, 9}));
    const auto linear = channel(0, Path::Scale, {1, 2, 4}, {1, 2, 3, 4, 5, 6, 8, 9, 10});
    EXPECT_EQ(sample(linear, 0.5), (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(sample(linear, 1.5), (std::vector<float>{2.5f, 3.5f, 4.5f}));
    EXPECT_EQ(sample(linear, 2.5), (std::vector<float>{5, 6, 7}));
    EXPECT_EQ(sample(linear, 4.0), (std::vector<float>{8, 9, 10}));
    const auto weights = channel(0, Path::Weights, {0, 2}, {0, 1, 1, 0});
    EXPECT_EQ(sample(weights, 0.5), (std::vector<float>{0.25f, 0.75f}));
}

TEST(Pose, RotationsTakeTheShorterWayAtEvenSpeed) {
    // 0 to 120 degrees about y; the second quaternion has its sign turned around.
    const float half = glm::radians(60.0f);
    const auto turn = channel(0, Path::Rotation, {0, 1}, {0, 0, 0, 1, 0, -std::sin(half), 0, -std::cos(half)});
    for (float part : {0.0f, 0.25f, 0.5f, 1.0f}) {
        const auto q = sample(turn, part);
        const float sign = q[3] < 0.0f ? -1.0f : 1.0f;
        EXPECT_NEAR(sign * q[1], std::sin(part * half), 1e-6f);
        EXPECT_NEAR(sign * q[3], std::cos(part * half), 1e-6f);
    }
}

TEST(Pose, CubicSplines) {
    // x = t^3 between 1 and 3: slopes 3 and 27. y is constant with slopes of zero, z a line.
    const auto cubic = channel(0, Path::Translation, {1, 3},
                               {99, 99, 99, 1, 5, 2, 3, 0, 2,  // in-tangent of the first key: never used
                                27, 0, 2, 27, 5, 6, -99, -99, -99},
                               Interpolation::CubicSpline);
    for (double t : {1.0, 1.5, 2.0, 2.9, 3.0}) {
        const auto v = sample(cubic, t);
        EXPECT_NEAR(v[0], t * t * t, 1e-4);
        EXPECT_NEAR(v[1], 5.0, 1e-5);
        EXPECT_NEAR(v[2], 2.0 * t, 1e-5);
    }
    const auto turn =
        channel(0, Path::Rotation, {0, 1}, {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0},
                Interpolation::CubicSpline);
    const auto q = sample(turn, 0.5);  // halfway between (0 0 0 1) and (0 1 0 0), made unit
    EXPECT_NEAR(q[1], kHalfRoot, 1e-6f);
    EXPECT_NEAR(q[3], kHalfRoot, 1e-6f);
}

TEST(Pose, EveryAnimationLoopsByItself) {
    Scene scene = withNodes(2);
    play(scene, {channel(0, Path::Translation, {0, 2}, {0, 0, 0, 2, 0, 0})});
    play(scene, {channel(1, Path::Translation, {0, 3}, {0, 0, 0, 0, 3, 0})});
    for (double t : {0.0, 0.5, 1.9, 2.5, 7.25, 1e6 + 0.5, -0.5}) {
        const Pose pose = poseAt(scene, t);
        expectNear(origin(pose, 0), {t - 2.0 * std::floor(t / 2.0), 0, 0});
        expectNear(origin(pose, 1), {0, t - 3.0 * std::floor(t / 3.0), 0});
    }
    EXPECT_EQ(loopedTime({"still", 0.0f, {}}, 12.0), 0.0);
    scene.animations[1].playing = false;
    expectNear(origin(poseAt(scene, 1.0), 1), {0, 0, 0});
    EXPECT_TRUE(isAnimated(scene));
    scene.animations[0].playing = false;
    EXPECT_FALSE(isAnimated(scene));
}

TEST(Pose, ChildrenFollowTheirParents) {
    Scene scene = withNodes(3);
    scene.nodes[0].translation = {10, 0, 0};
    scene.nodes[1].parent = 0;
    scene.nodes[1].matrix = glm::scale(glm::dmat4(1.0), {1, 2, 1});
    scene.nodes[2].parent = 1;
    scene.nodes[2].translation = {1, 1, 0};
    play(scene, {channel(0, Path::Rotation, {0, 1}, {0, 0, 0, 1, 0, 0, kHalfRoot, kHalfRoot})});
    expectNear(origin(poseAt(scene, 0.0), 2), {11, 2, 0});
    const double a = glm::pi<double>() / 4.0;  // halfway to 90 degrees about z
    expectNear(origin(poseAt(scene, 0.5), 2), {10 + std::cos(a) - 2 * std::sin(a), std::sin(a) + 2 * std::cos(a), 0});
    scene.instances.push_back({"thing", 0, glm::translate(glm::mat4(1.0f), {11, 2, 3}), 2});
    scene.meshes.push_back({"thing", {triangle()}, {}});
    EXPECT_EQ(poseAt(scene, 0.0).worldFromObject[0], glm::dmat4(scene.instances[0].worldFromObject));
    // 3 m before its node at rest; the turn is about that axis.
    expectNear(glm::dvec3(poseAt(scene, 0.5).worldFromObject[0][3]),
               {10 + std::cos(a) - 2 * std::sin(a), std::sin(a) + 2 * std::cos(a), 3});
}

TEST(Pose, AStripOfTwoJoints) {
    // Joints at the strip's foot and in its middle; the upper one turns by 90 degrees about z.
    Scene scene = withNodes(2);
    scene.nodes[1].parent = 0;
    scene.nodes[1].translation = {0, 1, 0};
    scene.skins.push_back({"strip", {0, 1}, {glm::mat4(1.0f), glm::translate(glm::mat4(1.0f), {0, -1, 0})}});
    Primitive strip = triangle();
    strip.positions = {{0.5f, 0, 0}, {0.5f, 1, 0}, {0.5f, 2, 0}};
    strip.normals.assign(3, {1, 0, 0});
    strip.tangents.assign(3, {0, 1, 0, 1});
    strip.joints = {{0, 0, 0, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}};
    strip.weights = {{1, 0, 0, 0}, {0.5f, 0.5f, 0, 0}, {1, 0, 0, 0}};
    scene.meshes.push_back({"strip", {strip}, {}});
    scene.instances.push_back({"strip", 0});
    scene.instances[0].skin = 0;
    play(scene, {channel(1, Path::Rotation, {0, 1}, {0, 0, 0, 1, 0, 0, kHalfRoot, kHalfRoot})});
    const Pose start = poseAt(scene, 0.0);
    for (std::size_t v = 0; v < 3; ++v) expectNear(worldVertex(start, 0, v), strip.positions[v]);
    Pose pose = poseAt(scene, 1.0 - 1e-9);
    expectNear(worldVertex(pose, 0, 0), {0.5, 0, 0});
    expectNear(worldVertex(pose, 0, 1), {0.25, 1.25, 0});  // the mean of (0.5, 1, 0) and (0, 1.5, 0)
    expectNear(worldVertex(pose, 0, 2), {-1, 1.5, 0});
    expectNear(pose.deformed[0].normals[0], {1, 0, 0});
    expectNear(pose.deformed[0].normals[1], {kHalfRoot, kHalfRoot, 0});
    expectNear(pose.deformed[0].normals[2], {0, 1, 0});
    expectNear(glm::vec3(pose.deformed[0].tangents[2]), {-1, 0, 0});
    EXPECT_EQ(pose.deformed[0].tangents[2].w, 1.0f);
    expectNear(pose.deformed[0].bounds.min, {-1, 0, 0});

    // Into a pose that exists: the same numbers.
    poseAt(scene, 0.4, pose);
    const Pose anew = poseAt(scene, 0.4);
    EXPECT_EQ(pose.deformed[0].positions, anew.deformed[0].positions);
    EXPECT_EQ(pose.deformed[0].normals, anew.deformed[0].normals);
    EXPECT_EQ(pose.worldFromNode, anew.worldFromNode);

    // Far out it keeps its shape: floats would be 16 mm apart there.
    scene.nodes[0].translation = {250000.3f, 10.0f, -131072.0f};
    const glm::dvec3 foot(scene.nodes[0].translation);
    const Pose far = poseAt(scene, 1.0 - 1e-9);
    for (std::size_t v = 0; v < 3; ++v) {
        const glm::dvec3 world = far.worldFromObject[0] * glm::dvec4(glm::dvec3(far.deformed[0].positions[v]), 1.0);
        const glm::dvec3 expected[] = {{0.5, 0, 0}, {0.25, 1.25, 0}, {-1, 1.5, 0}};
        expectNear(world - foot, expected[v], 1e-4);
    }
}

TEST(Pose, MorphTargets) {
    Scene scene = withNodes(1);
    Primitive p = triangle();
    p.targets = {{{{0, 0, 1}, {0, 0, 0}, {0, 0, 0}}, {{0, 1, -1}, {0, 0, 0}, {0, 0, 0}}, {{0, 0, 1}, {}, {}}},
                 {{{1, 0, 0}, {1, 0, 0}, {1, 0, 0}}, {}, {}}};
    scene.meshes.push_back({"face", {p}, {0.5f, 0.0f}});
    scene.instances.push_back({"face", 0});
    expectNear(restPose(scene).deformed[0].positions[0], {0, 0, 0.5});  // the mesh's weights
    expectNear(restPose(scene).deformed[0].normals[0], {0, kHalfRoot, kHalfRoot});
    scene.instances[0].node = 0;
    scene.nodes[0].weights = {1.0f, 3.0f};
    const Pose rest = restPose(scene);
    expectNear(rest.deformed[0].positions[0], {3, 0, 1});  // the node's instead
    expectNear(rest.deformed[0].positions[1], {4, 0, 0});
    expectNear(rest.deformed[0].normals[0], {0, 1, 0});
    expectNear(glm::vec3(rest.deformed[0].tangents[0]), {kHalfRoot, 0, kHalfRoot});
    EXPECT_EQ(rest.deformed[0].tangents[0].w, -1.0f);
    play(scene, {channel(0, Path::Weights, {0, 1}, {0, 0, 0, 2})});
    expectNear(poseAt(scene, 0.5).deformed[0].positions[0], {1, 0, 0});  // the animation's
    const Bounds bounds = animatedExtent(scene, 16).drawn;
    expectNear(bounds.max, {3, 1, 0});  // the pose at rest is never shown
    EXPECT_EQ(worldBounds(scene).max, glm::vec3(4, 1, 1));
    EXPECT_EQ(worldBounds(scene).min, glm::vec3(3, 0, 0));
}

TEST(Pose, LightsAndCamerasFollow) {
    Scene scene = withNodes(1);
    scene.nodes[0].translation = {1, 2, 3};
    scene.lights.resize(2);
    scene.lights[0].kind = LightKind::Spot;
    scene.lights[0].position = {1, 3, 3};  // a metre above its node
    scene.lights[0].direction = {0, 0, -1};
    scene.lights[0].node = 0;
    scene.lights[1].position = {7, 7, 7};
    scene.cameras.resize(1);
    scene.cameras[0].worldFromCamera = glm::translate(glm::mat4(1.0f), {1, 2, 3});
    scene.cameras[0].node = 0;
    play(scene, {channel(0, Path::Rotation, {0, 1}, {0, 0, 0, 1, kHalfRoot, 0, 0, kHalfRoot}),
                 channel(0, Path::Scale, {0, 1}, {1, 1, 1, 3, 3, 3})});
    const Pose rest = poseAt(scene, 0.0);
    EXPECT_EQ(rest.lights[0].position, scene.lights[0].position);
    EXPECT_EQ(rest.lights[0].direction, scene.lights[0].direction);
    const Pose pose = poseAt(scene, 1.0 - 1e-12);  // by 90 degrees about x, three times as large
    expectNear(pose.lights[0].position, {1, 2, 6});
    expectNear(pose.lights[0].direction, {0, 1, 0});
    EXPECT_EQ(pose.lights[1].position, glm::vec3(7, 7, 7));
    const SceneCamera camera = posedCamera(scene, pose, scene.cameras[0]);
    expectNear(glm::vec3(camera.worldFromCamera[3]), {1, 2, 3});
    expectNear(-glm::vec3(camera.worldFromCamera[2]), {0, 1, 0});  // without the scale
    expectNear(glm::vec3(camera.worldFromCamera[1]), {0, 0, 1});
}

TEST(Pose, WhatRestsWithoutSizeMayGrow) {
    Scene scene = withNodes(1);
    scene.nodes[0].scale = glm::vec3(0.0f);
    scene.nodes[0].translation = {5, 0, 0};
    scene.meshes.push_back({"thing", {triangle()}, {}});
    scene.instances.push_back({"thing", 0, glm::scale(glm::translate(glm::mat4(1.0f), {5, 0, 0}), glm::vec3(0.0f)), 0});
    play(scene, {channel(0, Path::Scale, {0, 1}, {0, 0, 0, 2, 2, 2})});
    const Pose pose = poseAt(scene, 0.5);
    expectNear(glm::dvec3(pose.worldFromObject[0] * glm::dvec4(1, 0, 0, 1)), {6, 0, 0});
}

TEST(Pose, StillScenesShowThePose) {
    Scene scene = withNodes(1);
    scene.meshes.push_back({"thing", {triangle()}, {}});
    scene.meshes[0].primitives[0].targets = {{{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {}, {}}};
    scene.instances.push_back({"first", 0, glm::mat4(1.0f), 0});
    scene.instances.push_back({"second", 0});
    play(scene, {channel(0, Path::Weights, {0, 1}, {0, 2}), channel(0, Path::Translation, {0, 1}, {0, 0, 0, 4, 0, 0})});
    const Scene still = posedScene(scene, poseAt(scene, 0.5));
    EXPECT_EQ(triangleCount(still), 2u);
    const auto corner = [&](std::size_t i) {
        const Instance& instance = still.instances[i];
        return glm::dvec3(instance.worldFromObject *
                          glm::dvec4(glm::dvec3(still.meshes[instance.mesh].primitives[0].positions[0]), 1.0));
    };
    expectNear(corner(0), {2, 0, 1});
    expectNear(corner(1), {0, 0, 0});
    EXPECT_FALSE(isAnimated(still));
    EXPECT_EQ(worldBounds(still).max, glm::vec3(3, 1, 1));
    const Scene part = posablePart(scene);
    EXPECT_EQ(poseAt(part, 0.5).deformed[0].positions, poseAt(scene, 0.5).deformed[0].positions);
}

TEST(Pose, ThrownTooFarIsSaid) {
    Scene scene = withNodes(2);
    scene.nodes[1].name = "rocket";
    scene.nodes[1].parent = 0;
    play(scene, {channel(0, Path::Scale, {0, 1}, {1, 1, 1, 1e12f, 1e12f, 1e12f}),
                 channel(1, Path::Translation, {0, 1}, {0, 0, 0, 1e12f, 0, 0})});
    EXPECT_NO_THROW((void)poseAt(scene, 0.0));
    try {
        (void)poseAt(scene, 0.5);
        FAIL();
    } catch (const PoseError& error) {
        EXPECT_NE(std::string(error.what()).find("'rocket'"), std::string::npos) << error.what();
    }
    Scene face = withNodes(1);
    face.meshes.push_back({"face", {triangle()}, {}});
    face.meshes[0].primitives[0].targets = {{{{1e14f, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {}, {}}};
    face.instances.push_back({"face", 0, glm::mat4(1.0f), 0});
    play(face, {channel(0, Path::Weights, {0, 1}, {1, 1e14f})});
    EXPECT_NO_THROW((void)poseAt(face, 0.0));
    EXPECT_THROW((void)poseAt(face, 0.5), PoseError);
    face.animations[0].channels[0].values[1] = 3e38f;  // overflows to infinity
    EXPECT_THROW((void)poseAt(face, 0.5), PoseError);
}

TEST(Pose, AlternativesStandBy) {
    Scene scene = withNodes(2);
    const auto add = [&](const char* name, std::uint32_t node, Path path) {
        scene.animations.push_back({name, 1.0f, {channel(node, path, {0}, {0, 0, 0})}});
    };
    add("walk", 0, Path::Translation);
    add("run", 0, Path::Translation);
    add("grow", 0, Path::Scale);
    add("blink", 1, Path::Scale);
    const auto playing = [&] {
        std::string out;
        for (const Animation& a : scene.animations) out += a.playing ? 'p' : '-';
        return out;
    };
    playCompatible(scene, 0);
    EXPECT_EQ(playing(), "p-pp");
    EXPECT_TRUE(playAnimation(scene, "run").ok());
    EXPECT_EQ(playing(), "-ppp");
    EXPECT_TRUE(playAnimation(scene, "#0").ok());
    EXPECT_EQ(playing(), "p-pp");
    EXPECT_TRUE(playAnimation(scene, "none").ok());
    EXPECT_EQ(playing(), "----");
    for (const char* wrong : {"fly", "#4", "#", "#-1", ""}) {
        const gnomon::Result result = playAnimation(scene, wrong);
        EXPECT_FALSE(result.ok());
        EXPECT_NE(std::string(result.message()).find("walk, run"), std::string::npos) << result.message();
    }
    EXPECT_EQ(playing(), "----");
    EXPECT_TRUE(playAnimation(scene, "default").ok());
    EXPECT_EQ(playing(), "p-pp");
}
