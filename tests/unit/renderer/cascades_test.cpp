// Cascades of a directional light: they cover what the camera sees, stand still while it hardly moves, move by whole
// texels, and hold every caster between near and far.
#include "renderer/shadow_atlas/cascades.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <random>

#include "gpu_interface/numbers.h"
#include "renderer/shadow_atlas/plan.h"

namespace gnomon::renderer {
namespace {

class Random {
public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}
    double within(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
    glm::dvec3 direction() {
        std::normal_distribution<double> normal;
        return glm::normalize(glm::dvec3(normal(engine_), normal(engine_), normal(engine_)));
    }
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_() % n); }

private:
    std::mt19937 engine_;
};

struct Situation {
    CascadeSettings settings;
    CascadeCamera camera;
    CasterBounds casters;
    glm::vec3 direction{0.0f};
    std::uint32_t sizePx = 1024;
};

Situation randomSituation(Random& random, bool orthographic) {
    Situation s;
    s.settings.count = 1 + random.below(8);
    s.settings.reachMetres = static_cast<float>(std::exp(random.within(0.0, 7.0)));
    s.camera.position = random.direction() * random.within(0.0, 300.0);
    s.camera.forward = random.direction();
    s.camera.tangent = random.within(0.1, 2.0);
    if (orthographic) s.camera.halfDiagonalMetres = random.within(0.5, 40.0);
    s.casters = {random.direction() * random.within(0.0, 50.0), std::exp(random.within(0.0, 6.0))};
    s.direction = glm::vec3(random.direction());
    s.sizePx = 128u << random.below(5);
    return s;
}

Cascade cascadeOf(const Situation& s, std::uint32_t index) {
    return cascadeAround(s.settings, s.camera, s.casters, s.direction, index, s.sizePx);
}

/// A point that the camera may see at a distance along its axis.
glm::dvec3 seenPoint(Random& random, const CascadeCamera& camera, double distance) {
    const glm::dvec3 side = glm::normalize(glm::cross(camera.forward, random.direction()));
    const double most = camera.halfDiagonalMetres > 0.0 ? camera.halfDiagonalMetres : camera.tangent * distance;
    return camera.position + camera.forward * distance + side * (most * std::sqrt(random.within(0.0, 1.0)));
}

glm::dvec3 ndcOf(const ShadowView& view, const glm::dvec3& point, const glm::dvec3& origin) {
    return {glm::make_mat4(view.clipFromWorld) * glm::vec4(glm::vec3(point - origin), 1.0f)};
}

// Whatever lies in a slice is within the cascade, less the border that no receiver uses.
TEST(Cascades, CoverTheirSlices) {
    Random random(1);
    for (int trial = 0; trial < 400; ++trial) {
        const Situation s = randomSituation(random, trial % 3 == 0);
        SCOPED_TRACE(trial);
        double ends[8] = {};
        cascadeEnds(s.settings, s.camera, s.casters, ends);
        for (std::uint32_t i = 0; i < s.settings.count; ++i) {
            const ShadowView view = cascadeView(cascadeOf(s, i), s.direction, s.sizePx, s.camera.position);
            // Floats that far from the origin are the rest of the slack.
            const double usable = 1.0 - 2.0 * gpu::kCascadeMarginPx / s.sizePx + 1e-4;
            for (int p = 0; p < 40; ++p) {
                const double distance = random.within(i == 0 ? 0.0 : ends[i - 1], ends[i]);
                const glm::dvec3 ndc = ndcOf(view, seenPoint(random, s.camera, distance), s.camera.position);
                ASSERT_LE(std::abs(ndc.x), usable) << "cascade " << i << ", " << s.sizePx << " px";
                ASSERT_LE(std::abs(ndc.y), usable) << "cascade " << i << ", " << s.sizePx << " px";
            }
        }
    }
}

TEST(Cascades, EndsAscendToWhatIsThere) {
    Random random(2);
    for (int trial = 0; trial < 200; ++trial) {
        const Situation s = randomSituation(random, false);
        double ends[8] = {};
        cascadeEnds(s.settings, s.camera, s.casters, ends);
        for (std::uint32_t i = 1; i < s.settings.count; ++i) EXPECT_GT(ends[i], ends[i - 1]);
        EXPECT_GT(ends[0], 0.0);
        const double farthest = glm::length(s.casters.centre - s.camera.position) + s.casters.radius;
        const double reach = std::min<double>(s.settings.reachMetres, farthest);
        EXPECT_NEAR(ends[s.settings.count - 1], reach, 1e-6 * reach);
    }
}

