// Rays against closed forms: what blocks, how far away it is, and what must not block.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "unit/truth/truth_scenes.h"

namespace gnomon::renderer::truth_test {
namespace {

TEST(TracedScene, SphereCastsADisk) {
    SceneBuilder b;
    b.sphere({0, 3, 0}, 1.0f, 512);
    const TracedScene traced(b.scene, restPose(b.scene), glm::dvec3(0.0));
    // The cone of tangents from a light at a height of 10 m meets the floor in a circle.
    const double radius = 10.0 * std::tan(std::asin(1.0 / 7.0));
    for (int i = 0; i < 360; ++i) {
        const glm::dvec3 around(std::cos(i * 0.0174533), 0.0, std::sin(i * 0.0174533));
        EXPECT_TRUE(traced.blocked({0.999 * radius * around, {0, 10, 0}})) << i;
        EXPECT_FALSE(traced.blocked({1.0001 * radius * around, {0, 10, 0}})) << i;
    }
}

TEST(TracedScene, SlabBlocksFromItsLowerFace) {
    SceneBuilder b;
    b.quad({-1, 1e-4f, -1}, {1, 1e-4f, -1}, {1, 1e-4f, 1}, {-1, 1e-4f, 1});
    b.quad({-1, 1e-3f, -1}, {1, 1e-3f, -1}, {1, 1e-3f, 1}, {-1, 1e-3f, 1});
    const TracedScene traced(b.scene, restPose(b.scene), {0.0, 1.5, 4.0});
    const glm::dvec3 from(0.3, -1.5, -3.9), to(0.3, 3.5, -3.9);
    EXPECT_NEAR(traced.nearestBlocker({from, to}), 1e-4, 1e-9);
    EXPECT_TRUE(traced.blocked({from, to}));
    EXPECT_FALSE(traced.blocked({from + glm::dvec3(1.0, 0.0, 0.0), to + glm::dvec3(1.0, 0.0, 0.0)}));
    // A light between the faces, and one below both.
    EXPECT_TRUE(traced.blocked({from, from + glm::dvec3(0.0, 5e-4, 0.0)}));
    EXPECT_FALSE(traced.blocked({from, from + glm::dvec3(0.0, 5e-5, 0.0)}));
    EXPECT_FALSE(traced.blocked({from, to, kNone, 2e-3})) << "what is nearer than freeMetres does not block";
}

TEST(TracedScene, SlitLetsLightThrough) {
    SceneBuilder b;
    b.quad({-5, 1, -5}, {-0.01f, 1, -5}, {-0.01f, 1, 5}, {-5, 1, 5});
    b.quad({0.01f, 1, -5}, {5, 1, -5}, {5, 1, 5}, {0.01f, 1, 5});
    const TracedScene traced(b.scene, restPose(b.scene), glm::dvec3(0.0));
    for (int i = -400; i <= 400; ++i) {
        const double x = i * 1e-4;  // a light at 2 m halves the way: the slit is twice as wide on the floor
        if (std::abs(std::abs(x) - 0.02) < 1e-6) continue;
        EXPECT_EQ(traced.blocked({{x, 0, 0.1}, {0, 2, 0}}), std::abs(x) > 0.02) << x;
    }
}

// A finely divided plane, turned, 100 m from the origin: each point lies on one triangle and a hair beside another, and
// lights stand down to 2 degrees above the plane.
TEST(TracedScene, CoplanarNeighboursCastNoShadow) {
    SceneBuilder b;
    b.quad({-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, 40);
    glm::dmat4& world = b.scene.instances[0].worldFromObject;
    world = glm::rotate(glm::translate(glm::mat4(1.0f), {100.3f, -51.7f, 83.1f}), 0.7f, glm::vec3(0.3f, 0.8f, -0.5f));
    const TracedScene traced(b.scene, restPose(b.scene), {99.0, -50.0, 80.0});
    const glm::dvec3 up = glm::normalize(glm::dvec3(world[1])), side = glm::normalize(glm::dvec3(world[0]));
    const glm::dvec3 other = glm::cross(up, side);
    int rays = 0;
    for (std::uint32_t i = 0; i < traced.triangles().size(); ++i) {
        const auto& c = traced.triangles()[i].corners;
        for (std::size_t k = 0; k < 3; ++k)
            for (const double inset : {1e-6, 1e-3}) {
                const glm::dvec3 p = glm::mix(glm::mix(c[k], c[(k + 1) % 3], 0.37), (c[0] + c[1] + c[2]) / 3.0, inset);
                for (int a = 0; a < 8; ++a)
                    for (const double elevation : {0.035, 0.2, 1.5}) {
                        const double angle = std::numbers::pi * a / 4.0;
                        const glm::dvec3 way =
                            std::cos(elevation) * (std::cos(angle) * side + std::sin(angle) * other) +
                            std::sin(elevation) * up;
                        ASSERT_FALSE(traced.blocked({p, p + 50.0 * way, i})) << i << " " << k << " " << elevation;
                        ++rays;
                    }
            }
    }
    EXPECT_GT(rays, 100'000);
}

// No light falls through the seams of a divided plane, whatever the rounding.
TEST(TracedScene, SeamsAreTight) {
    SceneBuilder b;
    b.quad({-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, 40);
    b.scene.instances[0].worldFromObject =
        glm::rotate(glm::translate(glm::mat4(1.0f), {100.3f, -51.7f, 83.1f}), 0.7f, glm::vec3(0.3f, 0.8f, -0.5f));
    const TracedScene traced(b.scene, restPose(b.scene), {99.0, -50.0, 80.0});
    const glm::dmat4 objectFromWorld = glm::inverse(glm::dmat4(b.scene.instances[0].worldFromObject));
    const glm::dvec3 from(1.0, 20.0, 2.0);
    int rays = 0;
    for (std::uint32_t i = 0; i < traced.triangles().size(); ++i) {
        const auto& c = traced.triangles()[i].corners;
        for (std::size_t k = 0; k < 3; ++k)
            for (int s = 1; s < 10; ++s) {
                const glm::dvec3 onSeam = glm::mix(c[k], c[(k + 1) % 3], 0.1 * s);
                const glm::dvec3 onPlane(objectFromWorld * glm::dvec4(onSeam + traced.origin(), 1.0));
                if (std::max(std::abs(onPlane.x), std::abs(onPlane.z)) > 0.999) continue;  // the plane's own border
                const glm::dvec3 middle = glm::mix(onSeam, (c[0] + c[1] + c[2]) / 3.0, 1e-9);
                ASSERT_TRUE(traced.blocked({from, middle + 2.0 * (middle - from)})) << i << " " << k;
                ++rays;
            }
    }
    EXPECT_GT(rays, 80'000);
}

// Out there floats have steps of 8 micrometres, and turned as it is nothing falls on them.
glm::dmat4 farAndTurned(int i) {
    return glm::rotate(glm::translate(glm::dmat4(1.0), {100.3 + 1e-6 * i, -51.7, 83.1}), 0.7 + 0.01 * i,
                       glm::dvec3(0.3, 0.8, -0.5));
}

// A blocker within a float step of the point: Embree may see them change places.
TEST(TracedScene, BlockersWithinAFloatStepBlock) {
    SceneBuilder b;
    b.quad({-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, 2);
    for (int i = 0; i < 300; ++i) {
        Pose pose = restPose(b.scene);
        pose.worldFromObject[0] = farAndTurned(i);
        const TracedScene traced(b.scene, pose, glm::dvec3(0.0));
        const auto at = [&](double x, double y, double z) {
            return glm::dvec3(pose.worldFromObject[0] * glm::dvec4(x, y, z, 1.0));
        };
        EXPECT_NEAR(traced.nearestBlocker({at(0.1, -2e-6, 0.3), at(0.1, 9.0, 0.4)}), 2e-6, 1e-8) << i;
        EXPECT_FALSE(traced.blocked({at(0.1, 2e-6, 0.3), at(0.1, 9.0, 0.4)})) << i;
    }
}

// The side of a box does not reach above its top, not even by a float step, where a point lies beside the edge.
TEST(TracedScene, EdgesOfConvexBodiesCastNoShadowOnThem) {
    SceneBuilder b;
    b.quad({-1, 0, -1}, {-1, 0, 1}, {0, 0, 1}, {0, 0, -1}, 8);
    b.quad({0, 0, -1}, {0, 0, 1}, {0, -1, 1}, {0, -1, -1}, 8);
    for (int i = 0; i < 300; ++i) {
        Pose pose = restPose(b.scene);
        pose.worldFromObject.assign(2, farAndTurned(i));
        const TracedScene traced(b.scene, pose, glm::dvec3(0.0));
        const auto at = [&](double x, double y, double z) {
            return glm::dvec3(pose.worldFromObject[0] * glm::dvec4(x, y, z, 1.0));
        };
        for (int k = 0; k < 20; ++k) {
            const double z = -0.5 + 0.04 * k;
            EXPECT_FALSE(traced.blocked({at(-1e-6, 1e-9, z), at(5.0, 0.5, z + 0.1)})) << i << " " << k;
        }
    }
}

class MaskedQuad : public testing::Test {
protected:
    SceneBuilder b;
    Material& material = b.scene.materials[0];
    void SetUp() override {
        b.quad({0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1});
        Image image;
        image.width = image.height = 2;
        image.rgba8.assign(16, 255);
        image.rgba8[3] = 0;   // a hole at small u and v,
        image.rgba8[15] = 0;  // and one at large ones
        b.scene.images.push_back(image);
        material.alphaMode = AlphaMode::Mask;
        material.baseColourTexture.image = 0;
        material.baseColourTexture.linear = false;
    }
    bool blockedAt(double u, double v) {
        const TracedScene traced(b.scene, restPose(b.scene), {0.1, 0.2, 0.3});
        const glm::dvec3 p = glm::dvec3(u, 0.0, v) - traced.origin();
        return traced.blocked({p, p + glm::dvec3(0.0, 2.0, 0.0)});
    }
};

TEST_F(MaskedQuad, HolesLetLightThrough) {
    EXPECT_FALSE(blockedAt(0.25, 0.2));
    EXPECT_TRUE(blockedAt(0.75, 0.2));
    EXPECT_TRUE(blockedAt(0.25, 0.8));
    EXPECT_FALSE(blockedAt(0.75, 0.8));
    material.alphaMode = AlphaMode::Opaque;
    EXPECT_TRUE(blockedAt(0.25, 0.2));
}

TEST_F(MaskedQuad, TextureTransformAndWrapCount) {
    material.baseColourTexture.uvOffset = {0.5f, 0.0f};
    EXPECT_TRUE(blockedAt(0.25, 0.2));
    EXPECT_FALSE(blockedAt(0.75, 0.2)) << "repeated";
    material.baseColourTexture.repeatU = false;
    EXPECT_TRUE(blockedAt(0.75, 0.2)) << "clamped";
    material.baseColourTexture.uvOffset = {-2.5f, 0.0f};
    EXPECT_FALSE(blockedAt(0.75, 0.2)) << "clamped to the other side";
    material.baseColourTexture.uvTransform = glm::mat2(0.0f);
    material.baseColourTexture.uvOffset = {0.9f, 0.9f};
    EXPECT_FALSE(blockedAt(0.75, 0.2)) << "all of it shows one texel";
}

TEST_F(MaskedQuad, CutoffAndFactorsCount) {
    material.baseColour.a = 0.4f;
    EXPECT_FALSE(blockedAt(0.75, 0.2));
    material.alphaCutoff = 0.3f;
    EXPECT_TRUE(blockedAt(0.75, 0.2));
    material.alphaMode = AlphaMode::Blend;
    EXPECT_FALSE(blockedAt(0.75, 0.2)) << "blended: cut at one half, whatever the cut-off";
    b.scene.meshes[0].primitives[0].colours.assign(4, glm::vec4(2.0f));
    EXPECT_TRUE(blockedAt(0.75, 0.2));
}

// Alpha equal to the cut-off is opaque, however the interpolation rounds.
TEST_F(MaskedQuad, AlphaEqualToTheCutoffBlocks) {
    material.baseColourTexture.image = kNone;
    Primitive& primitive = b.scene.meshes[0].primitives[0];
    for (const float alpha : {0.5f, 0.3f, 0.9f, 1.0f, 100.0f / 255.0f}) {
        for (const bool byVertices : {false, true}) {
            material.alphaCutoff = alpha;
            material.baseColour.a = byVertices ? 1.0f : alpha;
            primitive.colours.assign(4, glm::vec4(1.0f, 1.0f, 1.0f, byVertices ? alpha : 1.0f));
            const TracedScene traced(b.scene, restPose(b.scene), {0.1, 0.2, 0.3});
            int open = 0;
            for (int i = 0; i < 2000; ++i) {
                const glm::dvec3 p =
                    glm::dvec3(std::fmod(0.618034 * i, 0.98) + 0.01, 0.0, std::fmod(0.754878 * i, 0.98) + 0.01) -
                    traced.origin();
                open += traced.blocked({p, p + glm::dvec3(0.0, 2.0, 0.0)}) ? 0 : 1;
            }
            EXPECT_EQ(open, 0) << alpha << " " << byVertices;
            material.alphaCutoff = alpha + 1.0f / 255.0f;  // one step of eight bits more: cut out
            EXPECT_FALSE(blockedAt(0.3, 0.4)) << alpha << " " << byVertices;
        }
    }
}

// A scale of zero along one axis leaves a flat thing, which blocks. Along two it leaves a line, which does not.
TEST(TracedScene, FlatInstancesBlockAndLinesDoNot) {
    SceneBuilder b;  // a roof that stands on edge, and is pressed flat
    b.quad({-1, 0, -1}, {1, 0, -1}, {1, 5, 1}, {-1, 5, 1});
    Pose pose = restPose(b.scene);
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), 0.4, glm::dvec3(0, 1, 0));
    const auto blocks = [&](const glm::dvec3& scale) {
        pose.worldFromObject[0] =
            glm::translate(glm::dmat4(1.0), {0, 1, 0}) * turn * glm::scale(glm::dmat4(1.0), scale);
        const TracedScene traced(b.scene, pose, glm::dvec3(0.0));
        const ShadowRay ray = {{0.1, 0.0, 0.2}, {0.1, 2.0, 0.2}};
        if (traced.blocked(ray)) {
            EXPECT_NEAR(traced.nearestBlocker(ray), 1.0, 1e-9);
        }
        return traced.blocked(ray);
    };
    EXPECT_TRUE(blocks({1, 0, 1}));
    EXPECT_TRUE(blocks({-1, 0, 1}));
    EXPECT_FALSE(blocks({1, 0, 0}));
    EXPECT_FALSE(blocks({0, 0, 1}));
    EXPECT_FALSE(blocks({0, 0, 0}));
    // Smaller than any threshold on a determinant would have it.
    b.scene.meshes[0].primitives[0].positions = {
        {-1e14f, 0, -1e14f}, {1e14f, 0, -1e14f}, {1e14f, 0, 1e14f}, {-1e14f, 0, 1e14f}};
    EXPECT_TRUE(blocks({1e-14, 1e-14, 1e-14}));
}

TEST(TracedScene, PoseMovesTriangles) {
    SceneBuilder b;
    b.quad({-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1});
    Pose pose = restPose(b.scene);
    pose.worldFromObject[0] = glm::translate(glm::dmat4(1.0), {10.0, 0.0, 0.0});
    PosedPrimitive deformed;
    deformed.positions = b.scene.meshes[0].primitives[0].positions;
    for (glm::vec3& p : deformed.positions) p.y += 2.0f;
    pose.deformed.push_back(deformed);
    const TracedScene traced(b.scene, pose, glm::dvec3(0.0));
    EXPECT_FALSE(traced.blocked({{0, -1, 0.1}, {0, 5, 0.1}}));
    EXPECT_NEAR(traced.nearestBlocker({{10, -1, 0.1}, {10, 5, 0.1}}), 3.0, 1e-9);
}

TEST(TracedScene, EmptySceneBlocksNothing) {
    SceneBuilder b;
    const TracedScene traced(b.scene, restPose(b.scene), glm::dvec3(0.0));
    EXPECT_FALSE(traced.blocked({{0, -1, 0}, {0, 5, 0}}));
    EXPECT_FALSE(traced.blocked({{0, 5, 0}, {0, 5, 0}})) << "a ray without length";
}

}  // namespace
}  // namespace gnomon::renderer::truth_test
