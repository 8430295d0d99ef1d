// The shadow atlas' plan: packing, budget, hysteresis and the views' matrices.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <random>
#include <set>

#include "renderer/shadow_atlas/pack.h"
#include "renderer/shadow_atlas/plan.h"

namespace gnomon::renderer {
namespace {

std::vector<ShadowLight> randomLights(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(-40.0f, 40.0f), range(1.0f, 15.0f), angle(0.2f, 1.3f),
        unit(-1.0f, 1.0f);
    std::vector<ShadowLight> lights(count);
    for (ShadowLight& light : lights) {
        light.kind = random() % 2 == 0 ? LightKind::Point : LightKind::Spot;
        light.position = {place(random), place(random) * 0.1f, place(random)};
        light.direction = glm::normalize(glm::vec3(unit(random), unit(random) - 2.0f, unit(random)));
        light.rangeMetres = range(random);
        light.outerConeAngle = angle(random);
    }
    return lights;
}

void expectDisjointAndInside(const ShadowPlan& plan, const ShadowPlanSettings& settings) {
    const std::uint32_t cell = 32, side = settings.atlasSizePx / cell;
    std::vector<bool> taken(std::size_t{side} * side * settings.layers);
    for (const PlannedView& v : plan.views) {
        ASSERT_EQ(v.x % v.size, 0u);
        ASSERT_EQ(v.y % v.size, 0u);
        ASSERT_LE(v.x + v.size, settings.atlasSizePx);
        ASSERT_LE(v.y + v.size, settings.atlasSizePx);
        ASSERT_LT(v.layer, settings.layers);
        for (std::uint32_t y = v.y / cell; y < (v.y + v.size) / cell; ++y) {
            for (std::uint32_t x = v.x / cell; x < (v.x + v.size) / cell; ++x) {
                const std::size_t at = (std::size_t{v.layer} * side + y) * side + x;
                ASSERT_FALSE(taken[at]) << "two squares share a cell";
                taken[at] = true;
            }
        }
    }
}

TEST(ShadowPlan, SquaresNeverOverlapWhileTheCameraMoves) {
    ShadowPlanSettings settings;
    settings.atlasSizePx = 2048;
    settings.layers = 2;
    ShadowPlanner planner(settings);
    const std::vector<ShadowLight> lights = randomLights(120, 7);
    ShadowPlanCamera camera;
    for (int frame = 0; frame < 100; ++frame) {
        camera.position = {-40.0 + frame * 0.8, 1.7, 3.0};
        const ShadowPlan plan = planner.plan(lights, camera, {}, camera.position);
        EXPECT_EQ(plan.lightsWithout, 0u);
        EXPECT_LE(plan.usedTexels, plan.atlasTexels);
        expectDisjointAndInside(plan, settings);
        for (std::size_t l = 0; l < lights.size(); ++l) ASSERT_NE(plan.firstView[l], kNoShadowViews);
    }
}

TEST(ShadowPlan, KeepsPlacesWhereSizesStay) {
    ShadowPlanner planner({});
    const std::vector<ShadowLight> lights = randomLights(40, 3);
    const ShadowPlan first = planner.plan(lights, {}, {}, {});
    const ShadowPlan second = planner.plan(lights, {}, {}, {});
    ASSERT_EQ(first.views.size(), second.views.size());
    EXPECT_FALSE(second.repacked);
    for (std::size_t i = 0; i < first.views.size(); ++i) {
        EXPECT_EQ(first.views[i].x, second.views[i].x);
        EXPECT_EQ(first.views[i].y, second.views[i].y);
        EXPECT_EQ(first.views[i].size, second.views[i].size);
    }
}

// Whatever was planned before, a plan without history is the first plan of a fresh planner.
TEST(ShadowPlan, WithoutHistoryThePastDoesNotShow) {
    const std::vector<ShadowLight> lights = randomLights(40, 5);
    ShadowPlanner used({});
    bool historyShows = false;
    for (int frame = 0; frame < 20; ++frame) {
        ShadowPlanCamera camera;
        camera.position = {4.0 * frame - 40.0, 1.7, 3.0};
        const ShadowPlan kept = used.plan(lights, camera, {}, {}, true);
        const ShadowPlan now = used.plan(lights, camera, {}, {}, false);
        const ShadowPlan fresh = ShadowPlanner({}).plan(lights, camera, {}, {}, true);
        ASSERT_EQ(now.views.size(), fresh.views.size());
        for (std::size_t i = 0; i < now.views.size(); ++i) {
            EXPECT_EQ(now.views[i].size, fresh.views[i].size);
            EXPECT_EQ(now.views[i].x, fresh.views[i].x);
            EXPECT_EQ(now.views[i].y, fresh.views[i].y);
            historyShows = historyShows || kept.views[i].size != fresh.views[i].size;
        }
    }
    EXPECT_TRUE(historyShows) << "nothing here could fail";
}

TEST(ShadowPlan, ShrinksBeforeItDropsAndReportsBoth) {
    ShadowPlanSettings settings;
    settings.atlasSizePx = 256;  // 64 squares of 32
    ShadowPlanner planner(settings);
    std::vector<ShadowLight> lights(10);
    for (std::size_t l = 0; l < lights.size(); ++l) lights[l].position.x = static_cast<double>(l);
    const ShadowPlan ten = planner.plan(lights, {}, {}, {});
    EXPECT_EQ(ten.lightsWithout, 0u);
    EXPECT_EQ(ten.lightsShrunk, 10u);
    EXPECT_GT(ten.halvings, 0u);
    lights.resize(12);
    const ShadowPlan twelve = planner.plan(lights, {}, {}, {});  // 72 squares of 32 do not fit
    EXPECT_EQ(twelve.lightsWithout, 2u);
    expectDisjointAndInside(twelve, settings);
}

TEST(ShadowPlan, SixFacesCoverEveryDirectionWithTheGuardBand) {
    ShadowLight light;
    light.position = {100000.0, 2.0, -3.0};
    light.rangeMetres = 12.0f;
    const glm::dvec3 origin(99990.0, 0.0, 0.0);
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    struct Square {
        std::uint32_t sizePx, guardTexels;
    };
    constexpr Square kSquares[] = {{64, 4}, {32, 8}, {256, 36}, {1024, 68}};
    for (std::uint32_t i = 0; i < 2000; ++i) {
        const Square square = kSquares[i % 4];
        const glm::vec3 d = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
        const glm::vec3 a = glm::abs(d);
        const std::uint32_t axis = a.x >= a.y && a.x >= a.z ? 0u : a.y >= a.z ? 1u : 2u;
        const std::uint32_t face = axis * 2 + (d[static_cast<int>(axis)] < 0.0f ? 1u : 0u);
        const ShadowView view = makeShadowView(light, face, square.sizePx, square.guardTexels, origin);
        const glm::vec4 clip =
            glm::make_mat4(view.clipFromWorld) * glm::vec4(glm::vec3(light.position - origin) + d * 5.0f, 1.0f);
        const glm::vec3 ndc = glm::vec3(clip) / clip.w;
        // In texels from the middle: how far off the axis, as a share of the face without its guard texels.
        const float half = 0.5f * static_cast<float>(square.sizePx);
        const glm::vec3 across = glm::vec3(a[(axis + 1) % 3], a[(axis + 2) % 3], 0.0f) / a[static_cast<int>(axis)];
        EXPECT_NEAR(half * std::max(std::abs(ndc.x), std::abs(ndc.y)),
                    (half - static_cast<float>(square.guardTexels)) * std::max(across.x, across.y), 1e-4f * half);
        EXPECT_GT(ndc.z, 0.0f);
        EXPECT_LT(ndc.z, 1.0f);
        const float n = view.nearMetres, f = view.farMetres;
        const float expected = -n / (f - n) + n * f / (f - n) / (5.0f * a[static_cast<int>(axis)]);
        EXPECT_NEAR(ndc.z, expected, 1e-5f * n);
    }
}

TEST(ShadowPlan, OnlySixFacesGetMoreGuardTexels) {
    ShadowLight point, spot, wide;
    spot.kind = wide.kind = LightKind::Spot;
    wide.outerConeAngle = 1.4f;
    ShadowPlanSettings settings;
    EXPECT_EQ(guardTexelsOf(settings, point, 512), 4u) << "off by default";
    settings.faceGuardTexels = 16;
    EXPECT_EQ(guardTexelsOf(settings, point, 512), 20u);
    EXPECT_EQ(guardTexelsOf(settings, wide, 512), 20u);
    EXPECT_EQ(guardTexelsOf(settings, spot, 512), 4u);
    // At most an eighth of the square.
    EXPECT_EQ(guardTexelsOf(settings, point, 128), 20u);
    EXPECT_EQ(guardTexelsOf(settings, point, 64), 12u);
    settings.faceGuardTexels = ~0u;
    EXPECT_EQ(guardTexelsOf(settings, point, 32), 8u);
}

// The same squares in the same places, and other matrices of what has six faces.
TEST(ShadowPlan, WiderFacesKeepTheirSquares) {
    const std::vector<ShadowLight> lights = randomLights(40, 5);
    ShadowPlanCamera camera;
    camera.position = {3.0, 2.0, 1.0};
    ShadowPlanner planner({});
    const ShadowPlan narrow = planner.plan(lights, camera, {}, {});
    planner.setFaceGuardTexels(24);
    const ShadowPlan wide = planner.plan(lights, camera, {}, {});
    ASSERT_EQ(wide.views.size(), narrow.views.size());
    std::size_t faces = 0, cones = 0;
    for (std::size_t i = 0; i < wide.views.size(); ++i) {
        const PlannedView &a = narrow.views[i], &b = wide.views[i];
        EXPECT_TRUE(a.light == b.light && a.face == b.face && a.x == b.x && a.y == b.y && a.size == b.size);
        EXPECT_EQ(a.guardTexels, 4u);
        const bool six = shadowFaces(lights[a.light]) == 6;
        EXPECT_EQ(b.guardTexels, six ? 4u + std::min(24u, b.size / 8) : 4u);
        EXPECT_EQ(std::ranges::equal(a.view.clipFromWorld, b.view.clipFromWorld), !six);
        ++(six ? faces : cones);
        if (!six) continue;
        const ShadowView right = makeShadowView(lights[b.light], b.face, b.size, b.guardTexels, {});
        EXPECT_TRUE(std::ranges::equal(b.view.clipFromWorld, right.clipFromWorld));
    }
    EXPECT_GT(faces, 60u);
    EXPECT_GT(cones, 5u);
}

// Whatever its range is, a lamp has room in its housing, and what is far keeps the precision of floats.
TEST(ShadowPlan, NearPlanesCutNoHousing) {
    for (const float range : {0.004f, 2.0f, 60.0f, 1.0e5f}) {
        EXPECT_LE(shadowNearMetres(range), 0.0011f) << range;
        ShadowLight light;
        light.rangeMetres = range;
        const ShadowView view = makeShadowView(light, 5, 64, 4, {});
        const auto depthAt = [&](float distance) {
            const glm::vec4 clip = glm::make_mat4(view.clipFromWorld) * glm::vec4(0.0f, 0.0f, -distance, 1.0f);
            return clip.z / clip.w;
        };
        for (const float share : {1e-7f, 1e-3f, 0.1f, 0.5f, 0.99f}) {
            const float here = depthAt(share * range), farther = depthAt(share * range * 1.00001f);
            EXPECT_GT(here, farther) << range << " " << share;
            EXPECT_LT(here, 1.0f);
            EXPECT_GT(farther, 0.0f);
        }
    }
}

TEST(ShadowPlan, ASpotsConeLiesInsideItsSquare) {
    for (const float angle : {0.1f, 0.7f, 1.0f, 1.18f}) {
        ShadowLight light;
        light.kind = LightKind::Spot;
        light.outerConeAngle = angle;
        light.direction = glm::normalize(glm::vec3(0.3f, -0.8f, 0.5f));
        ASSERT_EQ(shadowFaces(light), 1u);
        const ShadowView view = makeShadowView(light, 0, 128, 4, {});
        const glm::vec3 side = glm::normalize(glm::cross(light.direction, glm::vec3(0.1f, 0.2f, 0.9f)));
        const glm::vec3 other = glm::cross(side, light.direction);
        for (int i = 0; i < 32; ++i) {
            const float turn = static_cast<float>(i) * 0.19634954f;
            const glm::vec3 rim =
                light.direction * std::cos(angle) + (side * std::cos(turn) + other * std::sin(turn)) * std::sin(angle);
            const glm::vec4 clip = glm::make_mat4(view.clipFromWorld) * glm::vec4(rim * 0.9f, 1.0f);
            EXPECT_LE(std::max(std::abs(clip.x), std::abs(clip.y)) / clip.w, 60.0f / 64.0f + 1e-4f);
        }
    }
}

// Up to a hemisphere: texels of one view would grow without end towards its border.
TEST(ShadowPlan, AWideSpotHasTheFacesOfAPointLight) {
    ShadowLight point;
    for (const float angle : {1.19f, 1.4f, 1.57079637f}) {
        ShadowLight spot;
        spot.kind = LightKind::Spot;
        spot.outerConeAngle = angle;
        ASSERT_EQ(shadowFaces(spot), 6u);
        for (std::uint32_t face = 0; face < 6; ++face) {
            const ShadowView a = makeShadowView(spot, face, 128, 4, {}), b = makeShadowView(point, face, 128, 4, {});
            EXPECT_TRUE(std::ranges::equal(a.clipFromWorld, b.clipFromWorld)) << angle << ", face " << face;
        }
        const ShadowLight lights[] = {spot, point};
        const ShadowPlan plan = ShadowPlanner({}).plan(lights, {}, {}, {});
        EXPECT_EQ(plan.views.size(), 12u);
        EXPECT_EQ(plan.firstView[1], 6u);
    }
}

TEST(MortonSpace, TakesEveryCellOnce) {
    MortonSpace space(8, 2);
    space.reserve(MortonSpace::cellOf(4, 4), 4);
    std::set<std::uint32_t> seen;
    std::uint32_t cell = 0;
    EXPECT_TRUE(space.take(8, cell));
    EXPECT_EQ(cell, 64u);
    EXPECT_FALSE(space.take(8, cell));
    while (space.take(1, cell)) EXPECT_TRUE(seen.insert(cell).second);
    EXPECT_EQ(seen.size(), 48u);
}

}  // namespace
}  // namespace gnomon::renderer
