// The camera of scenes that have none: all of the bulk is in the picture, and it fills the picture, in every shape.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "scene/bulk.h"
#include "scene/pose.h"
#include "unit/scatter/cities.h"

namespace gnomon::renderer {
namespace {

struct Shape {
    std::uint32_t width, height;
};
constexpr Shape kShapes[] = {{1920, 1080}, {1000, 1000}, {1080, 1920}, {4000, 100}};

// Of the picture, by the vertices of the scene.
struct Seen {
    glm::dvec2 least{std::numeric_limits<double>::infinity()}, most{-std::numeric_limits<double>::infinity()};
    double nearest = std::numeric_limits<double>::infinity();
};

Seen seen(const Scene& scene, const SceneCamera& given, Shape shape) {
    const SceneCamera camera = fittedCamera(given, shape.width, shape.height);
    const double slope = std::tan(0.5 * static_cast<double>(camera.verticalFieldOfView));
    const glm::dmat4 cameraFromWorld = glm::inverse(glm::dmat4(camera.worldFromCamera));
    Seen out;
    for (const Instance& instance : scene.instances)
        for (const Primitive& p : scene.meshes[instance.mesh].primitives)
            for (const glm::vec3& v : p.positions) {
                const glm::dvec4 at = cameraFromWorld * instance.worldFromObject * glm::dvec4(glm::dvec3(v), 1.0);
                const glm::dvec2 ndc = glm::dvec2(at.x * shape.height / shape.width, at.y) / (-at.z * slope);
                out.least = glm::min(out.least, ndc);
                out.most = glm::max(out.most, ndc);
                out.nearest = std::min(out.nearest, -at.z);
            }
    return out;
}

// `framed` is what counts of the scene that the camera is of.
void expectFramed(const Scene& framed, const SceneCamera& camera) {
    for (const Shape shape : kShapes) {
        SCOPED_TRACE(std::to_string(shape.width) + "x" + std::to_string(shape.height));
        const Seen s = seen(framed, camera, shape);
        EXPECT_GT(s.nearest, static_cast<double>(camera.nearMetres));
        EXPECT_LT(s.nearest, 1000.0 * static_cast<double>(camera.nearMetres));
        EXPECT_LE(std::max({-s.least.x, -s.least.y, s.most.x, s.most.y}), 1.0);
        const glm::dvec2 filled = 0.5 * (s.most - s.least);
        EXPECT_GE(std::max(filled.x, filled.y), 0.85);
        const glm::dvec2 off = glm::abs(s.most + s.least);
        EXPECT_LT(std::max(off.x, off.y), 0.02) << "not in the middle";
    }
}

// A house with a chimney on a garden.
Scene house() {
    Scene scene;
    Primitive& walls = cities::add(scene, "walls", {}, {});
    cities::box(walls, {-4, 0, -3}, {4, 5, 3});
    cities::box(walls, {2, 5, 1}, {2.5f, 8, 1.5f});
    cities::quad(cities::add(scene, "garden", {}, {}), {{{-9, 0, 8}, {9, 0, 8}, {9, 0, -8}, {-9, 0, -8}}});
    return scene;
}

TEST(DefaultCamera, FillsPicturesOfEveryShape) {
    for (const double scale : {0.004 / 18.0, 1.0, 1.0e5 / 18.0}) {
        const Scene scene = cities::scaled(house(), scale);
        const SceneCamera camera = defaultCamera(scene);
        EXPECT_TRUE(camera.note.empty()) << camera.note;
        expectFramed(scene, camera);
    }
    expectFramed(cities::city(), defaultCamera(cities::city()));
}

TEST(DefaultCamera, FramesWhatIsFlatOrThin) {
    for (const glm::vec3& size : {glm::vec3(3, 0, 2), glm::vec3(0, 5, 1), glm::vec3(1, 1, 0),
                                  glm::vec3(40, 0.01f, 0.01f), glm::vec3(0.01f, 90, 0.02f)}) {
        Scene scene;
        cities::box(cities::add(scene, "bar", {}, {}), glm::vec3(0), size);
        expectFramed(scene, defaultCamera(scene));
    }
}

// What is far away, or around everything, changes nothing, and one sentence says that it is not in the picture.
TEST(DefaultCamera, LeavesOutWhatIsFar) {
    const Scene alone = house();
    const SceneCamera usual = defaultCamera(alone);
    Scene spiked = alone;  // one broken vertex
    spiked.meshes[0].primitives[0].positions.push_back({0, 1.0e6f, 0});
    spiked.meshes[0].primitives[0].bounds.add({0, 1.0e6f, 0});
    for (const std::uint32_t i : {0u, 1u, 48u}) spiked.meshes[0].primitives[0].indices.push_back(i);
    Scene onAPlate = alone;
    cities::quad(cities::add(onAPlate, "plate", {}, {}),
                 {{{-1e5f, -1, 1e5f}, {1e5f, -1, 1e5f}, {1e5f, -1, -1e5f}, {-1e5f, -1, -1e5f}}});
    const Scene scenes[] = {cities::withTriangleAt(alone, {1e6f, 0, 0}),
                            cities::withTriangleAt(alone, {0, -99999, 0}),
                            cities::withSky(alone, glm::vec3(0), 500.0f),
                            cities::withSky(alone, glm::vec3(0), 500.0f, false),
                            cities::withSky(alone, glm::vec3(0), 20.0f),
                            cities::withTriangleAt(cities::withSky(alone, glm::vec3(0), 3000.0f), {1e6f, 5e5f, 0}),
                            spiked,
                            onAPlate};
    for (std::size_t i = 0; i < std::size(scenes); ++i) {
        SCOPED_TRACE(i);
        const SceneCamera camera = defaultCamera(scenes[i]);
        EXPECT_LT(glm::length(camera.worldFromCamera[3] - usual.worldFromCamera[3]), 1.0e-3f);
        EXPECT_NEAR(camera.verticalFieldOfView, usual.verticalFieldOfView, 1.0e-4f);
        EXPECT_NEAR(camera.nearMetres, usual.nearMetres, 1.0e-4f * usual.nearMetres);
        expectFramed(alone, camera);
        EXPECT_EQ(std::count(camera.note.begin(), camera.note.end(), '.'), 1) << camera.note;
        EXPECT_TRUE(camera.note.ends_with('.')) << camera.note;
    }
}

// A fine bulb in a room is not all that there is, nor is a lamp in the street.
TEST(DefaultCamera, DetailsDoNotPassForTheWhole) {
    Scene room;
    Primitive& walls = cities::add(room, "room", {}, {});
    cities::box(walls, {-4, 0, -4}, {4, 3, 4});
    room = cities::turned(room);
    cities::box(cities::add(room, "table", {}, {}), {-1, 0, -1}, {1, 1, 1});
    const Scene alone = room;
    expectFramed(alone, defaultCamera(cities::withSky(room, {2, 2.5f, 1}, 0.05f, false)));
    expectFramed(cities::city(), defaultCamera(cities::withSky(cities::city(), {27, 4, 27}, 0.2f, false)));
}

TEST(DefaultCamera, LightsStandForASceneWithoutAnything) {
    Scene scene;
    SceneLight light;
    light.position = {5, 1, -2};
    scene.lights.push_back(light);
    const SceneCamera one = defaultCamera(scene);
    EXPECT_GT(one.nearMetres, 0.0f);
    EXPECT_LT(glm::length(glm::vec3(one.worldFromCamera[3]) - light.position), 10.0f);
    light.position = {-5, 2, 1};
    scene.lights.push_back(light);
    const SceneCamera two = fittedCamera(defaultCamera(scene), 100, 100);
    const glm::mat4 cameraFromWorld = glm::inverse(two.worldFromCamera);
    for (const SceneLight& l : scene.lights) {
        const glm::vec4 at = cameraFromWorld * glm::vec4(l.position, 1.0f);
        EXPECT_LT(std::max(std::abs(at.x), std::abs(at.y)), -at.z * std::tan(0.5f * two.verticalFieldOfView));
    }
    scene.lights.clear();
    EXPECT_TRUE(std::isfinite(defaultCamera(scene).worldFromCamera[3].x));
}

// A hundred metres to one side and back, in two seconds.
TEST(DefaultCamera, FramesAllOfAnAnimation) {
    Scene scene = house();
    scene.nodes.resize(1);
    for (Instance& instance : scene.instances) instance.node = 0;
    Animation animation;
    animation.durationSeconds = 2.0f;
    animation.channels.push_back({0,
                                  AnimationChannel::Path::Translation,
                                  AnimationChannel::Interpolation::Linear,
                                  {0, 1, 2},
                                  {0, 0, 0, 100, 0, 0, 0, 0, 0}});
    scene.animations.push_back(animation);
    const SceneCamera camera = defaultCamera(scene);
    Scene both = house(), right = house();
    for (Instance& instance : right.instances) {
        instance.worldFromObject[3].x = 100.0;
        both.instances.push_back(instance);
    }
    EXPECT_TRUE(camera.note.empty()) << camera.note;
    expectFramed(both, camera);
}

// Skies often turn. In no pose do they count.
TEST(DefaultCamera, LeavesOutSkiesThatTurn) {
    Scene scene = cities::withSky(house(), glm::vec3(0), 500.0f);
    scene.nodes.resize(1);
    scene.instances.back().node = 0;
    Animation animation;
    animation.durationSeconds = 4.0f;
    animation.channels.push_back({0,
                                  AnimationChannel::Path::Rotation,
                                  AnimationChannel::Interpolation::Linear,
                                  {0, 4},
                                  {0, 0, 0, 1, 0, 0.7071068f, 0, 0.7071068f}});
    scene.animations.push_back(animation);
    ASSERT_TRUE(isAnimated(scene));
    const SceneCamera camera = defaultCamera(scene);
    EXPECT_FALSE(camera.note.empty());
    expectFramed(house(), camera);
}

}  // namespace
}  // namespace gnomon::renderer
