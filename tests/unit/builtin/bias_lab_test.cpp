// What the bias lab promises: that each provocation is there, at its measure.

#include "scene/builtin/bias_lab.h"
#include "scene/builtin/builtin.h"
#include "scene/builtin/implicit_surface.h"
#include "scene/scatter/triangle_grid.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

namespace gnomon::renderer {
namespace {

class BiasLab : public testing::Test {
protected:
    static const Scene& made() {
        static const Scene once = makeBuiltinScene("bias-lab").value();
        return once;
    }
    const Scene& scene = made();

    const Primitive& primitive(const std::string& mesh, std::size_t index = 0) {
        const auto found = std::find_if(scene.meshes.begin(), scene.meshes.end(),
                                        [&](const Mesh& candidate) { return candidate.name == mesh; });
        if (found == scene.meshes.end()) throw std::runtime_error("no mesh " + mesh);
        return found->primitives.at(index);
    }
    const Material& material(const std::string& mesh) { return scene.materials[primitive(mesh).material]; }
    const SceneLight& light(const std::string& name) {
        const auto found = std::find_if(scene.lights.begin(), scene.lights.end(),
                                        [&](const SceneLight& candidate) { return candidate.name == name; });
        if (found == scene.lights.end()) throw std::runtime_error("no light " + name);
        return *found;
    }
};

// Every undirected edge has one triangle on each side, by the places of its vertices.
bool closed(const Primitive& p) {
    using Key = std::array<float, 6>;
    std::map<Key, int> sides;
    const auto key = [](const glm::vec3& a, const glm::vec3& b) { return Key{a.x, a.y, a.z, b.x, b.y, b.z}; };
    for (std::size_t i = 0; i < p.indices.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::vec3 a = p.positions[p.indices[i + k]], b = p.positions[p.indices[i + (k + 1) % 3]];
            ++sides[key(a, b)];
            --sides[key(b, a)];
        }
    }
    return std::all_of(sides.begin(), sides.end(), [](const auto& side) { return side.second == 0; });
}

TEST_F(BiasLab, IsOfModerateSizeAndLit) {
    EXPECT_GE(triangleCount(scene), 50'000u);
    EXPECT_LE(triangleCount(scene), 150'000u);
    EXPECT_GE(scene.lights.size(), 8u);
    EXPECT_LE(scene.lights.size(), 12u);
    std::map<LightKind, int> kinds;
    for (const SceneLight& l : scene.lights) {
        EXPECT_TRUE(l.casts) << l.name;
        ++kinds[l.kind];
    }
    EXPECT_EQ(kinds[LightKind::Directional], 1);
    EXPECT_GE(kinds[LightKind::Spot], 3);
    EXPECT_GE(kinds[LightKind::Point], 3);
}

// Far out, and by a number that a float holds exactly: instances and whatever hangs on them are moved by the same.
TEST_F(BiasLab, StandsFarFromTheOrigin) {
    EXPECT_GE(glm::length(lab::kOrigin), 4000.0f);
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(std::fmod(lab::kOrigin[axis], 1024.0f), 0.0f);
    for (const Instance& instance : scene.instances)
        EXPECT_EQ(instance.worldFromObject, glm::dmat4(placed(lab::kOrigin)));
    for (const SceneCamera& camera : scene.cameras)
        EXPECT_LT(glm::distance(glm::vec3(camera.worldFromCamera[3]), lab::kOrigin), 20.0f) << camera.name;
}

TEST_F(BiasLab, CamerasStandByTheStations) {
    EXPECT_EQ(scene.cameras.front().name, "overview");
    for (const char* name : {"sand", "plates", "contacts", "lace", "ears", "grazing"}) {
        SceneCamera camera;
        EXPECT_TRUE(parseCamera(name, scene, camera)) << name;
    }
}

TEST_F(BiasLab, PlatesAreAsThinAsTheySay) {
    // Upright, lying and leaning boxes; the shortest edge of every corner is a thickness.
    const Primitive& plates = primitive("plates");
    std::map<int, int> count;  // by hundredths of a millimetre
    for (std::size_t face = 0; face + 6 <= plates.indices.size(); face += 6) {
        const auto at = [&](std::size_t i) { return plates.positions[plates.indices[face + i]]; };
        const float thin = std::min(glm::distance(at(0), at(1)), glm::distance(at(1), at(2)));
        if (thin < 0.021f) ++count[static_cast<int>(std::lround(thin * 1.0e5f))];
    }
    for (const int hundredths : {100, 200, 500, 1000, 2000}) EXPECT_GE(count[hundredths], 6) << hundredths;
    EXPECT_EQ(count.size(), 5u);
}

TEST_F(BiasLab, SandHasReliefBetweenTexels) {
    const Primitive& sand = primitive("sand");
    EXPECT_GE(sand.indices.size() / 3, 20'000u);
    EXPECT_GT(sand.bounds.max.y - sand.bounds.min.y, 0.02f);
    EXPECT_LT(sand.bounds.max.y - sand.bounds.min.y, 0.15f);
    // Steps from vertex to vertex of a millimetre and more, by the thousands.
    int steps = 0;
    for (std::size_t i = 0; i < sand.indices.size(); i += 3)
        steps += std::abs(sand.positions[sand.indices[i]].y - sand.positions[sand.indices[i + 1]].y) > 0.001f ? 1 : 0;
    EXPECT_GT(steps, 5'000);
}

TEST_F(BiasLab, MaterialsProvoke) {
    for (const char* mesh : {"lace curtain", "lace cloth"}) {
        EXPECT_EQ(material(mesh).alphaMode, AlphaMode::Mask);
        EXPECT_TRUE(material(mesh).doubleSided);
        const Image& picture = scene.images[material(mesh).baseColourTexture.image];
        std::size_t open = 0;
        for (std::size_t i = 3; i < picture.rgba8.size(); i += 4) open += picture.rgba8[i] < 128 ? 1 : 0;
        const double share = static_cast<double>(open) * 4.0 / static_cast<double>(picture.rgba8.size());
        EXPECT_GT(share, 0.3);
        EXPECT_LT(share, 0.8);
    }
    for (const char* mesh : {"banner", "cards", "sheet"}) {
        EXPECT_TRUE(material(mesh).doubleSided) << mesh;
        EXPECT_FALSE(closed(primitive(mesh))) << mesh;
    }
    const Material& skin = scene.materials[primitive("bust", 1).material];
    EXPECT_TRUE(skin.subsurface && !skin.doubleSided);
    const Material& leaf = scene.materials[primitive("plant", 4).material];
    EXPECT_TRUE(leaf.subsurface && leaf.doubleSided);
}

TEST_F(BiasLab, LaceLiesCloseOverTheTable) {
    const Primitive& cloth = primitive("lace cloth");
    const float air = cloth.bounds.max.y - lab::kTable;
    EXPECT_GE(air, 0.005f);
    EXPECT_LE(air, 0.010f);
}

TEST_F(BiasLab, BodiesAreClosed) {
    for (std::size_t part : {1u, 2u, 3u}) EXPECT_TRUE(closed(primitive("bust", part))) << part;
    for (const char* mesh : {"foot", "chain"}) EXPECT_TRUE(closed(primitive(mesh))) << mesh;
}

// A ray through the middle of an ear, from behind.
TEST_F(BiasLab, EarsAreThin) {
    for (const std::size_t part : {2u, 3u}) {
        Scene ear;
        ear.materials.emplace_back();
        ear.meshes.push_back({"ear", {primitive("bust", part)}});
        ear.meshes[0].primitives[0].material = 0;
        ear.instances.emplace_back();
        const TriangleGrid grid(ear);
        // Of the rays through the ear's bounds the shortest way that is no grazing one.
        const Bounds bounds = ear.meshes[0].primitives[0].bounds;
        std::vector<float> ways;
        for (int i = 0; i < 400; ++i) {
            const float x = glm::mix(bounds.min.x, bounds.max.x, (static_cast<float>(i % 20) + 0.5f) / 20.0f);
            const float y = glm::mix(bounds.min.y, bounds.max.y, (static_cast<float>(i / 20) + 0.5f) / 20.0f);
            const auto front = grid.cast({x, y, bounds.min.z - 1.0f}, {0, 0, 1}, 3.0f);
            const auto back = grid.cast({x, y, bounds.max.z + 1.0f}, {0, 0, -1}, 3.0f);
            if (!front || !back) continue;
            const glm::vec3 normal = glm::normalize(grid.triangles()[front->triangle].areaNormal());
            ways.push_back(std::abs(normal.z) *
                           (bounds.max.z - bounds.min.z + 2.0f - front->distance - back->distance));
        }
        ASSERT_GT(ways.size(), 100u);
        std::nth_element(ways.begin(), ways.begin() + static_cast<std::ptrdiff_t>(ways.size() / 2), ways.end());
        EXPECT_GT(ways[ways.size() / 2], 0.003f);
        EXPECT_LT(ways[ways.size() / 2], 0.006f);
    }
}

TEST_F(BiasLab, LightsStandNearMiddleAndFar) {
    const glm::vec3 far = light("far spot").position - lab::kOrigin;
    EXPECT_GE(glm::length(far), 40.0f);
    EXPECT_LE(glm::length(far), 60.0f);
    EXPECT_LT(light("far spot").outerConeAngle, 0.2f);
    EXPECT_NEAR(light("wall lamp").position.z - lab::kOrigin.z - lab::kWallZ, 0.3f, 1e-3f);
    EXPECT_NEAR(light("sand lamp").position.y - lab::kSandLevel, 0.3f, 0.05f);
    const SceneLight& sun = light("sun");
    EXPECT_LT(glm::degrees(std::asin(-sun.direction.y)), 12.0f);
    EXPECT_LT(glm::degrees(std::asin(-sun.direction.z)), 5.0f);
    EXPECT_FLOAT_EQ(sun.sourceRadius, 0.00465f);
    for (const SceneLight& l : scene.lights) {
        if (l.kind == LightKind::Directional) continue;
        EXPECT_GE(l.sourceRadius, 0.005f) << l.name;
        EXPECT_LE(l.sourceRadius, 0.05f) << l.name;
    }
}

// The tops of the ramps meet the sun at 3, 1 and 0.4 degrees, and one turns away.
TEST_F(BiasLab, RampsGrazeTheSun) {
    const Primitive& ramps = primitive("ramps");
    std::vector<float> degrees;
    for (const glm::vec3& normal : ramps.normals)
        if (normal.y > 0.9f && normal.x < -0.01f)
            degrees.push_back(glm::degrees(std::asin(-glm::dot(normal, light("sun").direction))));
    ASSERT_FALSE(degrees.empty());
    for (const float wanted : {3.0f, 1.0f, 0.4f, -0.6f})
        EXPECT_TRUE(std::any_of(degrees.begin(), degrees.end(), [=](float d) { return std::abs(d - wanted) < 0.15f; }))
            << wanted;
}

TEST(ImplicitSurface, ASphereIsASphere) {
    const auto ball = [](const glm::vec3& p) { return glm::length(p) - 0.1f; };
    const Primitive mesh = surfaceOf(ball, {glm::vec3(-0.13f), glm::vec3(0.13f)}, 0.01f, 0, placed({1, 2, 3}));
    EXPECT_TRUE(closed(mesh));
    float area = 0.0f;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::vec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                        c = mesh.positions[mesh.indices[i + 2]];
        area += 0.5f * glm::length(glm::cross(b - a, c - a));
        EXPECT_GT(glm::dot(glm::cross(b - a, c - a), a - glm::vec3(1, 2, 3)), 0.0f);  // wound outwards
    }
    EXPECT_NEAR(area, 4.0f * 3.14159265f * 0.01f, 0.003f);
    for (const glm::vec3& p : mesh.positions) EXPECT_NEAR(glm::distance(p, {1, 2, 3}), 0.1f, 0.002f);
}

TEST(ImplicitSurface, UnionsAndCutsAreExactAwayFromTheirSeams) {
    EXPECT_EQ(smoothUnion(-1.0f, 2.0f, 0.5f), -1.0f);
    EXPECT_LT(smoothUnion(0.1f, 0.1f, 0.5f), 0.0f);
    EXPECT_EQ(smoothCut(-1.0f, 2.0f, 0.5f), -1.0f);
    EXPECT_EQ(smoothCut(-1.0f, -2.0f, 0.5f), 2.0f);
    EXPECT_LT(ellipsoid({0, 0, 0}, {0, 0, 0}, {1, 2, 3}), 0.0f);
    EXPECT_NEAR(ellipsoid({0, 2, 0}, {0, 0, 0}, {1, 2, 3}), 0.0f, 1e-6f);
    EXPECT_NEAR(roundCone({0, 1, 0.5f}, {0, 0, 0}, {0, 0, 1}, 0.1f, 0.3f), 0.8f, 1e-6f);
}

}  // namespace
}  // namespace gnomon::renderer
