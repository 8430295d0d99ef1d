// What belongs to the bulk of a scene, and the outlines of many points.
#include "scene/bulk.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/outline.h"
#include "scene/pose.h"
#include "unit/scatter/cities.h"

namespace gnomon::renderer {
namespace {

struct Held {
    std::size_t leftOut;
    double reach;
};

Held held(const Scene& scene) {
    const Pose pose = restPose(scene);
    const std::vector<Thing> things = thingsOf(scene, pose, std::vector<bool>(scene.instances.size()), false);
    const Bulk bulk(things);
    return {bulk.leftOut(), bulk.reach()};
}

TEST(Bulk, HoldsWhatHasNoGap) {
    const Scene city = cities::city();
    EXPECT_EQ(held(city).leftOut, 0u);
    EXPECT_LT(held(city).reach, 800.0);
    Scene row;  // each twice as far as the one before: no gap
    for (float at = 1.0f; at < 1.0e4f; at *= 2.0f)
        cities::box(cities::add(row, "block", {}, {}), glm::vec3(at, 0, 0), glm::vec3(1.5f * at, 0.5f * at, 0.5f * at));
    EXPECT_EQ(held(row).leftOut, 0u);
}

TEST(Bulk, DoesNotDependOnTheScale) {
    const Scene scene = cities::withSky(cities::withTriangleAt(cities::city(), {1e6f, 0, 0}), {275, 0, 275}, 5000.0f);
    for (const double scale : {1.0e-5, 1.0, 1.0e5}) {
        const Held h = held(cities::scaled(scene, scale));
        EXPECT_EQ(h.leftOut, 2049u) << scale;
        EXPECT_NEAR(h.reach / scale, held(cities::city()).reach, 1.0) << scale;
    }
}

// Those of an airport would otherwise leave out the house, which is one mesh.
TEST(Bulk, AFewParkedThingsAreNoBulk) {
    Scene scene = cities::city();
    for (int i = 0; i < 40; ++i)
        cities::box(cities::add(scene, "parked", {}, {}), glm::vec3(1e5f + 3.0f * static_cast<float>(i), 0, 0),
                    glm::vec3(1e5f + 3.0f * static_cast<float>(i) + 1.0f, 1, 1));
    EXPECT_EQ(held(scene).leftOut, 40u * 12u);
}

TEST(Bulk, RoomsAreNoSkies) {
    Scene room;
    cities::box(cities::add(room, "room", {}, {}), {-2, -2, -2}, {2, 2, 2});
    EXPECT_EQ(held(cities::withSky(cities::turned(room), glm::vec3(0), 1.0f, false)).leftOut, 0u)
        << "a ball that hangs in a cube";
}

TEST(Outline, IsAsAllPointsHaveIt) {
    Random random(3);
    Outline outline;
    std::vector<glm::dvec3> points;
    for (int i = 0; i < 20'000; ++i) {
        points.emplace_back(random.between(-3, 3), random.between(-1, 2), random.between(-5, 1));
        outline.add(points.back());
    }
    EXPECT_NEAR(outline.nearestZ(), 1.0, 1e-2);
    const double z = outline.eyeZ(0.5, 0.3);
    const Span across = outline.across(z), up = outline.up(z);
    EXPECT_NEAR(std::max(across.slope / 0.5, up.slope / 0.3), 1.0, 1e-9);
    double left = 0.0, right = 0.0, top = 0.0, bottom = 0.0;
    for (const glm::dvec3& p : points) {
        const double depth = z - p.z;
        left = std::max(left, (across.centre - p.x) / depth);
        right = std::max(right, (p.x - across.centre) / depth);
        top = std::max(top, (p.y - up.centre) / depth);
        bottom = std::max(bottom, (up.centre - p.y) / depth);
    }
    for (const double slope : {left, right}) EXPECT_NEAR(slope, across.slope, 1e-9);
    for (const double slope : {top, bottom}) EXPECT_NEAR(slope, up.slope, 1e-9);
}

TEST(Outline, SinglePointsAndLines) {
    Outline outline;
    EXPECT_TRUE(outline.empty());
    EXPECT_EQ(outline.eyeZ(1.0, 1.0), 0.0);
    outline.add({2, 3, 4});
    EXPECT_EQ(outline.eyeZ(1.0, 1.0), 4.0);
    EXPECT_EQ(outline.across(5.0).slope, 0.0);
    EXPECT_EQ(outline.across(5.0).centre, 2.0);
    for (int i = 0; i < 10'000; ++i) outline.add({2, 3, 4});
    for (int i = 0; i < 10'000; ++i) outline.add({4, 3, 4});
    EXPECT_NEAR(outline.across(5.0).slope, 1.0, 1e-12);
    EXPECT_NEAR(outline.up(5.0).centre, 3.0, 1e-12);
}

}  // namespace
}  // namespace gnomon::renderer
