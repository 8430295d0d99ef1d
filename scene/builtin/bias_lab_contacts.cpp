// Things that touch what they stand on: balls, a chain, a cup and boxes on a table, and the foot of a colossus.

#include "scene/builtin/bias_lab.h"
#include "scene/builtin/implicit_surface.h"
#include "scene/builtin/numbers.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::renderer::lab {
namespace {

// A left foot in human size, cut above the ankle; toes along +z, the big one at +x, y = 0 its lowest point.
float footField(const glm::vec3& p) {
    const auto bar = [&](const glm::vec3& a, const glm::vec3& b, float ra, float rb) {
        return roundCone(p, a, b, ra, rb);
    };
    float foot = ellipsoid(p, {0, 0.036f, -0.092f}, {0.033f, 0.036f, 0.042f});
    const auto blend = [&](float part, float radius) { foot = smoothUnion(foot, part, radius); };
    blend(bar({0, 0.06f, -0.075f}, {0, 0.20f, -0.082f}, 0.033f, 0.037f), 0.03f);
    blend(bar({0, 0.042f, -0.07f}, {-0.008f, 0.027f, 0.06f}, 0.032f, 0.024f), 0.02f);
    blend(bar({0.002f, 0.085f, -0.05f}, {0.010f, 0.036f, 0.062f}, 0.031f, 0.022f), 0.03f);
    blend(bar({-0.024f, 0.021f, -0.06f}, {-0.034f, 0.019f, 0.05f}, 0.020f, 0.018f), 0.02f);
    blend(ellipsoid(p, {0.028f, 0.024f, 0.072f}, {0.026f, 0.024f, 0.028f}), 0.02f);
    blend(ellipsoid(p, {-0.034f, 0.020f, 0.05f}, {0.021f, 0.020f, 0.024f}), 0.02f);
    for (const float side : {-1.0f, 1.0f})
        blend(ellipsoid(p, {0.031f * side, 0.075f + 0.006f * side, -0.076f}, {0.012f, 0.016f, 0.015f}), 0.012f);
    struct Toe {
        float x, z, length, radius, spread;
    };
    float toes = 1.0f;
    for (const Toe& toe : {Toe{0.030f, 0.082f, 0.046f, 0.0150f, 0.000f},
                           {0.006f, 0.084f, 0.047f, 0.0108f, -0.002f},
                           {-0.012f, 0.079f, 0.044f, 0.0102f, -0.004f},
                           {-0.029f, 0.070f, 0.040f, 0.0098f, -0.006f},
                           {-0.043f, 0.058f, 0.036f, 0.0094f, -0.008f}}) {
        const glm::vec3 root(toe.x, 1.25f * toe.radius + 0.004f, toe.z);
        const glm::vec3 joint = root + glm::vec3(0.5f * toe.spread, 0.003f, 0.55f * toe.length);
        const glm::vec3 tip(toe.x + toe.spread, toe.radius, toe.z + toe.length);
        const float bent = smoothUnion(bar(root, joint, toe.radius, 0.92f * toe.radius),
                                       bar(joint, tip, 0.92f * toe.radius, toe.radius), 0.006f);
        toes = smoothUnion(toes, bent, 0.006f);
    }
    foot = smoothUnion(foot, toes, 0.012f);
    return smoothCut(foot, 0.165f - p.y, 0.006f);
}

void addFoot(Lab& lab) {
    constexpr float kScale = 2.2f, kSunk = 0.002f;  // metres into the plinth: it has weight
    const glm::vec3 at = kContacts + glm::vec3(0.42f, 0.10f - kSunk, -0.12f);
    ShapeBuilder plinth(lab.m.wall);
    plinth.box(at + glm::vec3(-0.26f, kSunk - 0.10f + kMat, -0.40f), at + glm::vec3(0.24f, kSunk, 0.46f),
               ShapeBuilder::kAll & ~ShapeBuilder::kBottom);
    const Bounds box{{-0.075f, -0.01f, -0.15f}, {0.065f, 0.185f, 0.16f}};
    lab.place("foot", {surfaceOf(footField, box, 0.004f, lab.m.white, placed(at, 0.25f, kScale)), plinth.take()});
}

// A ring of round bar; x along the link, y its axis.
void addLink(ShapeBuilder& chain, float halfLength, float halfWidth, float bar) {
    const auto surface = [=](float u, float v) {
        const float around = 2.0f * kPi * (u >= 1.0f ? u - 1.0f : u), section = 2.0f * kPi * (v >= 1.0f ? v - 1.0f : v);
        const float c = std::cos(around), s = std::sin(around);
        const glm::vec3 middle(halfLength * c, 0, halfWidth * s);
        const glm::vec3 out = glm::normalize(glm::vec3(halfWidth * c, 0, halfLength * s));
        return middle + bar * (std::cos(section) * out + std::sin(section) * glm::vec3(0, 1, 0));
    };
    chain.sheet(surface, 24, 10, 0.1f, 0.03f);
}

// Hangs from a hook on a post down to the mat and winds away over it. Links touch each other and the mat.
void addChain(Lab& lab) {
    constexpr float kHalfLength = 0.030f, kHalfWidth = 0.019f, kBar = 0.007f,
                    kPitch = 2.0f * (kHalfLength - kBar) - 0.001f;
    constexpr float kLean =
        0.70710678f * kHalfWidth + kBar;  // of a lying link, turned by 45 degrees: its middle's height
    const glm::vec3 hook = kContacts + glm::vec3(-0.78f, 0.62f, -0.42f);
    ShapeBuilder chain(lab.m.steel), post(lab.m.black);
    glm::vec3 at = hook - glm::vec3(0, kHalfLength - kBar - 0.006f, 0);
    float heading = 0.5f, drop = 0.5f * kPi;  // of the next step: over the mat, and down
    for (int i = 0; i < 44; ++i) {
        const glm::vec3 flat(std::cos(heading), 0, std::sin(heading));
        const glm::vec3 along = glm::normalize(std::cos(drop) * flat - std::sin(drop) * glm::vec3(0, 1, 0));
        const glm::vec3 side = glm::normalize(glm::cross(flat, glm::vec3(0, 1, 0))), up = glm::cross(side, along);
        const float roll = (i & 1) != 0 ? 0.25f * kPi : -0.25f * kPi;
        const glm::vec3 axis = std::cos(roll) * up + std::sin(roll) * side;
        chain.setTransform(glm::mat4(glm::vec4(along, 0), glm::vec4(axis, 0), glm::vec4(glm::cross(along, axis), 0),
                                     glm::vec4(at, 1)));
        addLink(chain, kHalfLength, kHalfWidth, kBar);
        const float rest = kMat + kLean, above = at.y - rest;
        drop = std::max(0.0f, std::min(0.5f * kPi, std::asin(std::min(1.0f, above / (2.2f * kPitch)))));
        const glm::vec3 step(std::cos(drop) * std::cos(heading), -std::sin(drop), std::cos(drop) * std::sin(heading));
        at += kPitch * step;
        if (above < 0.001f) {
            at.y = rest;
            drop = 0.0f;
        }
        heading += drop < 0.2f ? 0.16f * std::cos(0.30f * static_cast<float>(i)) + 0.03f : 0.0f;
    }
    lab.place("chain", chain);
    post.setTransform(placed(hook + glm::vec3(-0.10f, -hook.y, -0.06f)));
    const glm::vec2 column[] = {
        {0.11f, kMat}, {0.11f, kMat + 0.015f}, {0.012f, kMat + 0.022f}, {0.012f, 0.70f}, {0.0f, 0.70f}};
    post.lathe(column, 24);
    const glm::vec3 arm[] = {{0, 0.66f, 0},
                             {0.05f, 0.672f, 0.03f},
                             {0.09f, 0.66f, 0.054f},
                             {0.10f, 0.63f, 0.06f},
                             {0.104f, 0.614f, 0.0624f}};
    post.tube(arm, 0.006f, 12);
    lab.place("hook", post);
}

void addBalls(Lab& lab) {
    ShapeBuilder red(lab.m.accent), steel(lab.m.steel), white(lab.m.white);
    const glm::vec3 onMat = kContacts + glm::vec3(-0.12f, kMat, 0);
    red.sphere(onMat + glm::vec3(-0.02f, 0.19f, -0.30f), 0.19f, 40, 64);
    lab.place("ball", red);
    steel.sphere(onMat + glm::vec3(0.02f, 0.045f, 0.22f), 0.045f, 24, 36);
    steel.sphere(onMat + glm::vec3(-0.14f, 0.025f, 0.36f), 0.025f, 20, 32);
    lab.place("steel balls", steel);
    // A cup, 1 mm of foot ring above its bottom, and dice: closed boxes.
    white.setTransform(placed(onMat + glm::vec3(0.12f, 0, 0.52f)));
    const glm::vec2 cup[] = {{0.028f, 0.0f},    {0.034f, 0.0f},  {0.036f, 0.004f}, {0.048f, 0.04f},  {0.052f, 0.10f},
                             {0.0505f, 0.102f}, {0.049f, 0.10f}, {0.045f, 0.042f}, {0.030f, 0.009f}, {0.0f, 0.008f}};
    white.lathe(cup, 48);
    const glm::vec3 dice[] = {{-0.34f, 0, 0.50f}, {-0.27f, 0, 0.56f}, {-0.35f, 0, 0.58f}, {-0.348f, 0.036f, 0.578f}};
    float turn = 0.6f;
    for (const glm::vec3& at : dice) {
        white.setTransform(placed(onMat + at, turn));
        white.box({-0.018f, 0, -0.018f}, {0.018f, 0.036f, 0.018f}, ShapeBuilder::kAll & ~ShapeBuilder::kBottom);
        turn += 0.9f;
    }
    lab.place("cup and dice", white);
}

}  // namespace

void addContacts(Lab& lab) {
    addMat(lab, kContacts, 1.05f, 0.75f);
    addBalls(lab);
    addChain(lab);
    addFoot(lab);
}

}  // namespace gnomon::renderer::lab
