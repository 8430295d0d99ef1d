// Surfaces that are easily lost or lit wrongly: flat instances, alphas at their cut-off, backs with normal maps.
#include <gtest/gtest.h>

#include "gpu/renderer/device_test.h"
#include "gpu/renderer/drawing.h"
#include "renderer/shadow_atlas/shadow_atlas.h"

namespace gnomon::renderer {
namespace {

constexpr std::uint32_t kSize = 64;

class SurfaceTest : public DeviceTest {};

struct Drawn {
    std::vector<std::uint32_t> instances;  // per pixel; kNone: background
    std::vector<std::uint32_t> normals, faces;
    std::uint64_t triangles = 0;
};

// Seen from 4 m above the origin.
Drawn draw(const Device& device, const Scene& scene, bool orthographic) {
    GpuScene gpuScene(device, scene);
    GBuffer gbuffer(device, gpuScene, kSize, kSize);
    const TestCamera test = cameraAbove({0, 4, 0}, orthographic, DeviceDepth::ReversedZ);
    Drawn drawn;
    device.submitAndWait([&](VkCommandBuffer commands) {
        gpuScene.recordTransforms(commands, {});
        drawn.triangles = gbuffer.record(commands, gpuScene, gbufferCameraOf(test.camera)).triangles;
    });
    for (std::uint32_t id : readAs<std::uint32_t>(device, gbuffer.image(GBuffer::TriangleId)))
        drawn.instances.push_back(gpuScene.triangle(id).instance);
    drawn.normals = readAs<std::uint32_t>(device, gbuffer.image(GBuffer::Normal));
    drawn.faces = readAs<std::uint32_t>(device, gbuffer.image(GBuffer::FaceNormal));
    return drawn;
}

glm::mat4 turnedAboutX(float degrees) {
    return glm::rotate(glm::mat4(1.0f), glm::radians(degrees), glm::vec3(1, 0, 0));
}

std::uint32_t pixelAt(float ndcX, float ndcY) {
    const auto px = [](float ndc) { return static_cast<std::uint32_t>((0.5f * ndc + 0.5f) * kSize); };
    return px(ndcY) * kSize + px(ndcX);
}

void expectNear(const glm::vec3& got, const glm::vec3& expected, float tolerance) {
    EXPECT_LT(glm::length(got - expected), tolerance)
        << got.x << " " << got.y << " " << got.z << " not " << expected.x << " " << expected.y << " " << expected.z;
}

// One square, seen from both sides; without instances.
Scene squareScene() {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].doubleSided = true;
    scene.meshes = {squareMesh()};
    return scene;
}

// A square that leans by 40 degrees, pressed into the plane y = 1: 2 m wide and 2 m * cos 40 degrees deep.
TEST_F(SurfaceTest, FlatInstancesAreDrawn) {
    for (const DeviceInfo& info : suitable()) {
        SCOPED_TRACE(info.name);
        const Device device(instance(), info);
        Scene scene = squareScene();
        scene.meshes[0].primitives[0].normals.assign(4, {0, 0, 1});
        const auto pressed = [](const glm::vec3& place, const glm::vec3& scale) {
            return glm::translate(glm::mat4(1.0f), place) * glm::scale(glm::mat4(1.0f), scale) * turnedAboutX(-50.0f);
        };
        scene.instances.push_back({"flat", 0, pressed({0, 1, 0}, {1, 0, 1})});
        scene.instances.push_back({"tiny", 0, pressed({2.5f, 1, 0}, {1e-13f, 1e-13f, 1e-13f})});
        scene.meshes.push_back(squareMesh());
        for (glm::vec3& p : scene.meshes[1].primitives[0].positions) p *= 5e12f;
        scene.meshes[1].primitives[0].bounds = {glm::vec3(-5e12f), glm::vec3(5e12f)};
        scene.instances[1].mesh = 1;
        scene.instances.push_back({"line", 0, pressed({-2.5f, 1, 0}, {1, 0, 0})});
        scene.instances.push_back({"point", 0, pressed({-2.5f, 1, 0}, {0, 0, 0})});
        const Drawn drawn = draw(device, scene, true);
        EXPECT_EQ(drawn.triangles, 4u);  // lines and points are not even sent
        const std::uint32_t middle = pixelAt(0.01f, 0.01f);
        EXPECT_EQ(drawn.instances[middle], 0u);
        expectNear(decodeOctahedral(drawn.faces[middle]), {0, 1, 0}, 1e-4f);
        expectNear(decodeOctahedral(drawn.normals[middle]), {0, 1, 0}, 1e-3f);
        EXPECT_EQ(drawn.instances[pixelAt(0.23f, 0.14f)], 0u);
        EXPECT_EQ(drawn.instances[pixelAt(0.01f, 0.23f)], kNone);  // foreshortened
        EXPECT_EQ(drawn.instances[pixelAt(2.5f / 4.0f + 0.01f, 0.01f)], 1u);
        EXPECT_EQ(drawn.instances[pixelAt(-2.5f / 4.0f, 0.01f)], kNone);
    }
    expectNoMessages();
}

// What is pressed flat casts as it is seen: a spot 5 m above finds it in its map, and the floor beside it.
TEST_F(SurfaceTest, FlatInstancesCast) {
    for (const DeviceInfo& info : suitable()) {
        SCOPED_TRACE(info.name);
        const Device device(instance(), info);
        Scene scene = squareScene();
        const glm::mat4 flat =
            glm::translate(glm::mat4(1.0f), {0, 1, 0}) * glm::scale(glm::mat4(1.0f), {0.5f, 0, 0.5f});
        scene.instances.push_back({"flat", 0, flat * turnedAboutX(-50.0f)});
        scene.instances.push_back({"floor", 0, glm::scale(glm::mat4(1.0f), glm::vec3(9.0f)) * turnedAboutX(-90.0f)});
        GpuScene gpuScene(device, scene);
        ShadowPlanSettings settings;
        settings.atlasSizePx = settings.minSpotPx = settings.maxSpotPx = 256;
        ShadowAtlasImage atlas(device, gpuScene, settings.atlasSizePx);
        ShadowLight spot;
        spot.kind = LightKind::Spot;
        spot.position = {0.0, 5.0, 0.0};
        spot.rangeMetres = 10.0f;
        spot.outerConeAngle = 0.4f;
        ShadowPlan plan = ShadowPlanner(settings).plan({&spot, 1}, {}, {}, {});
        ASSERT_EQ(plan.views.size(), 1u);
        device.submitAndWait([&](VkCommandBuffer commands) {
            gpuScene.recordTransforms(commands, {});
            atlas.prepare(gpuScene, {&spot, 1}, plan);
            atlas.record(commands, gpuScene);
        });
        const std::vector<float> depths = readAs<float>(device, atlas.image());
        const ShadowView& view = plan.views[0].view;
        const auto metresAt = [&](const glm::vec3& point) {
            const glm::vec4 clip = glm::make_mat4(view.clipFromWorld) * glm::vec4(point, 1.0f);
            const auto px = [&](float ndc) { return static_cast<std::uint32_t>((0.5f * ndc + 0.5f) * 256.0f); };
            const float depth = depths.at(std::size_t{px(clip.y / clip.w)} * 256 + px(clip.x / clip.w));
            const float n = view.nearMetres, f = view.farMetres;
            return n * f / (depth * (f - n) + n);
        };
        // Half a metre to each side along x, and 0.5 m * cos 40 degrees = 0.38 m along z.
        EXPECT_NEAR(metresAt({0, 1, 0}), 4.0f, 0.01f);
        EXPECT_NEAR(metresAt({0.45f, 1, 0.34f}), 4.0f, 0.01f);
        EXPECT_NEAR(metresAt({0, 1, 0.43f}), 5.0f, 0.01f);
        EXPECT_NEAR(metresAt({0.55f, 1, 0}), 5.0f, 0.01f);
    }
    expectNoMessages();
}

// Normals in the plane of a flat instance are lost with their length: the face's own stands in.
TEST_F(SurfaceTest, FlatInstancesKeepTheirNormals) {
    for (const DeviceInfo& info : suitable()) {
        SCOPED_TRACE(info.name);
        const Device device(instance(), info);
        Scene scene = squareScene();
        scene.meshes[0].primitives[0].normals.assign(4, {1, 0, 0});
        scene.instances.push_back({"flat", 0, glm::scale(glm::mat4(1.0f), {1, 0, 1}) * turnedAboutX(-50.0f)});
        const Drawn drawn = draw(device, scene, true);
        const std::uint32_t middle = pixelAt(0.01f, 0.01f);
        ASSERT_EQ(drawn.instances[middle], 0u);
        expectNear(decodeOctahedral(drawn.normals[middle]), {0, 1, 0}, 1e-3f);
    }
    expectNoMessages();
}

// Alpha equal to the cut-off is opaque: by the material's factor, by vertices, which are stored in half precision, and
// by a texture. One step of eight bits below it is cut out.
TEST_F(SurfaceTest, AlphaEqualToTheCutoffIsOpaque) {
    for (const DeviceInfo& info : suitable()) {
        SCOPED_TRACE(info.name);
        const Device device(instance(), info);
        Scene scene;
        scene.materials.resize(1);
        scene.materials[0].doubleSided = true;
        scene.images.push_back({1, 1, {255, 255, 255, 100}});
        scene.meshes = {squareMesh()};
        scene.instances.push_back({"leaf", 0, turnedAboutX(-35.0f) * glm::scale(glm::mat4(1.0f), {2.0f, 2.0f, 1.0f})});
        Material& material = scene.materials[0];
        const std::vector<std::uint32_t> opaque = draw(device, scene, false).instances;
        ASSERT_EQ(opaque[pixelAt(0.01f, 0.01f)], 0u);
        material.alphaMode = AlphaMode::Mask;
        const std::vector<std::uint32_t> nothing(opaque.size(), kNone);
        const auto expectEdge = [&](const char* what) {
            EXPECT_EQ(draw(device, scene, false).instances, opaque) << what << " " << material.alphaCutoff;
            material.alphaCutoff += 1.0f / 255.0f;
            EXPECT_EQ(draw(device, scene, false).instances, nothing) << what << " " << material.alphaCutoff;
        };
        for (const float alpha : {0.5f, 0.3f, 0.9f}) {
            material.alphaCutoff = material.baseColour.a = alpha;
            expectEdge("factor");
            material.baseColour.a = 1.0f;
            material.alphaCutoff = alpha;
            scene.meshes[0].primitives[0].colours.assign(4, glm::vec4(1.0f, 1.0f, 1.0f, alpha));
            expectEdge("vertices");
            scene.meshes[0].primitives[0].colours.clear();
        }
        material.baseColourTexture.image = 0;
        material.alphaCutoff = 100.0f / 255.0f;
        expectEdge("texture");
    }
    expectNoMessages();
}

// A back shows the front's normal negated: tangent, bitangent and normal together. With tangents and without.
TEST_F(SurfaceTest, NormalMapsOnBacks) {
    for (const DeviceInfo& info : suitable()) {
        SCOPED_TRACE(info.name);
        const Device device(instance(), info);
        Scene scene;
        scene.materials.resize(1);
        scene.materials[0].doubleSided = true;
        scene.materials[0].normalTexture.image = 0;
        scene.images.push_back({1, 1, {204, 166, 222, 255}});
        const glm::vec3 mapped = glm::normalize(glm::vec3(204, 166, 222) / 127.5f - 1.0f);
        scene.meshes = {squareMesh(), squareMesh()};
        for (Mesh& mesh : scene.meshes) {
            Primitive& square = mesh.primitives[0];
            square.normals.assign(4, {0, 0, 1});
            square.texcoords[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};  // u to the right, v down
        }
        scene.meshes[1].primitives[0].tangents.assign(4, {1, 0, 0, 1});
        const glm::mat4 mirror = glm::scale(glm::mat4(1.0f), {-1, 1, 1});
        const auto at = [](float x) { return glm::translate(glm::mat4(1.0f), {x, 0, 0}); };
        const glm::mat4 turns[] = {turnedAboutX(-90.0f), turnedAboutX(90.0f), turnedAboutX(-90.0f) * mirror,
                                   turnedAboutX(90.0f) * mirror};
        for (std::uint32_t mesh = 0; mesh < 2; ++mesh) {
            scene.instances.clear();
            for (int i = 0; i < 4; ++i)
                scene.instances.push_back({"square", mesh, at(static_cast<float>(2 * i - 3)) * turns[i]});
            const Drawn drawn = draw(device, scene, true);
            for (std::uint32_t i = 0; i < 4; ++i) {
                const std::uint32_t pixel = pixelAt(0.25f * (2.0f * static_cast<float>(i) - 3.0f) + 0.01f, 0.01f);
                ASSERT_EQ(drawn.instances[pixel], i);
                const glm::vec3 front = glm::mat3(turns[i]) * mapped;
                expectNear(decodeOctahedral(drawn.normals[pixel]), i % 2 == 0 ? front : -front, 3e-3f);
            }
        }
    }
    expectNoMessages();
}

}  // namespace
}  // namespace gnomon::renderer
