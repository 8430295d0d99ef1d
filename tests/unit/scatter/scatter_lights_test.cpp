// Scattered lights: deterministic, in free air, as dense as promised, in scenes of any size.

#include "scene/scatter/scatter_lights.h"
#include "scene/builtin/builtin.h"
#include "scene/random.h"
#include "scene/scatter/tile_samples.h"
#include "scene/scatter/triangle_grid.h"

#include <gtest/gtest.h>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::renderer {
namespace {

Scene scattered(const char* name, std::uint32_t count, std::uint64_t seed, float scale = 1.0f) {
    Scene scene = makeBuiltinScene(name).value();
    scene.lights.clear();
    for (Instance& instance : scene.instances) {
        instance.worldFromObject = glm::scale(glm::dmat4(1.0), glm::dvec3(scale)) * instance.worldFromObject;
        instance.node = instance.skin = kNone;  // stands still where it is, so that it can be scaled
    }
    scatterLights(scene, count, seed);
    return scene;
}

TEST(ScatterLights, SameSeedSameLights) {
    const Scene a = scattered("boxes", 50, 3), b = scattered("boxes", 50, 3), c = scattered("boxes", 50, 4);
    ASSERT_EQ(a.lights.size(), 50u);
    ASSERT_EQ(b.lights.size(), 50u);
    bool differs = false;
    for (std::size_t i = 0; i < 50; ++i) {
        EXPECT_EQ(a.lights[i].position, b.lights[i].position);
        EXPECT_EQ(a.lights[i].intensity, b.lights[i].intensity);
        EXPECT_EQ(a.lights[i].kind, b.lights[i].kind);
        differs = differs || a.lights[i].position != c.lights[i].position;
    }
    EXPECT_TRUE(differs);
}

TEST(ScatterLights, KeepsTheLightsThatWereThere) {
    Scene scene = makeBuiltinScene("boxes").value();
    const std::size_t before = scene.lights.size();
    scatterLights(scene, 10, 1);
    EXPECT_EQ(scene.lights.size(), before + 10);
    scatterLights(scene, 0, 1);
    EXPECT_EQ(scene.lights.size(), before + 10);
}

TEST(ScatterLights, StandsInFreeAirInsideTheBounds) {
    for (const char* name : {"courtyard", "boxes", "columns"}) {
        const Scene scene = scattered(name, 300, 5);
        const TriangleGrid grid(scene);
        ASSERT_EQ(scene.lights.size(), 300u) << name;
        for (const SceneLight& light : scene.lights) {
            EXPECT_TRUE(glm::all(glm::greaterThanEqual(light.position, grid.bounds().min)) &&
                        glm::all(glm::lessThanEqual(light.position, grid.bounds().max)))
                << name;
            EXPECT_FALSE(grid.insideSolid(light.position)) << name;
            EXPECT_FALSE(grid.anythingWithin(light.position, 0.0019f * grid.bounds().radius())) << name;
        }
    }
}

TEST(ScatterLights, IsAsDenseAsPromisedAtEveryScaleAndCount) {
    for (const float scale : {0.05f, 1.0f, 5000.0f}) {
        for (const std::uint32_t count : {64u, 512u}) {
            const Scene scene = scattered("courtyard", count, 9, scale);
            const TriangleGrid grid(scene);
            Random random(99);
            double inRange = 0.0;
            constexpr int kPoints = 400;
            for (int i = 0; i < kPoints; ++i) {  // on the court's floor and whatever stands there
                const glm::vec3 above(scale * random.between(-12, 12), scale * 6.0f, scale * random.between(-8, 8));
                const auto hit = grid.cast(above, {0, -1, 0}, 10.0f * scale);
                ASSERT_TRUE(hit);
                const glm::vec3 p = above - glm::vec3(0, hit->distance, 0);
                for (const SceneLight& light : scene.lights) {
                    const glm::vec3 to = p - light.position;
                    const bool near = glm::length(to) < light.rangeMetres;
                    const bool lit = light.kind == LightKind::Point ||
                                     glm::dot(glm::normalize(to), light.direction) > std::cos(light.outerConeAngle);
                    inRange += near && lit ? 1.0 : 0.0;
                }
            }
            EXPECT_GT(inRange / kPoints, 1.5) << scale << " " << count;
            EXPECT_LT(inRange / kPoints, 12.0) << scale << " " << count;
        }
    }
}

TEST(ScatterLights, MixesKindsAndStaysInItsNumbers) {
    const Scene scene = scattered("columns", 1000, 1);
    int spots = 0;
    for (const SceneLight& light : scene.lights) {
        EXPECT_TRUE(light.casts);
        EXPECT_GT(light.rangeMetres, 0.0f);
        EXPECT_GT(light.intensity, 0.0f);
        EXPECT_GT(light.sourceRadius, 0.0f);
        EXPECT_LT(light.sourceRadius, light.rangeMetres);
        if (light.kind != LightKind::Spot) continue;
        ++spots;
        EXPECT_LT(light.direction.y, 0.0f);
        EXPECT_GE(light.outerConeAngle, 0.34f);
        EXPECT_LE(light.outerConeAngle, 1.05f);
    }
    EXPECT_NEAR(spots, 400, 60);
}

TEST(ScatterLights, FillsABoxWhereThereIsNoGeometry) {
    const Scene scene = scattered("lights-only", 20, 1);
    ASSERT_EQ(scene.lights.size(), 20u);
    EXPECT_EQ(scene.notes.size(), 1u);
    for (const SceneLight& light : scene.lights) {
        EXPECT_LE(std::abs(light.position.x), 1.0f);
        EXPECT_TRUE(std::isfinite(light.rangeMetres) && light.rangeMetres > 0.0f);
    }
}

TEST(ScatterLights, OneTriangleIsEnough) {
    const Scene scene = scattered("single-triangle", 8, 1);
    for (const SceneLight& light : scene.lights) EXPECT_TRUE(std::isfinite(light.intensity));
    EXPECT_TRUE(scene.lights.size() == 8 || !scene.notes.empty());
}

TEST(ScatterLights, AFlatPlaneGetsItsLightsAbove) {
    const Scene scene = scattered("empty-plane", 100, 1);
    ASSERT_EQ(scene.lights.size(), 100u);
    for (const SceneLight& light : scene.lights) EXPECT_GT(light.position.y, 0.0f);
}

// The picture's tiles decide: 64 lights and 512 give what was asked for, and the scene's own lamps are gone.
TEST(ScatterLights, GivesTheDensityPerTileAtEveryCount) {
    for (const char* name : {"courtyard", "columns"}) {
        for (const std::uint32_t count : {64u, 512u}) {
            Scene scene = makeBuiltinScene(name).value();
            const TileDensity density{3.0f, scene.cameras.front(), 640, 360};
            scatterLights(scene, count, 1, &density);
            std::size_t local = 0;
            for (const SceneLight& light : scene.lights) local += light.kind != LightKind::Directional ? 1 : 0;
            EXPECT_EQ(local, count) << name;
            const TriangleGrid grid(scene);
            EXPECT_NEAR(TileSamples(grid, density).meanShadowed(scene.lights), 3.0f, 0.15f) << name << " " << count;
            EXPECT_TRUE(scene.notes.empty()) << scene.notes.front();
        }
    }
}

TEST(ScatterLights, SaysWhenNoRangeGivesTheDensity) {
    Scene scene = makeBuiltinScene("boxes").value();
    const TileDensity density{20.0f, scene.cameras.front(), 640, 360};
    scatterLights(scene, 4, 1, &density);
    EXPECT_EQ(scene.notes.size(), 1u);
}

}  // namespace
}  // namespace gnomon::renderer
