// Scattered lights find places in towns, rooms and heaps of any size, however their files are made, and each shines on
// something.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "scene/builtin/builtin.h"
#include "scene/load_gltf.h"
#include "scene/scatter/scatter_lights.h"
#include "scene/scatter/tile_samples.h"
#include "scene/scatter/triangle_grid.h"
#include "unit/scatter/cities.h"

namespace gnomon::renderer {
namespace {

// By rays of our own: evenly over the light's cone, from its axis outwards.
bool shinesOnAFront(const TriangleGrid& grid, const SceneLight& light) {
    constexpr int kRays = 4096;
    const bool spot = light.kind == LightKind::Spot;
    const glm::vec3 axis = spot ? light.direction : glm::vec3(0, -1, 0);
    const glm::vec3 x =
        glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1)));
    const glm::vec3 z = glm::cross(x, axis);
    const float least = spot ? std::cos(light.outerConeAngle) : -1.0f;
    for (int i = 0; i < kRays; ++i) {
        const float cosine = 1.0f - (1.0f - least) * (static_cast<float>(i) + 0.5f) / kRays;
        const float sine = std::sqrt(1.0f - cosine * cosine), turn = 2.39996323f * static_cast<float>(i);
        const glm::vec3 way = cosine * axis + sine * (std::cos(turn) * x + std::sin(turn) * z);
        const auto hit = grid.cast(light.position, way, light.rangeMetres);
        if (hit && !hit->backFace) return true;
    }
    return false;
}

// 64 of 64, each in free air. Returns the scene with its lights. Backs of faces tell a solid where they are `sound`.
Scene expectPlaces(Scene scene, const std::string& name, bool sound = true) {
    SCOPED_TRACE(name);
    scene.lights.clear();
    scene.notes.clear();
    scatterLights(scene, 64, 1);
    EXPECT_EQ(scene.lights.size(), 64u);
    EXPECT_TRUE(scene.notes.empty()) << scene.notes.front();
    const TriangleGrid grid(scene);
    for (const SceneLight& light : scene.lights) {
        EXPECT_TRUE(shinesOnAFront(grid, light)) << light.name;
        EXPECT_FALSE(grid.anythingWithin(light.position, 0.1f * light.sourceRadius)) << light.name;
        EXPECT_FALSE(sound && grid.insideSolid(light.position)) << light.name;
        EXPECT_GT(light.sourceRadius, 0.0f);
    }
    return scene;
}

// Walls that look inwards, and a table.
Scene room(float half) {
    Scene scene;
    cities::box(cities::add(scene, "room", {}, {}), {-half, 0, -half}, {half, 1.5f * half, half});
    scene = cities::turned(std::move(scene));
    cities::box(cities::add(scene, "table", {}, {}), {-0.3f * half, 0, -0.2f * half},
                {0.3f * half, 0.4f * half, 0.2f * half});
    return scene;
}

Scene triangle(const glm::vec3& b, const glm::vec3& c) {
    Scene scene;
    cities::add(scene, "triangle", {glm::vec3(0), b, c}, {0, 1, 2});
    return scene;
}

TEST(ScatterAnywhere, InTownsHoweverTheyAreWound) {
    for (const bool open : {false, true})
        for (const bool ground : {false, true}) {
            const Scene town = cities::city(open, 6.0f, ground);
            const std::string name = std::string(open ? "open " : "closed ") + (ground ? "on a ground" : "alone");
            expectPlaces(town, name);
            expectPlaces(cities::turned(town), name + ", turned");
            expectPlaces(cities::turned(town, 2), name + ", every other triangle turned", false);
            expectPlaces(cities::withDoubleSides(cities::turned(town, 2)), name + ", double-sided");
            expectPlaces(cities::tipped(town), name + ", z up");
        }
    expectPlaces(cities::city(false, 0.5f), "narrow streets");
}

// What is far away or around it does not change where a town's lights are, nor how far they reach.
TEST(ScatterAnywhere, FarThingsChangeNothing) {
    const glm::vec3 middle(275, 0, 275);
    const Scene alone = expectPlaces(cities::city(), "alone");
    Scene plate = cities::city();
    cities::quad(cities::add(plate, "plate", {}, {}),
                 {{{-1e5f, -1, 1e5f}, {1e5f, -1, 1e5f}, {1e5f, -1, -1e5f}, {-1e5f, -1, -1e5f}}});
    Scene boxed = cities::city();
    cities::box(cities::add(boxed, "sky box", {}, {}), middle - 2500.0f, middle + 2500.0f);
    const std::pair<const char*, Scene> cases[] = {
        {"parked", cities::withTriangleAt(cities::city(), {1e6f, 0, 0})},
        {"parked below", cities::withTriangleAt(cities::city(), {0, -1e6f, 0})},
        {"sky", cities::withSky(cities::city(), middle, 5000.0f)},
        {"sky, outward", cities::withSky(cities::city(), middle, 5000.0f, false)},
        {"near sky", cities::withSky(cities::city(), middle, 450.0f)},
        {"near sky, outward", cities::withSky(cities::city(), middle, 450.0f, false)},
        {"sky box, outward", boxed},
        {"sky and parked", cities::withTriangleAt(cities::withSky(cities::city(), middle, 5000.0f), {1e6f, 0, 0})},
        {"plate", plate}};
    for (const auto& [name, scene] : cases) {
        const Scene lit = expectPlaces(scene, name);
        ASSERT_EQ(lit.lights.size(), alone.lights.size()) << name;
        for (std::size_t i = 0; i < alone.lights.size(); ++i) {
            EXPECT_EQ(lit.lights[i].position, alone.lights[i].position) << name << " " << i;
            EXPECT_EQ(lit.lights[i].rangeMetres, alone.lights[i].rangeMetres) << name << " " << i;
        }
    }
}

