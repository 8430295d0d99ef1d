// Cascades of a directional light: they cover what the camera sees, stand still while it hardly moves, move by whole
// texels, and hold whatever casts upon what is seen between near and far.
#include "renderer/shadow_atlas/cascades.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <random>
#include <vector>

#include "gpu_interface/numbers.h"
#include "renderer/shadow_atlas/part_extent.h"
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
    std::vector<ScenePart> parts;
    glm::vec3 direction{0.0f};
    std::uint32_t sizePx = 1024;
    [[nodiscard]] SeenRange seen() const { return seenRangeOf(camera, {}, parts, direction); }
};

ScenePart box(const glm::dvec3& centre, const glm::dvec3& half, bool seen) {
    return {centre, glm::length(half), seen, glm::dmat3(half.x, 0, 0, 0, half.y, 0, 0, 0, half.z)};
}

ScenePart randomPart(Random& random, const glm::dvec3& centre, double size, bool seen) {
    ScenePart part = {centre, 0.0, seen};
    for (int i = 0; i < 3; ++i) {
        part.halfAxes[i] = random.direction() * (size * random.within(0.1, 1.0));
        part.radius += glm::length(part.halfAxes[i]);
    }
    return part;
}

glm::dvec3 pointOf(Random& random, const ScenePart& part) {
    return part.centre +
           part.halfAxes * glm::dvec3(random.within(-1.0, 1.0), random.within(-1.0, 1.0), random.within(-1.0, 1.0));
}

// Of any scale, from millimetres to kilometres.
Situation randomSituation(Random& random, bool orthographic) {
    Situation s;
    s.settings.count = 1 + random.below(8);
    const double unit = std::exp(random.within(-7.0, 7.0));
    s.camera.position = random.direction() * (unit * random.within(0.0, 5.0));
    s.camera.forward = random.direction();
    s.camera.tangent = random.within(0.001, 2.0);
    if (orthographic) s.camera.halfDiagonalMetres = unit * random.within(0.5, 4.0);
    for (std::uint32_t p = 2 + random.below(20); p > 0; --p)
        s.parts.push_back(randomPart(random, s.camera.position + random.direction() * (unit * random.within(0.0, 20.0)),
                                     unit * std::exp(random.within(-4.0, 1.0)), random.below(2) == 0));
    s.parts.front().centre = s.camera.position + s.camera.forward * (unit * random.within(1.0, 20.0));
    s.parts.front().seen = true;
    s.direction = glm::vec3(random.direction());
    s.sizePx = 128u << random.below(5);
    return s;
}

// The whole world is one part that lies along the light, so that depths do not depend on the camera's place.
void fillWithOnePart(Situation& s) {
    const glm::dvec3 travel = glm::normalize(glm::dvec3(s.direction));
    const glm::dvec3 across = glm::normalize(glm::cross(travel, glm::dvec3(travel.z, travel.x, travel.y + 2.0)));
    s.parts = {box(glm::dvec3(0.0), glm::dvec3(1e4), true)};
    s.parts[0].halfAxes = glm::dmat3(travel, across, glm::cross(travel, across)) * 1e4;
}

Cascade cascadeOf(const Situation& s, std::uint32_t index, const SeenRange& seen) {
    return cascadeAround(s.settings, s.camera, seen, s.parts, s.direction, index, s.sizePx);
}
Cascade cascadeOf(const Situation& s, std::uint32_t index) {
    return cascadeOf(s, index, s.seen());
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
        const SeenRange seen = s.seen();
        cascadeEnds(s.settings, s.camera, seen, ends);
        for (std::uint32_t i = 0; i < s.settings.count; ++i) {
            const ShadowView view = cascadeView(cascadeOf(s, i), s.direction, s.sizePx, s.camera.position);
            // Floats that far from the origin are the rest of the slack.
            const double held = 1.0 - 2.0 * gpu::kCascadeMarginPx / s.sizePx;
            const bool last = i + 1 == s.settings.count;  // its border gives way to light
            const double usable = (last ? held * (1.0 - 1.0 / gpu::kCascadeBlendedPart) : held) + 1e-4;
            for (int p = 0; p < 40; ++p) {
                const double distance = random.within(i == 0 ? seen.nearest : ends[i - 1], ends[i]);
                const glm::dvec3 ndc = ndcOf(view, seenPoint(random, s.camera, distance), s.camera.position);
                ASSERT_LE(std::abs(ndc.x), usable) << "cascade " << i << ", " << s.sizePx << " px";
                ASSERT_LE(std::abs(ndc.y), usable) << "cascade " << i << ", " << s.sizePx << " px";
            }
        }
    }
}