// Every caster lies between near (device depth 1) and far (0).
TEST(Cascades, HoldEveryCaster) {
    Random random(3);
    for (int trial = 0; trial < 200; ++trial) {
        const Situation s = randomSituation(random, false);
        const std::uint32_t index = random.below(s.settings.count);
        const ShadowView view = cascadeView(cascadeOf(s, index), s.direction, s.sizePx, s.casters.centre);
        EXPECT_TRUE(view.orthographic);
        EXPECT_EQ(view.nearMetres, 0.0f);
        EXPECT_NEAR(view.farMetres, 2.0 * s.casters.radius, 1e-5 * s.casters.radius);
        const glm::dvec3 travel = glm::normalize(glm::dvec3(s.direction)) * s.casters.radius;
        // Toward the light and away from it, and anywhere in the sphere.
        EXPECT_NEAR(ndcOf(view, s.casters.centre - travel, s.casters.centre).z, 1.0, 1e-5);
        EXPECT_NEAR(ndcOf(view, s.casters.centre + travel, s.casters.centre).z, 0.0, 1e-5);
        for (int p = 0; p < 20; ++p) {
            const double depth =
                ndcOf(view, s.casters.centre + random.direction() * (s.casters.radius * random.within(0.0, 1.0)),
                      s.casters.centre)
                    .z;
            EXPECT_GE(depth, -1e-5);
            EXPECT_LE(depth, 1.0 + 1e-5);
        }
    }
}

// Size and depth follow from lens and distances; turning and walking leave them to the bit while the reach stays.
TEST(Cascades, SizeDoesNotDependOnWhereTheCameraLooks) {
    Random random(4);
    for (int trial = 0; trial < 100; ++trial) {
        Situation s = randomSituation(random, trial % 2 == 0);
        s.casters.radius = 1e6;  // the reach is the settings' own everywhere
        const std::uint32_t index = random.below(s.settings.count);
        const Cascade before = cascadeOf(s, index);
        for (int i = 0; i < 10; ++i) {
            s.camera.forward = random.direction();
            s.camera.position = random.direction() * random.within(0.0, 100.0);
            const Cascade after = cascadeOf(s, index);
            EXPECT_EQ(after.halfExtent, before.halfExtent);
            EXPECT_EQ(after.depth, before.depth);
        }
    }
}

bool sameMatrix(const ShadowView& a, const ShadowView& b) {
    return std::equal(std::begin(a.clipFromWorld), std::end(a.clipFromWorld), std::begin(b.clipFromWorld));
}

// A walk in small steps: the cascade either is the same to the bit, or has moved by whole steps of kCascadeStepPx texels.
TEST(Cascades, MoveInWholeSteps) {
    Random random(5);
    std::size_t kept = 0, moved = 0;
    for (int trial = 0; trial < 60; ++trial) {
        Situation s = randomSituation(random, trial % 2 == 0);
        s.casters.radius = 1e4;
        s.settings.reachMetres = 200.0f;
        const std::uint32_t index = random.below(s.settings.count);
        Cascade before = cascadeOf(s, index);
        const double texel = 2.0 * before.halfExtent / s.sizePx, step = texel * kCascadeStepPx;
        const glm::dvec3 way = random.direction() * (0.1 * step), origin(0.0);
        const glm::dvec3 travel = glm::normalize(glm::dvec3(s.direction));
        for (int i = 0; i < 40; ++i) {
            s.camera.position += way;
            const Cascade after = cascadeOf(s, index);
            const bool same = sameMatrix(cascadeView(before, s.direction, s.sizePx, origin),
                                         cascadeView(after, s.direction, s.sizePx, origin));
            if (after.centre == before.centre) {
                EXPECT_TRUE(same);
                ++kept;
            } else {
                const glm::dvec3 by = after.centre - before.centre;
                EXPECT_NEAR(glm::dot(by, travel), 0.0, 1e-6 * step);
                EXPECT_LE(glm::length(by), 1.5 * step) << "farther than the camera went";
                // In steps along the cascade's own axes: their squares add up to a whole number.
                const double squared = glm::dot(by, by) / (step * step);
                EXPECT_NEAR(squared, std::round(squared), 1e-4);
                EXPECT_GE(squared, 0.5);
                ++moved;
            }
            before = after;
        }
    }
    // A tenth of a step per frame along each of two axes: most frames keep their cascade.
    EXPECT_GT(moved, 100u);
    EXPECT_GT(kept, 4 * moved);
}

