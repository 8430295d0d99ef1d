// Every built-in scene: the same each time, sound geometry, lights in free air, sizes within their limits.

#include "scene/builtin/builtin.h"
#include "scene/bulk.h"
#include "scene/scatter/scatter_lights.h"
#include "scene/scatter/tile_samples.h"
#include "scene/scatter/triangle_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace gnomon::renderer {
namespace {

bool finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool same(const Scene& a, const Scene& b) {
    if (a.meshes.size() != b.meshes.size() || a.instances.size() != b.instances.size() ||
        a.lights.size() != b.lights.size() || a.images.size() != b.images.size())
        return false;
    for (std::size_t i = 0; i < a.meshes.size(); ++i)
        for (std::size_t k = 0; k < a.meshes[i].primitives.size(); ++k)
            if (a.meshes[i].primitives[k].positions != b.meshes[i].primitives[k].positions ||
                a.meshes[i].primitives[k].indices != b.meshes[i].primitives[k].indices)
                return false;
    for (std::size_t i = 0; i < a.instances.size(); ++i)
        if (a.instances[i].worldFromObject != b.instances[i].worldFromObject) return false;
    for (std::size_t i = 0; i < a.lights.size(); ++i)
        if (a.lights[i].position != b.lights[i].position || a.lights[i].colour != b.lights[i].colour) return false;
    for (std::size_t i = 0; i < a.images.size(); ++i)
        if (a.images[i].rgba8 != b.images[i].rgba8) return false;
    return true;
}

std::size_t triangles(const Scene& scene) {
    std::size_t count = 0;
    for (const Instance& instance : scene.instances)
        for (const Primitive& p : scene.meshes[instance.mesh].primitives) count += p.indices.size() / 3;
    return count;
}

/// Made once: the large ones take seconds.
const Scene& sceneOf(const std::string& name) {
    static std::map<std::string, Scene> made;
    const auto found = made.find(name);
    return found != made.end() ? found->second : made.emplace(name, makeBuiltinScene(name).value()).first->second;
}

class BuiltinScene : public testing::TestWithParam<std::string> {
protected:
    const Scene& scene = sceneOf(GetParam());
};

TEST_P(BuiltinScene, IsTheSameEachTime) {
    EXPECT_TRUE(same(scene, makeBuiltinScene(GetParam()).value()));
}

TEST_P(BuiltinScene, HasNameMaterialCameraAndExposure) {
    EXPECT_EQ(scene.name, GetParam());
    EXPECT_FALSE(scene.materials.empty());
    EXPECT_FALSE(scene.cameras.empty());
    EXPECT_TRUE(scene.exposureEv100.has_value());
}

// So whatever goes by the bulk of a scene goes by all of it: where lights are scattered, for one.
TEST_P(BuiltinScene, HasNothingFarAway) {
    const Pose pose = restPose(scene);
    const std::vector<Thing> things = thingsOf(scene, pose, std::vector<bool>(scene.instances.size()), false);
    EXPECT_EQ(Bulk(things).leftOut(), 0u);
}

TEST_P(BuiltinScene, IndicesAreValid) {
    for (const Instance& instance : scene.instances) ASSERT_LT(instance.mesh, scene.meshes.size());
    for (const Material& m : scene.materials)
        for (const TextureUse* use :
             {&m.baseColourTexture, &m.normalTexture, &m.metallicRoughnessTexture, &m.emissiveTexture})
            ASSERT_TRUE(use->image == kNone || use->image < scene.images.size()) << m.name;
    for (const Image& image : scene.images) ASSERT_EQ(image.rgba8.size(), std::size_t(image.width) * image.height * 4);
    for (const Mesh& mesh : scene.meshes) {
        ASSERT_FALSE(mesh.primitives.empty()) << mesh.name;
        for (const Primitive& p : mesh.primitives) {
            ASSERT_LT(p.material, scene.materials.size());
            ASSERT_FALSE(p.indices.empty()) << mesh.name;
            ASSERT_EQ(p.indices.size() % 3, 0u);
            ASSERT_EQ(p.normals.size(), p.positions.size());
            ASSERT_EQ(p.texcoords[0].size(), p.positions.size());
            Bounds bounds;
            for (const std::uint32_t index : p.indices) {
                ASSERT_LT(index, p.positions.size());
                bounds.add(p.positions[index]);
            }
            ASSERT_EQ(bounds.min, p.bounds.min) << mesh.name;
            ASSERT_EQ(bounds.max, p.bounds.max) << mesh.name;
        }
    }
}

TEST_P(BuiltinScene, NormalsAreUnitAndOnTheFrontOfEveryTriangle) {
    for (const Mesh& mesh : scene.meshes) {
        for (const Primitive& p : mesh.primitives) {
            for (const glm::vec3& position : p.positions) ASSERT_TRUE(finite(position)) << mesh.name;
            for (const glm::vec3& normal : p.normals) ASSERT_NEAR(glm::length(normal), 1.0f, 1e-4f) << mesh.name;
            for (const glm::vec2& uv : p.texcoords[0])
                ASSERT_TRUE(std::isfinite(uv.x) && std::isfinite(uv.y)) << mesh.name;
            for (std::size_t i = 0; i < p.indices.size(); i += 3) {
                const glm::vec3 a = p.positions[p.indices[i]], b = p.positions[p.indices[i + 1]],
                                c = p.positions[p.indices[i + 2]];
                const glm::vec3 face = glm::cross(b - a, c - a);
                ASSERT_GT(glm::length(face), 1e-9f) << mesh.name << " has a triangle without area";
                for (int k = 0; k < 3; ++k)
                    ASSERT_GT(glm::dot(glm::normalize(face), p.normals[p.indices[i + std::size_t(k)]]), 0.2f)
                        << mesh.name;
            }
        }
    }
}

TEST_P(BuiltinScene, LightsAreCompleteAndInFreeAir) {
    const TriangleGrid grid(scene);
    for (const SceneLight& light : scene.lights) {
        ASSERT_TRUE(finite(light.position) && finite(light.colour));
        EXPECT_NEAR(glm::length(light.direction), 1.0f, 1e-4f) << light.name;
        EXPECT_GT(light.intensity, 0.0f);
        if (light.kind == LightKind::Directional) continue;
        EXPECT_GT(light.rangeMetres, 0.0f) << light.name;
        EXPECT_GT(light.sourceRadius, 0.0f) << light.name;
        EXPECT_TRUE(light.casts) << light.name;
        EXPECT_LE(light.innerConeAngle, light.outerConeAngle);
        EXPECT_FALSE(grid.anythingWithin(light.position, 0.01f)) << light.name;
        EXPECT_FALSE(grid.anythingWithin(light.position, light.sourceRadius))
            << light.name << ": geometry inside the source";
        EXPECT_FALSE(grid.insideSolid(light.position)) << light.name;
    }
}

std::vector<std::string> names() {
    std::vector<std::string> all;
    for (const BuiltinInfo& info : builtinScenes()) all.push_back(info.name);
    return all;
}

INSTANTIATE_TEST_SUITE_P(All, BuiltinScene, testing::ValuesIn(names()), [](const auto& param) {
    std::string name = param.param;
    for (char& c : name) c = c == '-' ? '_' : c;
    return name;
});

TEST(BuiltinScenes, UnknownNameIsEmpty) {
    EXPECT_FALSE(makeBuiltinScene("no such scene"));
}

TEST(BuiltinScenes, EveryoneHasADescriptionOfOneLine) {
    for (const BuiltinInfo& info : builtinScenes()) {
        EXPECT_FALSE(info.description.empty());
        EXPECT_EQ(info.description.find('\n'), std::string::npos);
    }
}

bool isCourtyard(const std::string& name) {
    return name.rfind("courtyard", 0) == 0;
}

TEST(BuiltinScenes, CourtyardKeepsItsSize) {
    for (const std::string& name : names()) {
        if (!isCourtyard(name)) continue;
        const Scene& scene = sceneOf(name);
        EXPECT_GE(triangles(scene), 200'000u);
        EXPECT_LE(triangles(scene), 400'000u);
        int points = 0, spots = 0, directional = 0;
        for (const SceneLight& light : scene.lights) {
            EXPECT_TRUE(light.casts) << light.name;
            ++(light.kind == LightKind::Point ? points : light.kind == LightKind::Spot ? spots : directional);
        }
        EXPECT_GE(points, 24) << name;
        EXPECT_GE(spots, 24) << name;
        EXPECT_GE(points + spots, 60) << name;
        EXPECT_EQ(directional, 1) << name;
        EXPECT_EQ(scene.cameras.front().name, "overview");
        EXPECT_GE(scene.cameras.size(), 3u);
    }
}

// What the bench's name promises; the library itself counts 3.02 there.
TEST(BuiltinScenes, TheBenchHasThreeShadowedLightsPerTile) {
    const Scene& scene = sceneOf("courtyard-bench");
    const TileDensity picture{3.0f, scene.cameras.front(), 3840, 2160};
    EXPECT_NEAR(TileSamples(TriangleGrid(scene), picture).meanShadowed(scene.lights), 3.0f, 0.2f);
}

TEST(BuiltinScenes, SmallScenesAreSmall) {
    for (const std::string& name : names()) {
        if (isCourtyard(name) || name == "bias-lab") continue;
        EXPECT_LE(triangles(sceneOf(name)), 15'000u) << name;
    }
}

TEST(BuiltinScenes, ColumnsFollowSeedAndLightCount) {
    BuiltinOptions options;
    options.lightCount = 100;
    const Scene first = makeBuiltinScene("columns", options).value();
    EXPECT_EQ(first.lights.size(), 100u);
    EXPECT_TRUE(same(first, makeBuiltinScene("columns", options).value()));
    options.seed = 2;
    EXPECT_FALSE(same(first, makeBuiltinScene("columns", options).value()));
}

// From cameras and lights no ray may meet the inside of a single-sided surface: nothing is open, nothing inside out.
TEST(BuiltinScenes, NoSurfaceIsSeenFromBehind) {
    for (const std::string& name : names()) {
        const Scene& scene = sceneOf(name);
        const TriangleGrid grid(scene);
        std::vector<glm::vec3> eyes;
        for (const SceneCamera& camera : scene.cameras) eyes.emplace_back(camera.worldFromCamera[3]);
        for (const SceneLight& light : scene.lights)
            if (light.kind != LightKind::Directional) eyes.push_back(light.position);
        int behind = 0, hits = 0;
        for (const glm::vec3& eye : eyes) {
            for (int i = 0; i < 2000; ++i) {  // a spiral over the sphere
                const float y = 1.0f - (static_cast<float>(i) + 0.5f) / 1000.0f,
                            turn = 2.39996323f * static_cast<float>(i);
                const float r = std::sqrt(1.0f - y * y);
                const auto hit = grid.cast(eye, {r * std::cos(turn), y, r * std::sin(turn)}, 1000.0f);
                hits += hit ? 1 : 0;
                behind += hit && hit->backFace ? 1 : 0;
            }
        }
        // Rays that slip between two triangles of one edge are rounding, not holes.
        EXPECT_LE(behind, hits / 5000) << name << ": " << behind << " of " << hits;
    }
}

}  // namespace
}  // namespace gnomon::renderer
