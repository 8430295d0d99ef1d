// A cat on the rim of the fountain, swallows over the court, and a vane on the roof.

#include "scene/builtin/courtyard_figure.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin/numbers.h"

namespace gnomon::renderer::courtyard {
namespace {

// Upright ellipses around (0, y, z), from below.
struct Slice {
    float y, z, wide, deep;
};

void addBody(ShapeBuilder& shape, std::initializer_list<Slice> slices, int sides) {
    std::vector<ShapeBuilder::Ring> rings;
    for (const Slice& s : slices) rings.push_back({{0, s.y, s.z}, {s.wide, 0, 0}, {0, 0, -s.deep}});
    shape.loft(rings, sides);
}

std::uint32_t catBodyMesh(Parts& parts) {
    ShapeBuilder fur(parts.materials.fur);
    addBody(fur,
            {{0.0f, -0.03f, 0.085f, 0.13f},
             {0.03f, -0.035f, 0.10f, 0.145f},
             {0.09f, -0.04f, 0.095f, 0.125f},
             {0.16f, -0.015f, 0.078f, 0.095f},
             {0.23f, 0.015f, 0.06f, 0.07f},
             {0.29f, 0.03f, 0.042f, 0.046f},
             {0.32f, 0.035f, 0.02f, 0.024f}},
            18);
    for (const float x : {-0.04f, 0.04f}) {
        const glm::vec3 leg[] = {{x, 0.20f, 0.055f}, {x, 0.10f, 0.085f}, {x, 0.02f, 0.09f}, {x, 0.002f, 0.09f}};
        const float radii[] = {0.03f, 0.024f, 0.02f, 0.022f};
        fur.branch(leg, radii, 10);
        fur.sphere({x, 0.016f, 0.108f}, 0.022f, 6, 10);
    }
    return parts.builder.mesh("cat", {fur.take()});
}

std::uint32_t catHeadMesh(Parts& parts) {
    ShapeBuilder fur(parts.materials.fur), eyes(parts.materials.glow);
    fur.sphere({0, 0.035f, 0.02f}, 0.062f, 10, 16);
    fur.sphere({0, 0.016f, 0.068f}, 0.027f, 6, 10);
    for (const float x : {-0.034f, 0.034f}) {
        const ShapeBuilder::Ring ear[] = {{{x, 0.065f, 0.015f}, {0.026f, 0, 0}, {0, 0, -0.014f}},
                                          {{x * 1.12f, 0.122f, 0.012f}, {0.003f, 0, 0}, {0, 0, -0.003f}}};
        fur.loft(ear, 8);
        eyes.sphere({0.72f * x, 0.048f, 0.072f}, 0.0085f, 6, 8);
    }
    return parts.builder.mesh("cat's head", {fur.take(), eyes.take()});
}

// A sitting cat of 0.42 m; its head is a node of its own, its tail a chain of nodes.
void addCat(Parts& parts, const glm::vec3& place, float turn) {
    SceneBuilder& b = parts.builder;
    const std::uint32_t root = addNode(b.scene, "cat", kNone, place, about({0, 1, 0}, turn));
    b.place(catBodyMesh(parts), worldFromNode(b.scene, root));
    const auto look = [](float at) -> glm::quat {
        return about({0, 1, 0}, 0.7f * std::sin(kTau * at) + 0.2f * std::sin(3.0f * kTau * at)) *
               about({1, 0, 0}, 0.12f * std::sin(2.0f * kTau * at));
    };
    const std::uint32_t head = addNode(b.scene, "cat's head", root, {0, 0.30f, 0.045f}, look(0.0f));
    placeOn(b, head, catHeadMesh(parts));
    animateTurn(b.scene, head, 60, look);

    constexpr int kTail = 5;
    constexpr float kPiece = 0.075f;
    std::vector<std::uint32_t> joints;
    std::vector<glm::mat4> jointFromFigure;
    for (int i = 0; i < kTail; ++i) {
        const auto curl = [i](float at) -> glm::quat {
            const float lag = 0.09f * static_cast<float>(i);
            const float swish = (i == 0 ? 0.35f : 0.30f) * std::sin(kTau * (4.0f * at - lag));
            // Along -z at first; hangs over the rim, its tip turned up.
            return about({0, 1, 0}, swish) * about({1, 0, 0}, i == 0 ? -0.75f : i < 3 ? -0.22f : 0.42f);
        };
        const std::uint32_t parent = joints.empty() ? root : joints.back();
        const glm::vec3 from = joints.empty() ? glm::vec3(0, 0.035f, -0.15f) : glm::vec3(0, 0, -kPiece);
        joints.push_back(addNode(b.scene, "cat's tail", parent, from, curl(0.0f)));
        jointFromFigure.push_back(glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, kPiece * static_cast<float>(i))));
        animateTurn(b.scene, joints.back(), 96, curl);
    }
    ShapeBuilder tail(parts.materials.fur);
    std::vector<glm::vec3> path;
    std::vector<float> radii;
    for (int i = 0; i <= 3 * kTail; ++i) {
        path.emplace_back(0, 0, 0.03f - kPiece / 3.0f * static_cast<float>(i));
        radii.push_back(i == 3 * kTail ? 0.006f : 0.019f - 0.0005f * static_cast<float>(i));
    }
    tail.branch(path, radii, 10);
    Primitive p = tail.take();
    for (const glm::vec3& v : p.positions) {
        const float along = std::clamp(-v.z / kPiece - 0.5f, 0.0f, kTail - 1.001f);
        const auto joint = static_cast<std::uint16_t>(along);
        const float next = along - static_cast<float>(joint);
        p.joints.emplace_back(joint, joint + 1, 0, 0);
        p.weights.emplace_back(1.0f - next, next, 0.0f, 0.0f);
    }
    placeSkinned(b, "cat's tail", {std::move(p)}, joints, jointFromFigure);
}