TEST(Cascades, EndsAscendToTheFarthestThatIsSeen) {
    Random random(2);
    for (int trial = 0; trial < 200; ++trial) {
        Situation s = randomSituation(random, false);
        const SeenRange seen = s.seen();
        double ends[8] = {};
        cascadeEnds(s.settings, s.camera, seen, ends);
        for (std::uint32_t i = 1; i < s.settings.count; ++i) EXPECT_GT(ends[i], ends[i - 1]);
        EXPECT_GT(ends[0], seen.nearest);
        EXPECT_NEAR(ends[s.settings.count - 1], seen.farthest, 1e-6 * seen.farthest);
        double nearest = 1e30, farthest = 0.0;
        for (const ScenePart& part : s.parts) {
            if (!part.seen) continue;
            const double along = glm::dot(part.centre - s.camera.position, s.camera.forward);
            const glm::dvec3 reaches = glm::abs(s.camera.forward * part.halfAxes);
            const double reach = reaches.x + reaches.y + reaches.z;
            if (along + reach <= 0.0) continue;  // behind the camera
            nearest = std::min(nearest, along - reach);
            farthest = std::max(farthest, along + reach);
        }
        EXPECT_GE(seen.farthest, farthest);
        EXPECT_LE(seen.farthest, 1.2 * farthest);
        EXPECT_LE(seen.nearest, std::max(nearest, 0.0));
        const bool around = std::any_of(s.parts.begin(), s.parts.end(),
                                        [&](const ScenePart& part) { return holds(part, s.camera.position); });
        if (!around) {
            EXPECT_GE(seen.nearest, nearest / 1.2);
        }
        // What is not seen does not count.
        s.parts.push_back(box(random.direction() * 1e6, glm::dvec3(1e3), false));
        EXPECT_EQ(s.seen().nearest, seen.nearest);
        EXPECT_EQ(s.seen().farthest, seen.farthest);
    }
}