// Texels are the same places in the world wherever the camera is: what is drawn into them cannot crawl.
TEST(Cascades, TexelsStandStill) {
    Random random(6);
    for (int trial = 0; trial < 60; ++trial) {
        Situation s = randomSituation(random, false);
        s.casters.radius = 1e4;
        s.settings.reachMetres = 100.0f;
        const std::uint32_t index = random.below(s.settings.count);
        const glm::dvec3 point = random.direction() * 3.0;
        glm::dvec2 fraction(0.0);
        for (int i = 0; i < 10; ++i) {
            s.camera.position = random.direction() * random.within(0.0, 20.0);
            s.camera.forward = random.direction();
            const Cascade cascade = cascadeOf(s, index);
            // In double precision, along axes taken from the view's matrix near its own centre.
            const ShadowView view = cascadeView(cascade, s.direction, s.sizePx, cascade.centre);
            const glm::dvec3 right(view.clipFromWorld[0], view.clipFromWorld[4], view.clipFromWorld[8]);
            const glm::dvec3 down(view.clipFromWorld[1], view.clipFromWorld[5], view.clipFromWorld[9]);
            const glm::dvec3 away = point - cascade.centre;
            const glm::dvec2 px = 0.5 * s.sizePx * glm::dvec2(glm::dot(right, away), glm::dot(down, away));
            const glm::dvec2 now = px - glm::floor(px);
            if (i == 0) fraction = now;
            for (int axis = 0; axis < 2; ++axis) {
                const double apart = std::abs(now[axis] - fraction[axis]);
                EXPECT_LT(std::min(apart, 1.0 - apart), 0.02) << "texels, " << s.sizePx;
            }
        }
    }
}

// --- In the plan ---------------------------------------------------------------------------------------------------

ShadowLight sun() {
    ShadowLight light;
    light.kind = LightKind::Directional;
    light.direction = glm::normalize(glm::vec3(0.3f, -1.0f, 0.2f));
    light.rangeMetres = 1e30f;
    return light;
}

TEST(Cascades, PlannedOnePerSliceInTheLightsOrder) {
    ShadowPlanSettings settings;
    settings.cascades.count = 3;
    settings.casters = {glm::dvec3(0.0), 30.0};
    ShadowPlanner planner(settings);
    ShadowLight point;
    const std::vector<ShadowLight> lights = {point, sun(), point, sun()};
    ShadowPlanCamera camera;
    camera.cascades.position = camera.position = {0.0, 2.0, 10.0};
    const ShadowPlan plan = planner.plan(lights, camera, camera.position);
    EXPECT_EQ(plan.cascadeCount, 3u);
    ASSERT_EQ(plan.views.size(), 18u);
    for (const std::uint32_t light : {1u, 3u}) {
        ASSERT_NE(plan.firstView[light], kNoShadowViews);
        double halfExtent = 0.0;
        for (std::uint32_t c = 0; c < 3; ++c) {
            const PlannedView& view = plan.views[plan.firstView[light] + c];
            EXPECT_EQ(view.light, light);
            EXPECT_EQ(view.face, c);
            EXPECT_TRUE(view.view.orthographic);
            EXPECT_EQ(view.view.widthPx, view.size);
            EXPECT_GE(view.size, settings.minCascadePx);
            EXPECT_LE(view.size, settings.maxCascadePx);
            EXPECT_GT(view.cascade.halfExtent, halfExtent) << "farther slices are wider";
            halfExtent = view.cascade.halfExtent;
        }
    }
}

TEST(Cascades, NothingToCastNoViews) {
    ShadowPlanner planner({});
    const ShadowLight light = sun();
    EXPECT_TRUE(planner.plan({&light, 1}, {}, {}).views.empty());
    EXPECT_EQ(planner.plan({&light, 1}, {}, {}).firstView[0], kNoShadowViews);
    planner.setCasters({glm::dvec3(0.0), 5.0});
    EXPECT_EQ(planner.plan({&light, 1}, {}, {}).views.size(), 4u);
    ShadowLight still = sun();
    still.casts = false;
    EXPECT_TRUE(planner.plan({&still, 1}, {}, {}).views.empty());
}

TEST(Cascades, PlacesStayWhileTheCameraWalks) {
    ShadowPlanSettings settings;
    settings.casters = {glm::dvec3(0.0), 30.0};
    ShadowPlanner planner(settings);
    const ShadowLight light = sun();
    ShadowPlan before;
    for (int frame = 0; frame < 50; ++frame) {
        ShadowPlanCamera camera;
        camera.position = camera.cascades.position = {0.05 * frame, 2.0, 10.0};
        const ShadowPlan plan = planner.plan({&light, 1}, camera, camera.position);
        ASSERT_EQ(plan.views.size(), 4u);
        if (frame > 0)
            for (std::size_t v = 0; v < 4; ++v) {
                EXPECT_EQ(plan.views[v].x, before.views[v].x);
                EXPECT_EQ(plan.views[v].y, before.views[v].y);
                EXPECT_EQ(plan.views[v].size, before.views[v].size);
            }
        before = plan;
    }
}

}  // namespace
}  // namespace gnomon::renderer