// Zero-thickness wings, a slim body; 0.34 m across.
void addSwallows(Parts& parts) {
    SceneBuilder& b = parts.builder;
    ShapeBuilder bodyShape(parts.materials.feather);
    const glm::vec3 spine[] = {{0, 0, 0.10f},     {0, 0.004f, 0.085f}, {0, 0.006f, 0.05f},
                               {0, 0.002f, 0.0f}, {0, 0, -0.06f},      {0, 0.002f, -0.09f}};
    const float radii[] = {0.004f, 0.014f, 0.02f, 0.021f, 0.012f, 0.004f};
    bodyShape.branch(spine, radii, 8);
    const glm::vec3 tailLeft[] = {{0, 0.003f, -0.08f}, {-0.012f, 0.003f, -0.085f}, {-0.045f, 0.003f, -0.17f}};
    const glm::vec3 tailRight[] = {{0, 0.003f, -0.08f}, {0.045f, 0.003f, -0.17f}, {0.012f, 0.003f, -0.085f}};
    bodyShape.polygon(tailLeft);
    bodyShape.polygon(tailRight);
    const std::uint32_t bodyMesh = b.mesh("swallow", {bodyShape.take()});
    std::uint32_t wingMesh[2];
    for (const int right : {0, 1}) {
        const float s = right != 0 ? -1.0f : 1.0f;
        ShapeBuilder wing(parts.materials.feather);
        wing.sheet(
            [s](float u, float v) {  // u away from the body, v backwards
                const float x = 0.17f * u, sweep = 0.05f - 0.10f * u * u,
                            chord = 0.065f * std::sqrt(std::max(0.02f, 1.0f - u));
                return glm::vec3(s * x, 0.02f * u * (1.0f - u), sweep - chord * v);
            },
            6, 2, 1.0f, 1.0f);
        wingMesh[right] = b.mesh("swallow's wing", {wing.take()});
    }
    constexpr int kSwallows = 5;
    for (int i = 0; i < kSwallows; ++i) {
        const float offset = 0.21f * static_cast<float>(i) + 0.02f * static_cast<float>(i * i),
                    k = static_cast<float>(i);
        const auto place = [=](float at) -> glm::vec3 {
            const float a = kTau * (at + offset);
            return {-1.5f + (6.5f + 0.7f * k) * std::cos(a), 7.0f + 0.5f * k + 0.8f * std::sin(2.0f * a + k),
                    -1.0f + (4.2f + 0.5f * k) * std::sin(a)};
        };
        const auto heading = [=](float at) -> glm::quat {
            const glm::vec3 v = place(at + 0.002f) - place(at - 0.002f);
            return about({0, 1, 0}, std::atan2(v.x, v.z)) *
                   about({1, 0, 0}, -std::atan2(v.y, std::sqrt(v.x * v.x + v.z * v.z))) * about({0, 0, 1}, 0.5f);
        };
        const std::uint32_t root = addNode(b.scene, "swallow", kNone, place(0.0f), heading(0.0f));
        placeOn(b, root, bodyMesh);
        animatePlace(b.scene, root, 144, place);
        animateTurn(b.scene, root, 144, heading);
        for (const int right : {0, 1}) {
            const float s = right != 0 ? -1.0f : 1.0f;
            const auto flap = [=](float at) -> glm::quat {  // bursts of beats between glides
                const float burst = 0.5f + 0.5f * std::sin(kTau * (3.0f * at + 0.3f * k));
                return about({0, 0, 1}, s * (0.12f + 0.75f * burst * std::sin(kTau * (48.0f * at + 0.17f * k))));
            };
            const std::uint32_t wing =
                addNode(b.scene, "swallow's wing", root, {0.012f * s, 0.006f, 0.02f}, flap(0.0f));
            placeOn(b, wing, wingMesh[right]);
            animateTurn(b.scene, wing, 480, flap);
        }
    }
}