// Between near (device depth 1) and far (0) lies all that is seen within the square. Nothing that may cast upon it lies
// before near.
TEST(Cascades, HoldWhatIsSeenAndWhatCastsUponIt) {
    Random random(3);
    std::size_t tried = 0;
    for (int trial = 0; trial < 400; ++trial) {
        const Situation s = randomSituation(random, trial % 3 == 0);
        const std::uint32_t index = random.below(s.settings.count);
        const Cascade cascade = cascadeOf(s, index);
        const ShadowView view = cascadeView(cascade, s.direction, s.sizePx, cascade.centre);
        EXPECT_TRUE(view.orthographic);
        EXPECT_EQ(view.nearMetres, 0.0f);
        EXPECT_EQ(view.farMetres, static_cast<float>(cascade.depth));
        for (const ScenePart& part : s.parts) {
            for (int p = 0; p < 50; ++p) {
                const glm::dvec3 ndc = ndcOf(view, pointOf(random, part), cascade.centre);
                if (std::max(std::abs(ndc.x), std::abs(ndc.y)) > 1.0) continue;
                ++tried;
                if (part.seen) {
                    ASSERT_GE(ndc.z, -1e-4) << trial;
                    ASSERT_LE(ndc.z, 1.0 + 1e-4) << trial;
                } else if (ndc.z > 0.0) {
                    ASSERT_LE(ndc.z, 1.0 + 1e-4) << trial;
                }
            }
        }
    }
    EXPECT_GT(tried, 10'000u);
}

// An object parked far away, beside the light's way or behind what is seen, changes nothing.
TEST(Cascades, WhatIsParkedFarAwayChangesNothing) {
    Random random(7);
    for (int trial = 0; trial < 200; ++trial) {
        Situation s = randomSituation(random, false);
        const std::uint32_t index = random.below(s.settings.count);
        const Cascade before = cascadeOf(s, index);
        const glm::dvec3 travel = glm::normalize(glm::dvec3(s.direction));
        const glm::dvec3 aside = glm::normalize(glm::cross(travel, random.direction()));
        s.parts.push_back(box(before.centre + travel * 1e6, glm::dvec3(1.0), false));
        s.parts.push_back(box(before.centre + aside * 1e6 - travel * 3e5, glm::dvec3(1.0), false));
        const Cascade after = cascadeOf(s, index);
        EXPECT_EQ(after.centre, before.centre);
        EXPECT_EQ(after.halfExtent, before.halfExtent);
        EXPECT_EQ(after.depth, before.depth);
    }
}

// --- A plane to the horizon ------------------------------------------------------------------------------------------

// From 2 m above a plane of 60 km, with a wall of 4 m on it 20 m away.
struct Plain {
    CascadeCamera camera{{0.0, 2.0, 0.0}, {0.0, 0.0, -1.0}, 0.7, 0.0};
    std::vector<ScenePart> parts = {box({0, 0, 0}, {3e4, 0, 3e4}, true), box({0, 2, -20}, {2, 2, 0.1}, true)};
    glm::vec3 direction = glm::normalize(glm::vec3(1.0f, -1.0f, 0.0f));
    [[nodiscard]] SeenRange seen() const { return seenRangeOf(camera, {}, parts, direction); }
};

TEST(Cascades, APlaneCountsWhereSomethingCastsUponIt) {
    Plain plain;
    const SeenRange seen = plain.seen();
    EXPECT_GT(seen.farthest, 20.1);
    EXPECT_LT(seen.farthest, 30.0);
    EXPECT_GT(seen.nearest, 15.0);
    // Below the plane, and seen by nobody: on the plane itself, it casts.
    plain.parts.push_back(box({0, -1e5, 0}, {1, 1, 1}, false));
    EXPECT_EQ(plain.seen().farthest, seen.farthest);
    plain.parts.push_back(box({0, 1, -500}, {1, 1, 1}, false));
    EXPECT_GT(plain.seen().farthest, 500.0);
    EXPECT_LT(plain.seen().farthest, 650.0);
    // A tower out of sight, whose shadow falls into it.
    plain.parts.push_back(box({-5e3, 5e3, -5e3}, {1, 1, 1}, false));
    EXPECT_GT(plain.seen().farthest, 5e3);
    // Grazing light: everything may be in shadow.
    plain.direction = glm::normalize(glm::vec3(1.0f, -0.001f, 0.0f));
    EXPECT_GT(plain.seen().farthest, 2.9e4);
}

// Parked in view, 300 km away: less than a pixel. Many of them are a town on the horizon.
TEST(Cascades, ASpeckInViewIsNotReached) {
    for (const double halfDiagonalMetres : {0.0, 3000.0}) {
        Plain plain;
        plain.camera.halfDiagonalMetres = halfDiagonalMetres;
        plain.parts.erase(plain.parts.begin());
        const SeenRange before = plain.seen();
        plain.parts.push_back(box({1, 1, -3e5}, {0.25, 0.5, 0.25}, true));
        EXPECT_EQ(plain.seen().farthest, before.farthest);
        EXPECT_EQ(plain.seen().nearest, before.nearest);
        for (int i = 0; i < 40; ++i) plain.parts.push_back(box({100.0 * i, 20, -3e5}, {50, 20, 50}, true));
        EXPECT_GT(plain.seen().farthest, 2.9e5);
    }
}

TEST(Cascades, AnEmptyPlaneNeedsNone) {
    Plain plain;
    plain.parts.resize(1);
    EXPECT_EQ(plain.seen().farthest, 0.0);
    plain.parts.push_back(box({100, 0, 0}, {10, 0, 10}, true));  // in the same plane
    EXPECT_EQ(plain.seen().farthest, 0.0);
}

// A leaf right before the camera is held, but the slices are split as without it.
TEST(Cascades, OneSmallThingNearbyDoesNotTakeTheTexels) {
    Plain plain;
    for (int i = 0; i < 8; ++i) plain.parts.push_back(box({4.0 * i - 14.0, 2, -12}, {2, 2, 2}, true));
    const SeenRange before = plain.seen();
    plain.parts.push_back(box({0, 2, -0.1}, {0.005, 0.005, 0.005}, true));
    const SeenRange after = plain.seen();
    EXPECT_LT(after.nearest, 0.1);
    EXPECT_EQ(after.most, before.most);
    EXPECT_EQ(after.farthest, before.farthest);
}

TEST(PartExtent, IsThatOfWhatThePlanesLeave) {
    Random random(9);
    std::size_t cut = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const ScenePart part = randomPart(random, random.direction() * 3.0, 2.0, true);
        std::vector<Plane> planes;
        for (std::uint32_t p = random.below(4); p > 0; --p)
            planes.push_back({random.direction(), random.within(0.5, 3.0)});
        const glm::dvec3 axis = random.direction();
        const std::optional<Extent> extent = extentWithin(part, planes, axis);
        double low = 1e30, high = -1e30;
        std::size_t inside = 0;
        for (int p = 0; p < 20'000; ++p) {
            const glm::dvec3 point = pointOf(random, part);
            if (std::any_of(planes.begin(), planes.end(),
                            [&](const Plane& plane) { return glm::dot(plane.normal, point) + plane.offset < 0.0; }))
                continue;
            ++inside;
            low = std::min(low, glm::dot(point, axis));
            high = std::max(high, glm::dot(point, axis));
        }
        cut += inside < 20'000 ? 1 : 0;
        if (inside == 0) continue;
        ASSERT_TRUE(extent.has_value()) << trial;
        EXPECT_LE(extent->low, low);
        EXPECT_GE(extent->high, high);
        // Corners are rarely met by chance.
        if (inside < 5'000) continue;
        EXPECT_LT(low - extent->low, 0.35 * (high - low)) << trial;
        EXPECT_LT(extent->high - high, 0.35 * (high - low)) << trial;
    }
    EXPECT_GT(cut, 100u);
}

TEST(PartExtent, ShadowsFallWithinTheirBounds) {
    Random random(10);
    for (int trial = 0; trial < 300; ++trial) {
        const glm::dvec3 direction = random.direction();
        const ScenePart flat = box(random.direction(), {5, 0, 5}, true);
        const std::optional<Plane> plane = planeOfFlat(flat, direction);
        if (!plane) continue;
        EXPECT_LT(glm::dot(plane->normal, direction), 0.0);
        const ScenePart part = randomPart(random, random.direction() * 3.0, 1.0, true);
        const std::optional<ScenePart> shadow = shadowOn(*plane, part, direction);
        for (int p = 0; p < 200; ++p) {
            const glm::dvec3 point = pointOf(random, part);
            const double height = glm::dot(plane->normal, point) + plane->offset;
            if (height <= 1e-4) continue;
            ASSERT_TRUE(shadow.has_value());
            const glm::dvec3 falls = point - direction * (height / glm::dot(plane->normal, direction));
            EXPECT_LE(glm::length(falls - shadow->centre), shadow->radius);
            const glm::dvec3 axis = random.direction();
            const std::optional<Extent> extent = extentWithin(*shadow, {}, axis);
            EXPECT_GE(glm::dot(falls, axis), extent->low);
            EXPECT_LE(glm::dot(falls, axis), extent->high);
        }
    }
}

// Near and far move in steps, so that most frames keep them.
TEST(Cascades, DepthsMoveInSteps) {
    Random random(8);
    for (int trial = 0; trial < 200; ++trial) {
        const Situation s = randomSituation(random, false);
        const Cascade cascade = cascadeOf(s, random.below(s.settings.count));
        const double step = 0.25 * std::exp2(std::ceil(std::log2(cascade.halfExtent)));
        const double nearest = glm::dot(cascade.centre, glm::normalize(glm::dvec3(s.direction))) / step;
        EXPECT_NEAR(nearest, std::round(nearest), 1e-6 * (1.0 + std::abs(nearest)));
        EXPECT_NEAR(cascade.depth / step, std::round(cascade.depth / step), 1e-6 * cascade.depth / step);
        EXPECT_GE(cascade.depth, step);
    }
}

// Size follows from lens and distances; turning and walking leave it to the bit while these stay.
TEST(Cascades, SizeDoesNotDependOnWhereTheCameraLooks) {
    Random random(4);
    for (int trial = 0; trial < 100; ++trial) {
        Situation s = randomSituation(random, trial % 2 == 0);
        const SeenRange seen = s.seen();
        const std::uint32_t index = random.below(s.settings.count);
        const Cascade before = cascadeOf(s, index, seen);
        for (int i = 0; i < 10; ++i) {
            s.camera.forward = random.direction();
            s.camera.position = random.direction() * random.within(0.0, 100.0);
            EXPECT_EQ(cascadeOf(s, index, seen).halfExtent, before.halfExtent);
        }
    }
}

bool sameMatrix(const ShadowView& a, const ShadowView& b) {
    return std::equal(std::begin(a.clipFromWorld), std::end(a.clipFromWorld), std::begin(b.clipFromWorld));
}

// A walk in small steps: the cascade either is the same to the bit, or has moved by whole steps of kCascadeStepPx
// texels.
TEST(Cascades, MoveInWholeSteps) {
    Random random(5);
    std::size_t kept = 0, moved = 0;
    for (int trial = 0; trial < 60; ++trial) {
        Situation s = randomSituation(random, trial % 2 == 0);
        fillWithOnePart(s);
        const SeenRange seen = {0.0, std::exp(random.within(0.0, 7.0)), 0.0};
        const std::uint32_t index = random.below(s.settings.count);
        Cascade before = cascadeOf(s, index, seen);
        const double texel = 2.0 * before.halfExtent / s.sizePx, step = texel * kCascadeStepPx;
        const glm::dvec3 way = random.direction() * (0.1 * step), origin(0.0);
        const glm::dvec3 travel = glm::normalize(glm::dvec3(s.direction));
        for (int i = 0; i < 40; ++i) {
            s.camera.position += way;
            const Cascade after = cascadeOf(s, index, seen);
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
        fillWithOnePart(s);
        const std::uint32_t index = random.below(s.settings.count);
        const glm::dvec3 point = random.direction() * 3.0;
        glm::dvec2 fraction(0.0);
        for (int i = 0; i < 10; ++i) {
            s.camera.position = random.direction() * random.within(0.0, 20.0);
            s.camera.forward = random.direction();
            const Cascade cascade = cascadeOf(s, index, {0.0, 100.0, 1.0});
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

const ScenePart kAround = box(glm::dvec3(0.0), glm::dvec3(30.0), true);

TEST(Cascades, PlannedOnePerSliceInTheLightsOrder) {
    ShadowPlanSettings settings;
    settings.cascades.count = 3;
    ShadowPlanner planner(settings);
    ShadowLight point;
    const std::vector<ShadowLight> lights = {point, sun(), point, sun()};
    ShadowPlanCamera camera;
    camera.cascades.position = camera.position = {0.0, 2.0, 10.0};
    const ShadowPlan plan = planner.plan(lights, camera, {&kAround, 1}, camera.position);
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
    EXPECT_TRUE(planner.plan({&light, 1}, {}, {}, {}).views.empty());
    EXPECT_EQ(planner.plan({&light, 1}, {}, {}, {}).firstView[0], kNoShadowViews);
    EXPECT_EQ(planner.plan({&light, 1}, {}, {&kAround, 1}, {}).views.size(), 4u);
    ShadowLight still = sun();
    still.casts = false;
    EXPECT_TRUE(planner.plan({&still, 1}, {}, {&kAround, 1}, {}).views.empty());
}

TEST(Cascades, PlacesStayWhileTheCameraWalks) {
    ShadowPlanner planner({});
    const ShadowLight light = sun();
    ShadowPlan before;
    for (int frame = 0; frame < 50; ++frame) {
        ShadowPlanCamera camera;
        camera.position = camera.cascades.position = {0.05 * frame, 2.0, 10.0};
        const ShadowPlan plan = planner.plan({&light, 1}, camera, {&kAround, 1}, camera.position);
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
