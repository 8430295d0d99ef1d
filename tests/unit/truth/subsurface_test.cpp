// Light in bodies of subsurface materials, by both rules: fronts that look at the light left out, or kept and a
// distance left free.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "unit/truth/truth_scenes.h"

namespace gnomon::renderer::truth_test {
namespace {

constexpr double kThickness = 0.01;

// An ear: a closed plate of 1 cm, whose visible side is at z = 0 and looks to -z, away from the light.
class Ear : public testing::Test {
protected:
    void SetUp() override {
        b.scene.materials.resize(2);
        b.scene.materials[1].subsurface = true;
        const auto z = static_cast<float>(kThickness);
        near = b.quad({-1, -1, 0}, {-1, 1, 0}, {1, 1, 0}, {1, -1, 0});
        far = b.quad({-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z});
        for (const std::uint32_t mesh : {near, far}) b.scene.meshes[mesh].primitives[0].material = 1;
    }
    // From `z` straight to the light; `own` as of quads in the order of their making.
    double blocker(const SubsurfaceRule& rule, double z, std::uint32_t ownQuad, bool subsurface) const {
        const TracedScene traced(b.scene, restPose(b.scene), {0.1, 0.2, 0.3}, rule);
        const std::uint32_t own = ownQuad == kNone ? kNone : 2 * ownQuad + 1;
        const glm::dvec3 from = glm::dvec3(-0.2, 0.3, z) - traced.origin();
        const double side = mirrored ? -5.0 : 5.0;
        return traced.nearestBlocker({from, from + glm::dvec3(0.0, 0.0, side), own, 0.0, subsurface});
    }
    bool lit(const SubsurfaceRule& rule, double z, std::uint32_t ownQuad, bool subsurface) const {
        return std::isinf(blocker(rule, mirrored ? -z : z, ownQuad, subsurface));
    }

    SceneBuilder b;
    std::uint32_t near = 0, far = 0;
    bool mirrored = false;
};

constexpr SubsurfaceRule kLeftOut, kKept = {.frontsBlock = true, .freeMetres = 0.02};

TEST_F(Ear, IsLitFromBehindAndCastsAShadow) {
    EXPECT_TRUE(lit(kLeftOut, 0.0, near, true));
    EXPECT_TRUE(lit(kLeftOut, kThickness, far, true));
    EXPECT_FALSE(lit(kLeftOut, -1.0, kNone, false)) << "what is opaque behind it";
    EXPECT_FALSE(lit(kLeftOut, -1.0, kNone, true)) << "and another body's skin";
    EXPECT_NEAR(blocker(kLeftOut, -1.0, kNone, false), 1.0, 1e-9) << "by the side that looks away from the light";
    EXPECT_TRUE(lit(kLeftOut, 0.5 * kThickness, kNone, false)) << "a body that is inside, as shadowmaps have it";
}

TEST_F(Ear, FreeDistanceIsForSubsurfacePointsAlone) {
    EXPECT_TRUE(lit(kKept, 0.0, near, true));
    EXPECT_FALSE(lit(kKept, 0.0, near, false));
    EXPECT_FALSE(lit({.frontsBlock = true, .freeMetres = 0.5 * kThickness}, 0.0, near, true)) << "too thick";
    EXPECT_FALSE(lit(kKept, -1.0, kNone, true));
    EXPECT_NEAR(blocker(kKept, -0.015, kNone, true), 0.025, 1e-9) << "the side that is nearer does not count";
    EXPECT_TRUE(lit({.frontsBlock = false, .freeMetres = 0.02}, 0.0, near, true));
    EXPECT_NEAR(blocker({.frontsBlock = false, .freeMetres = 0.02}, -0.015, kNone, true), 0.015, 1e-9)
        << "without effect where fronts are left out";
}

TEST_F(Ear, ANoseShadowsTheCheek) {
    for (const float z : {0.2f, 0.21f}) {
        const bool front = z > 0.205f;
        const std::uint32_t nose = front ? b.quad({-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z})
                                         : b.quad({-1, -1, z}, {-1, 1, z}, {1, 1, z}, {1, -1, z});
        b.scene.meshes[nose].primitives[0].material = 1;
    }
    for (const SubsurfaceRule& rule : {kLeftOut, kKept}) {
        EXPECT_FALSE(lit(rule, 0.0, near, true));
        EXPECT_FALSE(lit(rule, kThickness, far, true));
        EXPECT_TRUE(lit(rule, 0.21, 3, true)) << "its tip";
    }
}

TEST_F(Ear, OtherMaterialsBlockFromBothSides) {
    b.scene.materials[1].doubleSided = true;
    EXPECT_FALSE(lit(kLeftOut, 0.0, near, true));
    b.scene.materials[1] = {};
    EXPECT_FALSE(lit(kLeftOut, 0.0, near, true));
}

// The same seen in a mirror: what was outside still is.
TEST_F(Ear, MirroredBodiesKeepTheirFronts) {
    mirrored = true;
    for (Instance& instance : b.scene.instances)
        instance.worldFromObject = glm::scale(glm::mat4(1.0f), glm::vec3(1.0f, 1.0f, -1.0f));
    EXPECT_TRUE(lit(kLeftOut, 0.0, near, true));
    EXPECT_FALSE(lit(kLeftOut, -1.0, kNone, false));
    EXPECT_NEAR(blocker(kLeftOut, 1.0, kNone, false), 1.0, 1e-9);
}

// A ball lit from behind glows as a whole, and its shadow is that of any ball; penumbrae too.
TEST(Subsurface, ABallGlowsAndCastsAShadow) {
    std::size_t skin = 0, dark[2] = {};
    for (const bool subsurface : {false, true}) {
        SceneBuilder b;
        b.scene.materials.resize(2);
        b.scene.materials[1].subsurface = subsurface;
        b.quad({-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, 4);
        b.scene.meshes[b.sphere({0, 0.8f, 0}, 0.5f, 32)].primitives[0].material = 1;
        const TracedScene traced(b.scene, restPose(b.scene), glm::dvec3(0.0));
        const Seen seen = lookAt(traced, {0.5, 1.5, 4.0}, {0.0, 0.4, 0.0}, {96, 54});
        LightTruthDesc desc;
        desc.light.position = {-0.5f, 3.0f, -3.0f};
        desc.light.rangeMetres = 20.0f;
        desc.light.sourceRadius = 0.2f;
        desc.subsetOf = 1;
        const LightTruth truth = traceLight(traced, seen.receivers, seen.extent, desc);
        for (const PixelTruth& pixel : truth.pixels) {
            dark[subsurface ? 1 : 0] += !pixel.subsurface && pixel.hard == HardTruth::Dark;
            if (!pixel.subsurface) continue;
            ++skin;
            EXPECT_EQ(pixel.hard, HardTruth::Lit);
            EXPECT_EQ(pixel.soft, 1.0f);
        }
    }
    EXPECT_GT(skin, 150u);
    EXPECT_GT(dark[0], 100u);
    EXPECT_EQ(dark[0], dark[1]) << "the floor's shadow";
}

}  // namespace
}  // namespace gnomon::renderer::truth_test
