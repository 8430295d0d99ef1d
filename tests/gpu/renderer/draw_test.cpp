// The G-buffer and the shadow atlas against closed formulas, on every Vulkan device found, with validation.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "gpu/renderer/device_test.h"
#include "gpu/renderer/drawing.h"
#include "renderer/gbuffer/gbuffer.h"
#include "renderer/shadow_atlas/shadow_atlas.h"

namespace gnomon::renderer {
namespace {

// A 20 m floor at y = 0, a mirrored square 1 m above it, and far away one more that nothing sees.
Scene testScene(const glm::vec3& place) {
    Scene scene;
    scene.materials.resize(2);
    scene.materials[0].baseColour = {0.5f, 0.25f, 1.0f, 1.0f};
    scene.materials[1].doubleSided = true;
    scene.materials[1].subsurface = true;
    scene.meshes = {squareMesh(), squareMesh()};
    scene.meshes[1].primitives[0].material = 1;
    const glm::mat4 faceUp = glm::rotate(glm::mat4(1.0f), glm::radians(-90.0f), glm::vec3(1, 0, 0));
    const glm::mat4 at = glm::translate(glm::mat4(1.0f), place);
    scene.instances.push_back({"floor", 0, at * glm::scale(glm::mat4(1.0f), glm::vec3(10.0f)) * faceUp});
    scene.instances.push_back(
        {"roof", 1,
         at * glm::translate(glm::mat4(1.0f), {0, 1, 0}) * faceUp * glm::scale(glm::mat4(1.0f), {-0.5f, 0.5f, 1})});
    scene.instances.push_back({"unseen", 1, at * glm::translate(glm::mat4(1.0f), {500, 0, 0}) * faceUp});
    return scene;
}

double viewDepthOf(const TestCamera& c, double device) {
    const double n = 0.1, f = 100.0;
    const bool reversed = c.camera.deviceDepth == DeviceDepth::ReversedZ;
    if (c.orthographic) return reversed ? f - device * (f - n) : n + device * (f - n);
    return reversed ? n / device : n / (1.0 - device);
}

class DrawTest : public DeviceTest {};

void checkGBuffer(const Device& device, bool orthographic, DeviceDepth depth, const glm::vec3& place) {
    const Scene scene = testScene(place);
    GpuScene gpuScene(device, scene);
    GBuffer gbuffer(device, gpuScene, 65, 65);
    // The origin is the scene's place, so everything the shaders see is small.
    const TestCamera test = cameraAbove({0.0f, 4.0f, 0.0f}, orthographic, depth);
    const GBufferCamera camera = gbufferCameraOf(test.camera);
    EXPECT_FALSE(camera.mirrored);
    GBufferStatistics statistics;
    device.submitAndWait([&](VkCommandBuffer commands) {
        gpuScene.recordTransforms(commands, glm::dvec3(place));
        statistics = gbuffer.record(commands, gpuScene, camera);
    });
    EXPECT_EQ(statistics.triangles, 4u);  // the unseen square is culled
    const auto depths = readAs<float>(device, gbuffer.depth());
    const auto faces = readAs<std::uint32_t>(device, gbuffer.image(GBuffer::FaceNormal));
    const auto normals = readAs<std::uint32_t>(device, gbuffer.image(GBuffer::Normal));
    const auto ids = readAs<std::uint32_t>(device, gbuffer.image(GBuffer::TriangleId));
    const auto receivers = readAs<std::uint16_t>(device, gbuffer.image(GBuffer::Receiver));
    for (int y = 0; y < 65; ++y) {
        for (int x = 0; x < 65; ++x) {
            const int i = y * 65 + x;
            const double ndcX = (x + 0.5) / 32.5 - 1.0, ndcY = (y + 0.5) / 32.5 - 1.0;
            const double reach = orthographic ? 4.0 : 3.0;  // metres at ndc 1 in the roof's plane
            const double roofX = std::abs(ndcX) * reach, roofZ = std::abs(ndcY) * reach;
            if (std::abs(std::max(roofX, roofZ) - 0.5) < 0.05) continue;  // the roof's edge
            const bool roof = std::max(roofX, roofZ) < 0.5;
            const TriangleSource source = gpuScene.triangle(ids[i]);
            ASSERT_EQ(source.instance, roof ? 1u : 0u) << x << "," << y;
            ASSERT_EQ(gpuScene.trianglePosition(ids[i]), source.instance * 2 + source.triangle);
            // Camera up is -z: pixel down is +z. On the floor the object's y is -z: the diagonal splits at x = -z.
            if (!roof && std::abs(ndcX + ndcY) > 0.05) {
                ASSERT_EQ(source.triangle, ndcX > -ndcY ? 0u : 1u) << x << "," << y;
            }
            ASSERT_NEAR(viewDepthOf(test, depths[i]), roof ? 3.0 : 4.0, 2e-4) << x << "," << y;
            ASSERT_NEAR(decodeOctahedral(faces[i]).y, 1.0f, 1e-6f) << x << "," << y;
            ASSERT_NEAR(decodeOctahedral(normals[i]).y, 1.0f, 1e-4f) << x << "," << y;
            ASSERT_EQ(receivers[i], roof ? 0x01FFu : 0x00FFu);
        }
    }
}

TEST_F(DrawTest, GBufferHoldsDepthFaceNormalAndTriangle) {
    for (const DeviceInfo& info : suitable()) {
        SCOPED_TRACE(info.name);
        std::printf("device: %s\n", info.name.c_str());
        const Device device(instance(), info);
        checkGBuffer(device, false, DeviceDepth::ReversedZ, {0, 0, 0});
        checkGBuffer(device, false, DeviceDepth::StandardZ, {0, 0, 0});
        checkGBuffer(device, true, DeviceDepth::ReversedZ, {0, 0, 0});
        checkGBuffer(device, true, DeviceDepth::StandardZ, {0, 0, 0});
        checkGBuffer(device, false, DeviceDepth::ReversedZ, {250000, 1000, -250000});
    }
    expectNoMessages();
}

// Winding: of four squares, plain or mirrored, towards the camera or away, single-sided ones show their front alone,
// and whatever shows has its face normal towards the camera. A fifth is cut out by its alpha.
TEST_F(DrawTest, WindingAndAlphaDecideWhatShows) {
    for (const DeviceInfo& info : suitable()) {
        SCOPED_TRACE(info.name);
        const Device device(instance(), info);
        Scene scene;
        scene.materials.resize(2);
        scene.materials[1].alphaMode = AlphaMode::Mask;
        scene.materials[1].doubleSided = true;
        scene.materials[1].baseColourTexture.image = 0;
        scene.images.push_back({1, 1, {255, 255, 255, 100}});
        scene.meshes = {squareMesh(), squareMesh()};
        scene.meshes[1].primitives[0].material = 1;
        scene.meshes[1].primitives[0].normals.assign(4, {0, 0, 1});
        const glm::mat4 faceUp = glm::rotate(glm::mat4(1.0f), glm::radians(-90.0f), glm::vec3(1, 0, 0));
        const glm::mat4 turned = glm::rotate(glm::mat4(1.0f), glm::radians(90.0f), glm::vec3(1, 0, 0));
        const glm::mat4 mirror = glm::scale(glm::mat4(1.0f), {-1, 1, 1});
        auto at = [](float x) { return glm::translate(glm::mat4(1.0f), {x, 0, 0}); };
        const glm::mat4 places[] = {at(-3) * faceUp, at(-1) * faceUp * mirror, at(1) * turned, at(3) * turned * mirror};
        for (const glm::mat4& place : places) scene.instances.push_back({"square", 0, place});
        scene.instances.push_back({"masked", 1, at(-3) * glm::translate(glm::mat4(1.0f), {0, 1, 0}) * faceUp});
        GpuScene gpuScene(device, scene);
        GBuffer gbuffer(device, gpuScene, 64, 64);
        auto draw = [&] {
            const TestCamera test = cameraAbove({0, 4, 0}, true, DeviceDepth::ReversedZ);
            device.submitAndWait([&](VkCommandBuffer commands) {
                gpuScene.recordTransforms(commands, {});
                gbuffer.record(commands, gpuScene, gbufferCameraOf(test.camera));
            });
        };
        draw();
        const auto ids = readAs<std::uint32_t>(device, gbuffer.image(GBuffer::TriangleId));
        const auto faces = readAs<std::uint32_t>(device, gbuffer.image(GBuffer::FaceNormal));
        for (std::uint32_t square = 0; square < 4; ++square) {
            const std::uint32_t pixel = 33 * 64 + 8 + 16 * square;
            EXPECT_EQ(gpuScene.triangle(ids[pixel]).instance, square < 2 ? square : kNone);
            if (square >= 2) continue;
            EXPECT_NEAR(decodeOctahedral(faces[pixel]).y, 1.0f, 1e-6f);
        }
        gpuScene.setInstance(4, glm::dmat4(glm::translate(glm::mat4(1.0f), {0, -1, 0})));
        EXPECT_EQ(gpuScene.castersRevision(), 2u);
        draw();
    }
    expectNoMessages();
}

// A spot 5 m above the floor, and a point light 0.5 m above the roof: depths are known everywhere.
TEST_F(DrawTest, ShadowAtlasHoldsLinearDepthAndCaches) {
    for (const DeviceInfo& info : suitable()) {
        SCOPED_TRACE(info.name);
        const Device device(instance(), info);
        const Scene scene = testScene({0, 0, 0});
        GpuScene gpuScene(device, scene);
        ShadowPlanSettings settings;
        settings.atlasSizePx = 512;
        settings.maxSpotPx = settings.maxFacePx = 128;
        ShadowAtlasImage atlas(device, gpuScene, settings.atlasSizePx);
        ShadowPlanner planner(settings);
        std::vector<ShadowLight> lights(2);
        lights[0].kind = LightKind::Spot;
        lights[0].position = {0.0, 5.0, 0.0};
        lights[0].rangeMetres = 10.0f;
        lights[0].outerConeAngle = 0.4f;
        lights[1].position = {0.0, 1.5, 0.0};
        lights[1].rangeMetres = 8.0f;
        ShadowPlanCamera camera;
        camera.position = {0.0, 4.0, 0.0};
        ShadowPlan plan = planner.plan(lights, camera, {}, {});
        ASSERT_EQ(plan.views.size(), 7u);
        auto draw = [&] {
            ShadowAtlasStatistics statistics;
            device.submitAndWait([&](VkCommandBuffer commands) {
                gpuScene.recordTransforms(commands, {});
                atlas.prepare(gpuScene, lights, plan);
                statistics = atlas.record(commands, gpuScene);
            });
            return statistics;
        };
        EXPECT_EQ(draw().viewsDrawn, 7u);
        const auto depths = readAs<float>(device, atlas.image());
        for (const PlannedView& planned : plan.views) {
            const ShadowView& view = planned.view;
            const glm::mat4 worldFromClip = glm::inverse(glm::make_mat4(view.clipFromWorld));
            const glm::dvec3 light = lights[planned.light].position;
            for (std::uint32_t y = 0; y < planned.size; ++y) {
                for (std::uint32_t x = 0; x < planned.size; ++x) {
                    const float ndcX = (static_cast<float>(x) + 0.5f) / static_cast<float>(planned.size) * 2.0f - 1.0f;
                    const float ndcY = (static_cast<float>(y) + 0.5f) / static_cast<float>(planned.size) * 2.0f - 1.0f;
                    const glm::vec4 through = worldFromClip * glm::vec4(ndcX, ndcY, 0.9f, 1.0f);
                    const glm::dvec3 ray = glm::dvec3(glm::vec3(through) / through.w) - light;
                    const float got = depths[(planned.y + y) * settings.atlasSizePx + planned.x + x];
                    const glm::dvec3 forward = planned.light == 0
                                                   ? glm::dvec3(0, -1, 0)
                                                   : glm::dvec3((planned.face == 0) - (planned.face == 1),
                                                                (planned.face == 2) - (planned.face == 3),
                                                                (planned.face == 4) - (planned.face == 5));
                    double expected = 0.0;  // nothing
                    bool edge = ray.y > -1e-3;
                    if (ray.y < -1e-3) {
                        const glm::dvec3 roof = light + ray * ((1.0 - light.y) / ray.y),
                                         floor = light - ray * (light.y / ray.y);
                        const double r = std::max(std::abs(roof.x), std::abs(roof.z)),
                                     f = std::max(std::abs(floor.x), std::abs(floor.z));
                        edge = std::abs(r - 0.5) < 0.1 || std::abs(f - 10.0) < 1.0;
                        const double linear = glm::dot((r < 0.5 ? roof : floor) - light, forward);
                        const double n = view.nearMetres, far = view.farMetres;
                        edge = edge || std::abs(linear - far) < 0.3;
                        if ((r < 0.5 || f < 10.0) && linear < far)
                            expected = -n / (far - n) + n * far / (far - n) / linear;
                    }
                    if (edge) continue;
                    ASSERT_NEAR(got, expected, 2e-6 + expected * 2e-4)
                        << "light " << planned.light << " face " << planned.face << " at " << x << "," << y;
                }
            }
        }
        const ShadowAtlasStatistics again = draw();
        EXPECT_EQ(again.viewsDrawn, 0u);
        EXPECT_EQ(again.viewsCached, 7u);
        lights[1].position.x += 0.1;
        EXPECT_EQ(draw().viewsDrawn, 6u);
        gpuScene.setInstance(1, glm::dmat4(1.0));
        EXPECT_EQ(draw().viewsDrawn, 7u);
    }
    expectNoMessages();
}

}  // namespace
}  // namespace gnomon::renderer
