// Which shadow views are drawn again when something moves, and that a kept view shows what a fresh one would.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <set>

#include "gpu/renderer/device_test.h"
#include "renderer/renderer.h"
#include "renderer/shadow_atlas/shadow_atlas.h"

namespace gnomon::renderer {
namespace {

using Views = std::set<std::pair<std::uint32_t, std::uint32_t>>;  // light, face

Primitive square(float halfSide) {
    Primitive p;
    p.positions = {
        {-halfSide, 0, -halfSide}, {-halfSide, 0, halfSide}, {halfSide, 0, halfSide}, {halfSide, 0, -halfSide}};
    p.normals.assign(4, {0, 1, 0});
    p.indices = {0, 1, 2, 0, 2, 3};
    for (const glm::vec3& v : p.positions) p.bounds.add(v);
    return p;
}

glm::mat4 at(const glm::vec3& place) {
    return glm::translate(glm::mat4(1.0f), place);
}

// A channel that leads a node along x, y, z within two seconds and back.
AnimationChannel path(std::uint32_t node, const glm::vec3& from, const glm::vec3& to) {
    AnimationChannel c;
    c.node = node;
    c.times = {0.0f, 1.0f, 2.0f};
    c.values = {from.x, from.y, from.z, to.x, to.y, to.z, from.x, from.y, from.z};
    return c;
}

constexpr std::uint32_t kSpotLeft = 0, kSpotRight = 1, kPoint = 2;
constexpr std::uint32_t kMover = 1, kFigure = 2;

// A floor of 60 m. Spots look down on it at x = -10 and x = 10, a point light hangs at z = -20. A slab that moves with
// a node, a strip of two joints of which one turns, and a slab that a morph target lifts.
Scene makeScene() {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].doubleSided = true;
    scene.meshes = {{"floor", {square(30.0f)}, {}},
                    {"slab", {square(0.5f)}, {}},
                    {"strip", {square(0.5f)}, {}},
                    {"lifted", {square(0.5f)}, {0.0f}}};
    Primitive& strip = scene.meshes[2].primitives[0];
    strip.joints = {{0, 0, 0, 0}, {0, 0, 0, 0}, {1, 0, 0, 0}, {1, 0, 0, 0}};
    strip.weights.assign(4, {1, 0, 0, 0});
    scene.meshes[3].primitives[0].targets.push_back({std::vector<glm::vec3>(4, {0, 1, 0}), {}, {}});
    for (const char* name : {"mover", "foot", "hand", "lifted"}) scene.nodes.push_back({name});
    scene.nodes[0].translation = {-10, 1, 0};
    scene.nodes[1].translation = {10, 1, 0};
    scene.nodes[2].parent = 1;
    scene.nodes[3].translation = {0, 1, -20};
    scene.skins.push_back({"strip", {1, 2}, {glm::mat4(1.0f), glm::mat4(1.0f)}});
    scene.instances = {{"floor", 0}, {"mover", 1, at({-10, 1, 0}), 0}, {"strip", 2}, {"lifted", 3, at({0, 1, -20}), 3}};
    scene.instances[kFigure].skin = 0;
    scene.lights.resize(3);
    for (std::uint32_t l : {kSpotLeft, kSpotRight}) {
        scene.lights[l].kind = LightKind::Spot;
        scene.lights[l].position = {l == kSpotLeft ? -10 : 10, 6, 0};
        scene.lights[l].outerConeAngle = 0.4f;
    }
    scene.lights[kPoint].position = {0, 3, -20};
    for (SceneLight& light : scene.lights) {
        light.rangeMetres = 8.0f;
        light.intensity = 300.0f;
        light.sourceRadius = 0.05f;
    }
    return scene;
}

class ShadowCacheTest : public DeviceTest {};

// A scene and its atlas, drawn with one plan until another is asked for.
struct Rig {
    explicit Rig(const Device& d, const Scene& s, std::uint32_t faceGuardTexels = 0)
        : device(d), scene(s), gpuScene(d, s), atlas(d, gpuScene, kAtlasPx), pose(restPose(s)) {
        for (const SceneLight& light : s.lights) lights.push_back(shadowLightOf(light));
        planFaces(faceGuardTexels);
    }
    void planFaces(std::uint32_t guardTexels) {
        ShadowPlanSettings settings;
        settings.faceGuardTexels = guardTexels;
        settings.atlasSizePx = kAtlasPx;
        settings.maxSpotPx = settings.maxFacePx = 128;
        ShadowPlanCamera camera;
        camera.position = {0, 4, 0};
        plan = ShadowPlanner(settings).plan(lights, camera, {}, {});
    }
    Views draw() {
        ShadowAtlasStatistics statistics;
        device.submitAndWait([&](VkCommandBuffer commands) {
            gpuScene.recordTransforms(commands, {});
            atlas.prepare(gpuScene, lights, plan);
            statistics = atlas.record(commands, gpuScene);
        });
        EXPECT_EQ(statistics.viewsDrawn + statistics.viewsCached, plan.views.size());
        EXPECT_EQ(statistics.viewsDrawn, statistics.drawnViews.size());
        Views out;
        for (std::uint32_t v : statistics.drawnViews) out.emplace(plan.views[v].light, plan.views[v].face);
        return out;
    }
    Views move(const glm::vec3& place) {
        pose.worldFromObject[kMover] = glm::dmat4(at(place));
        gpuScene.setPose(pose);
        return draw();
    }
    std::vector<std::uint8_t> texels() const {
        return readImage(device, atlas.image(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    }

    static constexpr std::uint32_t kAtlasPx = 512;
    const Device& device;
    Scene scene;
    GpuScene gpuScene;
    ShadowAtlasImage atlas;
    Pose pose;
    std::vector<ShadowLight> lights;
    ShadowPlan plan;
};

const Views kLeft = {{kSpotLeft, 0}}, kRight = {{kSpotRight, 0}};

TEST_F(ShadowCacheTest, OnlyViewsInWhichSomethingMovedAreDrawn) {
    for (const DeviceInfo& info : suitable()) {
        SCOPED_TRACE(info.name);
        std::printf("device: %s\n", info.name.c_str());
        const Device device(instance(), info);
        Rig rig(device, makeScene());
        ASSERT_EQ(rig.plan.views.size(), 8u);
        EXPECT_EQ(rig.draw().size(), 8u);
        EXPECT_EQ(rig.draw(), Views());
        rig.gpuScene.setPose(rig.pose);  // the same again
        EXPECT_EQ(rig.draw(), Views());
        EXPECT_EQ(rig.move({-10, 2, 0}), kLeft);  // within
        EXPECT_EQ(rig.move({-10, 2, 0}), Views());
        EXPECT_EQ(rig.move({0, 1, 15}), kLeft);                                      // out of it
        EXPECT_EQ(rig.move({1, 1, 15}), Views());                                    // where no light reaches
        EXPECT_EQ(rig.move({10, 2, 0}), kRight);                                     // in
        EXPECT_EQ(rig.move({-10, 2, 0}), (Views{{kSpotLeft, 0}, {kSpotRight, 0}}));  // out of one, into the other
        EXPECT_EQ(rig.move({0, 1, 15}), kLeft);
        EXPECT_EQ(rig.move({4, 3, -20}), (Views{{kPoint, 0}}));  // before one face of six
        EXPECT_EQ(rig.move({4, 3, -24}), (Views{{kPoint, 0}, {kPoint, 5}}));
        EXPECT_EQ(rig.move({-10, 2, 0}), (Views{{kSpotLeft, 0}, {kPoint, 0}, {kPoint, 5}}));

        // Two moves between two frames: what lies between was never drawn, but may be drawn again.
        rig.gpuScene.setInstance(kMover, glm::dmat4(at({10, 2, 0})));
        rig.gpuScene.setInstance(kMover, glm::dmat4(at({0, 1, 15})));
        const Views both = rig.draw();
        EXPECT_TRUE(both.contains({kSpotLeft, 0}));
        EXPECT_FALSE(both.contains({kPoint, 0}));
        for (int i = 0; i < 3000; ++i)
            rig.gpuScene.setInstance(kMover, glm::dmat4(at({0, 1, 15.0f + 1e-3f * float(i)})));
        EXPECT_EQ(rig.draw().size(), 8u);  // more changes than are remembered
        EXPECT_EQ(rig.draw(), Views());
    }
    expectNoMessages();
}

TEST_F(ShadowCacheTest, WhatDeformsCountsAsMoving) {
    for (const DeviceInfo& info : suitable()) {
        SCOPED_TRACE(info.name);
        const Device device(instance(), info);
        Rig rig(device, makeScene());
        rig.draw();
        Scene moved = rig.scene;
        moved.nodes[2].rotation = glm::angleAxis(0.5f, glm::vec3(0, 0, 1));
        rig.gpuScene.setPose(restPose(moved));
        EXPECT_EQ(rig.draw(), kRight);
        moved.nodes[3].weights = {0.5f};
        rig.gpuScene.setPose(restPose(moved));
        EXPECT_EQ(rig.draw(), (Views{{kPoint, 3}}));
        rig.gpuScene.setPose(restPose(moved));
        EXPECT_EQ(rig.draw(), Views());
        // A scale of zero takes it away, and another brings it back.
        Pose pose = restPose(moved);
        const glm::dmat4 whole = pose.worldFromObject[3];
        pose.worldFromObject[3] = glm::scale(whole, glm::dvec3(0.0));
        rig.gpuScene.setPose(pose);
        EXPECT_EQ(rig.draw(), (Views{{kPoint, 3}}));
        pose.worldFromObject[3] = whole;
        rig.gpuScene.setPose(pose);
        EXPECT_EQ(rig.draw(), (Views{{kPoint, 3}}));
    }
    expectNoMessages();
}

// Other guard texels: the same squares show something else.
TEST_F(ShadowCacheTest, WiderFacesAreDrawnAgain) {
    for (const DeviceInfo& info : suitable()) {
        SCOPED_TRACE(info.name);
        const Device device(instance(), info);
        Rig rig(device, makeScene());
        rig.draw();
        const Views all = {{kPoint, 0}, {kPoint, 1}, {kPoint, 2}, {kPoint, 3}, {kPoint, 4}, {kPoint, 5}};
        rig.planFaces(16);
        EXPECT_EQ(rig.draw(), all);
        EXPECT_EQ(rig.draw(), Views());
        EXPECT_EQ(rig.texels(), [&] {
            Rig fresh(device, makeScene(), 16);
            fresh.draw();
            return fresh.texels();
        }());
        rig.planFaces(0);
        EXPECT_EQ(rig.draw(), all);
    }
    expectNoMessages();
}

// What lies beyond 90 degrees of a face is drawn in it where it is wide enough.
TEST_F(ShadowCacheTest, WiderFacesHaveMoreCasters) {
    for (const DeviceInfo& info : suitable()) {
        SCOPED_TRACE(info.name);
        const Device device(instance(), info);
        const glm::vec3 beside(4, 2, -26);  // 4 m and 6 m aside of the point light: the -z face's, beside the +x face
        Rig narrow(device, makeScene());
        narrow.draw();
        EXPECT_EQ(narrow.move(beside), (Views{{kSpotLeft, 0}, {kPoint, 5}}));
        Rig wide(device, makeScene(), 16);
        wide.draw();
        const std::vector<std::uint8_t> before = wide.texels();
        EXPECT_EQ(wide.move(beside), (Views{{kSpotLeft, 0}, {kPoint, 0}, {kPoint, 5}}));
        const PlannedView& face = wide.plan.views.at(wide.plan.firstView.at(kPoint));
        const std::vector<std::uint8_t> after = wide.texels();
        std::size_t changed = 0;
        for (std::size_t y = face.y; y < face.y + face.size; ++y) {
            const std::size_t row = (std::size_t{Rig::kAtlasPx} * y + face.x) * sizeof(float);
            changed += std::memcmp(&before[row], &after[row], face.size * sizeof(float)) != 0 ? 1 : 0;
        }
        EXPECT_GT(changed, 0u) << "nothing of the caster is in the wide face";
    }
    expectNoMessages();
}

// Depths along a sun's way depend on all that is seen. Where they change alone, what was kept says something else.
TEST_F(ShadowCacheTest, OtherDepthsOfACascadeAreDrawnAgain) {
    for (const DeviceInfo& info : suitable()) {
        SCOPED_TRACE(info.name);
        const Device device(instance(), info);
        Scene scene = makeScene();
        scene.lights = {{"sun", LightKind::Directional}};
        scene.lights[0].direction = {0, -1, 0};
        Rig rig(device, scene);
        ShadowPlanSettings settings;
        settings.atlasSizePx = Rig::kAtlasPx;
        settings.cascades.count = 1;
        ShadowPlanCamera camera;
        camera.cascades.position = camera.position = {0, 4, 40};
        const auto cube = [](double y, double half, bool seen) {
            return ScenePart{{0.0, y, 0.0}, 2.0 * half, seen, glm::dmat3(half)};
        };
        std::vector<ScenePart> parts = {cube(0.0, 30.0, true), cube(-45.0, 1.0, false)};
        const auto planned = [&] { return ShadowPlanner(settings).plan(rig.lights, camera, parts, {}); };
        const ShadowPlan first = rig.plan = planned();
        EXPECT_EQ(rig.draw().size(), 1u);
        EXPECT_EQ(rig.draw(), Views());
        parts[1].seen = true;  // below all else
        rig.plan = planned();
        const Cascade &before = first.views.at(0).cascade, &after = rig.plan.views.at(0).cascade;
        ASSERT_EQ(after.centre, before.centre);
        ASSERT_EQ(after.halfExtent, before.halfExtent);
        ASSERT_GT(after.depth, before.depth);
        EXPECT_EQ(rig.draw().size(), 1u);
        Rig fresh(device, scene);
        fresh.plan = rig.plan;
        fresh.draw();
        EXPECT_EQ(rig.texels(), fresh.texels());
    }
    expectNoMessages();
}

Scene animatedScene() {
    Scene scene = makeScene();
    Animation animation;
    animation.durationSeconds = 2.0f;
    animation.channels = {path(0, {-10, 1, 0}, {10, 2, 1}), path(1, {10, 1, 0}, {9, 1, 0})};
    AnimationChannel turn;
    turn.node = 2;
    turn.path = AnimationChannel::Path::Rotation;
    turn.times = {0.0f, 2.0f};
    turn.values = {0, 0, 0, 1, 0, 0, 0.7071068f, 0.7071068f};
    AnimationChannel lift;
    lift.node = 3;
    lift.path = AnimationChannel::Path::Weights;
    lift.times = {0.0f, 0.7f, 2.0f};
    lift.values = {0, 1, 0};
    animation.channels.push_back(turn);
    animation.channels.push_back(lift);
    scene.animations.push_back(animation);
    return scene;
}

TEST_F(ShadowCacheTest, KeptViewsAreWhatFreshOnesWouldBe) {
    for (const DeviceInfo& info : suitable()) {
        SCOPED_TRACE(info.name);
        const Device device(instance(), info);
        const Scene scene = animatedScene();
        Rig kept(device, scene);
        std::size_t drawn = 0;
        std::vector<std::uint8_t> before;
        for (int frame = 0; frame < 8; ++frame) {
            const double seconds = 0.3 * frame;
            kept.gpuScene.setPose(poseAt(scene, seconds));
            drawn += kept.draw().size();
            Rig fresh(device, scene);
            fresh.gpuScene.setPose(poseAt(scene, seconds));
            fresh.draw();
            const auto texels = kept.texels();
            EXPECT_EQ(texels, fresh.texels()) << "at " << seconds << " s";
            EXPECT_NE(texels, before);
            before = texels;
        }
        EXPECT_LT(drawn, 40u);  // of 64
    }
    expectNoMessages();
}

// Vertices and matrices of frames in flight, lights and the camera that follow nodes, time that stands still.
TEST_F(ShadowCacheTest, RendererFollowsTime) {
    for (const DeviceInfo& info : suitable()) {
        SCOPED_TRACE(info.name);
        const Device device(instance(), info);
        Scene scene = animatedScene();
        scene.nodes.push_back({"lamp"});
        scene.nodes.back().translation = {0, 3, -20};
        scene.lights[kPoint].node = 4;
        scene.animations[0].channels.push_back(path(4, {0, 3, -20}, {1, 3, -20}));
        scene.cameras.resize(1);
        scene.cameras[0].worldFromCamera =
            glm::inverse(glm::lookAt(glm::vec3(0, 12, 24), glm::vec3(0, 0, -6), glm::vec3(0, 1, 0)));
        RendererDesc desc;
        desc.frame.widthPx = 160;
        desc.frame.heightPx = 96;
        desc.atlasSizePx = 512;
        desc.frame.filters = {Filter::Hard};
        const auto pipelines = std::make_shared<SharedPipelines>(device);
        Renderer kept(device, scene, desc, pipelines);
        for (double seconds : {0.0, 0.25, 0.5, 0.75}) kept.renderFrame(scene.cameras[0], ShadowMode::Deferred, seconds);
        const std::vector<float> moving = kept.readPicture().rgba;
        const std::vector<std::uint32_t> ids = kept.readTriangleIds();
        Renderer fresh(device, scene, desc, pipelines);
        fresh.renderFrame(scene.cameras[0], ShadowMode::Deferred, 0.75);
        EXPECT_EQ(moving, fresh.readPicture().rgba);
        EXPECT_EQ(ids, fresh.readTriangleIds());

        const std::uint64_t still = kept.renderFrame(scene.cameras[0], ShadowMode::Deferred, 0.75);
        kept.wait();
        EXPECT_EQ(kept.report(still).shadowViewsDrawn, 0u);
        EXPECT_EQ(kept.readPicture().rgba, moving);
        const std::uint64_t looped = kept.renderFrame(scene.cameras[0], ShadowMode::Deferred, 2.75);
        kept.wait();
        EXPECT_EQ(kept.report(looped).shadowViewsDrawn, 0u);
        kept.renderFrame(scene.cameras[0], ShadowMode::Deferred, 1.0);
        EXPECT_NE(kept.readPicture().rgba, moving);

        // The camera rides on the mover.
        SceneCamera riding = scene.cameras[0];
        riding.node = 0;
        Renderer& riders = fresh;
        riders.renderFrame(riding, ShadowMode::Deferred, 1.0);
        SceneCamera placed = scene.cameras[0];
        placed.worldFromCamera = at({20, 1, 1}) * placed.worldFromCamera;
        const std::vector<std::uint32_t> ridden = riders.readTriangleIds();
        riders.renderFrame(placed, ShadowMode::Deferred, 1.0);
        EXPECT_EQ(ridden, riders.readTriangleIds());
    }
    expectNoMessages();
}

std::size_t differingPixels(const std::vector<float>& a, const std::vector<float>& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); i += 4) {
        float difference = 0.0f;
        for (std::size_t c = 0; c < 3; ++c)
            difference = std::max(difference, std::abs(a[i + c] - b[i + c]) / (1e-3f + std::max(a[i + c], b[i + c])));
        count += difference > 0.02f ? 1 : 0;
    }
    return count;
}

// A moment of an animation looks like a still scene of that moment. The slab is thrown far out of the scene's bounds
// for so short a time that nobody who looks ahead finds it, and still it takes the sun away.
TEST_F(ShadowCacheTest, AMomentLooksLikeAStillScene) {
    for (const DeviceInfo& info : suitable()) {
        SCOPED_TRACE(info.name);
        const Device device(instance(), info);
        Scene scene = animatedScene();
        scene.meshes[1].primitives[0] = square(4.0f);
        AnimationChannel& leap = scene.animations[0].channels[0];
        leap.interpolation = AnimationChannel::Interpolation::Step;
        leap.times = {0.0f, 0.26f, 0.27f};
        leap.values = {0, 0, 0, 0, 0, 5, 0, 0, 0};
        for (std::size_t k = 0; k < 3; ++k) leap.values[3 * k + 1] = k == 1 ? 80.0f : -5.0f;
        scene.lights.push_back({"sun", LightKind::Directional});
        scene.lights.back().direction = {0, -1, 0};
        scene.lights.back().intensity = 5.0f;
        scene.lights.back().sourceRadius = 0.001f;
        SceneCamera camera;
        camera.worldFromCamera = glm::inverse(glm::lookAt(glm::vec3(0, 20, 30), glm::vec3(0), glm::vec3(0, 1, 0)));
        RendererDesc desc;
        desc.frame.widthPx = 160;
        desc.frame.heightPx = 96;
        desc.atlasSizePx = 2048;
        desc.frame.filters = {Filter::Hard};
        const auto pipelines = std::make_shared<SharedPipelines>(device);
        Renderer moving(device, scene, desc, pipelines);
        moving.renderFrame(camera, ShadowMode::Deferred, 0.1);
        const std::vector<float> before = moving.readPicture().rgba;
        moving.renderFrame(camera, ShadowMode::Deferred, 0.265);
        const std::vector<float> picture = moving.readPicture().rgba;
        Renderer still(device, posedScene(scene, poseAt(scene, 0.265)), desc, pipelines);
        still.renderFrame(camera, ShadowMode::Deferred);
        EXPECT_GT(differingPixels(before, picture), 150u);                   // the shadow of the slab
        EXPECT_LT(differingPixels(picture, still.readPicture().rgba), 60u);  // its edges: other cascades
        EXPECT_EQ(moving.readTriangleIds(), still.readTriangleIds());
    }
    expectNoMessages();
}

}  // namespace
}  // namespace gnomon::renderer