TEST(ScatterAnywhere, AtEveryScale) {
    const Scene alone = expectPlaces(cities::city(), "1");
    for (const float scale : {1e-3f, 1e3f}) {
        const Scene lit =
            expectPlaces(cities::scaled(cities::city(), static_cast<double>(scale)), std::to_string(scale));
        ASSERT_EQ(lit.lights.size(), alone.lights.size());
        for (std::size_t i = 0; i < alone.lights.size(); ++i)
            EXPECT_LT(glm::length(lit.lights[i].position / scale - alone.lights[i].position), 0.01f) << i;
    }
}

TEST(ScatterAnywhere, InSmallAndStrangeScenes) {
    expectPlaces(room(0.002f), "a room of 4 mm");
    expectPlaces(cities::turned(room(0.002f)), "the same, turned");
    expectPlaces(triangle({0, 0, 1}, {1, 0, 0}), "a triangle that looks up");
    expectPlaces(triangle({1, 0, 0}, {0, 0, 1}), "down");
    expectPlaces(triangle({1, 0, 0}, {0, 1, 0}), "aside");
    Scene sky = cities::city();
    cities::box(cities::add(sky, "sky box", {}, {}), glm::vec3(-145, -420, -145), glm::vec3(695, 420, 695));
    expectPlaces(sky, "a sky box just around a town, outward", false);
}

// Tiles that show the sky count as any others.
TEST(ScatterAnywhere, GivesTheDensityUnderASky) {
    Scene scene = cities::withTriangleAt(cities::withSky(cities::city(), {275, 0, 275}, 5000.0f), {1e6f, 0, 0});
    const TileDensity density{3.0f, defaultCamera(scene), 640, 360};
    scatterLights(scene, 64, 1, &density);
    EXPECT_EQ(scene.lights.size(), 64u);
    EXPECT_TRUE(scene.notes.empty()) << scene.notes.front();
    EXPECT_NEAR(TileSamples(TriangleGrid(scene), density).meanShadowed(scene.lights), 3.0f, 0.15f);
}

// 200 rooms of 1 m within 10 km: no share of the whole says anything about them.
TEST(ScatterAnywhere, InAHeapOfRooms) {
    Scene heap = room(0.5f);
    const std::vector<Instance> one = heap.instances;
    heap.instances.clear();
    Random random(5);
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 at(random.between(0, 1e4f), random.between(0, 100), random.between(0, 1e4f));
        for (Instance instance : one) {
            instance.worldFromObject = glm::translate(glm::dmat4(1.0), at);
            heap.instances.push_back(instance);
        }
    }
    expectPlaces(heap, "heap");
}

// What is drawn of a town that is turned inside out is its inside.
TEST(ScatterAnywhere, TownsTurnedInsideOutAreLitInside) {
    const Scene lit = expectPlaces(cities::turned(cities::city()), "turned");
    const TriangleGrid grid(lit);
    for (const SceneLight& light : lit.lights) {
        const auto roof = grid.cast(light.position, {0, 1, 0}, 1000.0f);
        EXPECT_TRUE(roof && !roof->backFace) << light.name;
    }
}

TEST(ScatterAnywhere, InScenesThatPeopleHave) {
    const char* folder = std::getenv("GNOMON_SCENES_DIR");
    if (folder == nullptr) GTEST_SKIP() << "GNOMON_SCENES_DIR is not set";
    const char* names[] = {"draco_test/red_city.draco.glb",
                           "tps_lights/lights.glb",
                           "palm_tree/PalmTree.gltf",
                           "cesium_man/CesiumMan.glb",
                           "zdm2/zdm2.glb",
                           "intel_sponza_parts/ivy/sponza_ivy.gltf",
                           "field/02-sun-lost-in-a-wide-world/park_sun_-99999.gltf",
                           "field/02-sun-lost-in-a-wide-world/world30000.gltf",
                           "field/03-lamp-size-guessed-from-the-sky/domeQ500.gltf",
                           "field/05-squashed-to-a-plane/squash.gltf",
                           "field/08-transforms-in-float/geoecefroot.gltf",
                           "field/16-lamp-housing-near-plane/bulb.glb",
                           "field/18-metres-in-small-scenes/tiny0.001.gltf",
                           "field/19-range-that-nobody-gave/norange.glb"};
    std::size_t loaded = 0;
    for (const char* name : names) {
        Scene scene;
        if (!loadGltf(std::filesystem::path(folder) / name, scene).ok()) continue;
        expectPlaces(std::move(scene), name);
        ++loaded;
    }
    if (loaded == 0) GTEST_SKIP() << "GNOMON_SCENES_DIR has none of these scenes";
}

}  // namespace
}  // namespace gnomon::renderer