// A cock in sheet metal that turns with the wind, back and forth.
void addVane(Parts& parts) {
    SceneBuilder& b = parts.builder;
    ShapeBuilder pole(parts.materials.iron), plate(parts.materials.sheetIron);
    const glm::vec3 top(kHalfX + 1.7f, 10.35f, -kHalfZ - 1.7f), up[] = {{0, -2.3f, 0}, {0, 0.02f, 0}};
    pole.tube(up, 0.03f, 8);
    for (const float turn : {0.0f, 1.5707963f}) {
        pole.setTransform(glm::rotate(glm::mat4(1.0f), turn, glm::vec3(0, 1, 0)));
        const glm::vec3 arm[] = {{-0.45f, -0.28f, 0}, {0.45f, -0.28f, 0}};
        pole.tube(arm, 0.014f, 6);
        for (const float x : {-0.45f, 0.45f}) pole.sphere({x, -0.28f, 0}, 0.035f, 6, 8);
    }
    b.place("vane's pole", pole, placed(top));
    const glm::vec3 arrow[] = {{0.5f, 0.12f, 0}, {0.78f, 0.22f, 0}, {0.5f, 0.32f, 0}};
    const glm::vec3 shaft[] = {{-0.7f, 0.20f, 0}, {0.55f, 0.20f, 0}, {0.55f, 0.24f, 0}, {-0.7f, 0.24f, 0}};
    const glm::vec3 bird[] = {{-0.12f, 0.24f, 0}, {0.10f, 0.24f, 0},  {0.22f, 0.45f, 0},
                              {0.12f, 0.58f, 0},  {-0.10f, 0.50f, 0}, {-0.22f, 0.40f, 0}};
    const glm::vec3 neck[] = {{0.10f, 0.46f, 0}, {0.22f, 0.45f, 0}, {0.30f, 0.74f, 0}, {0.20f, 0.80f, 0}};
    const glm::vec3 beak[] = {{0.29f, 0.70f, 0}, {0.38f, 0.70f, 0}, {0.29f, 0.76f, 0}};
    const glm::vec3 plume[] = {
        {-0.20f, 0.40f, 0}, {-0.08f, 0.50f, 0}, {-0.30f, 0.82f, 0}, {-0.50f, 0.72f, 0}, {-0.48f, 0.48f, 0}};
    plate.polygon(arrow);
    plate.polygon(shaft);
    plate.polygon(bird);
    plate.polygon(neck);
    plate.polygon(beak);
    plate.polygon(plume);
    const auto swing = [](float at) -> glm::quat {
        return about({0, 1, 0}, 0.5f + 0.8f * std::sin(kTau * at) + 0.25f * std::sin(3.0f * kTau * at));
    };
    const std::uint32_t node = addNode(b.scene, "vane", kNone, top, swing(0.0f));
    placeOn(b, node, b.mesh("vane", {plate.take()}));
    animateTurn(b.scene, node, 96, swing);
}

}  // namespace

void addWildlife(Parts& parts) {
    const float angle = 0.55f;  // around the fountain
    addCat(parts, {2.05f * std::cos(angle), 0.968f, 2.05f * std::sin(angle)}, 1.57f - angle);
    addSwallows(parts);
    addVane(parts);
}

}  // namespace gnomon::renderer::courtyard
