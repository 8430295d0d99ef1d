// What light shines through: a bust of wax with thin ears, and a plant.

#include "scene/builtin/bias_lab.h"
#include "scene/builtin/implicit_surface.h"
#include "scene/random.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::renderer::lab {
namespace {

constexpr float kBustScale = 1.25f;
constexpr float kEarHalfThickness = 0.0018f;  // in human size: 4.5 mm through in the bust

// A head in human size, y = 0 between nose and mouth, looking along +z; without its ears.
float headField(const glm::vec3& p) {
    const auto ball = [&](const glm::vec3& centre, float radius) { return glm::length(p - centre) - radius; };
    float head = ellipsoid(p, {0, 0.098f, -0.014f}, {0.074f, 0.092f, 0.094f});
    const auto blend = [&](float part, float radius) { head = smoothUnion(head, part, radius); };
    blend(ellipsoid(p, {0, 0.030f, 0.030f}, {0.055f, 0.080f, 0.062f}), 0.03f);
    blend(ball({0, -0.036f, 0.068f}, 0.017f), 0.035f);
    for (const float side : {-1.0f, 1.0f}) blend(ball({0.040f * side, 0.040f, 0.054f}, 0.022f), 0.03f);
    blend(roundCone(p, {-0.030f, 0.090f, 0.076f}, {0.030f, 0.090f, 0.076f}, 0.011f, 0.011f), 0.022f);
    for (const float side : {-1.0f, 1.0f}) {
        head = smoothCut(head, ball({0.031f * side, 0.070f, 0.101f}, 0.019f), 0.014f);
        blend(ball({0.030f * side, 0.068f, 0.073f}, 0.0145f), 0.006f);
    }
    blend(roundCone(p, {0, 0.080f, 0.088f}, {0, 0.032f, 0.112f}, 0.0075f, 0.0115f), 0.014f);
    for (const float side : {-1.0f, 1.0f}) blend(ball({0.012f * side, 0.028f, 0.099f}, 0.0085f), 0.008f);
    blend(roundCone(p, {-0.016f, 0.001f, 0.088f}, {0.016f, 0.001f, 0.088f}, 0.0065f, 0.0065f), 0.010f);
    blend(roundCone(p, {-0.014f, -0.013f, 0.087f}, {0.014f, -0.013f, 0.087f}, 0.0070f, 0.0070f), 0.008f);
    head = smoothCut(head, roundCone(p, {-0.022f, -0.006f, 0.097f}, {0.022f, -0.006f, 0.097f}, 0.002f, 0.002f), 0.006f);
    blend(roundCone(p, {0, -0.13f, -0.030f}, {0, 0.02f, -0.022f}, 0.054f, 0.050f), 0.03f);
    blend(ellipsoid(p, {0, -0.185f, -0.025f}, {0.150f, 0.058f, 0.080f}), 0.06f);
    return smoothCut(head, p.y + 0.205f, 0.006f);
}

// An ear in its own plane: x outwards, y up, z forwards; a bowl of even thickness with a rolled rim.
float earField(const glm::vec3& p) {
    const float x = (p.x - 0.012f + 0.12f * p.y) / 0.019f, y = p.y / 0.031f;
    const float narrow = 1.0f + 0.22f * y;  // wider above than at the lobe
    const float out = std::sqrt(x * x / (narrow * narrow) + y * y);
    const float bowl = -0.007f * (1.0f - out * out);
    const float plate = smoothCut(std::abs(p.z - bowl) - kEarHalfThickness, (1.0f - out) * 0.022f, 0.003f);
    const float rim =
        std::sqrt(std::pow((out - 0.92f) * 0.022f, 2.0f) + std::pow(p.z - bowl - 0.0008f, 2.0f)) - 0.0027f;
    return smoothUnion(plate, rim, 0.003f);
}

void addBust(Lab& lab) {
    const glm::vec3 foot = kBust + glm::vec3(0, kPedestal, 0);
    ShapeBuilder pedestal(lab.m.wall);
    pedestal.setTransform(placed(kBust, 0.3f));
    constexpr unsigned kStanding = ShapeBuilder::kAll & ~ShapeBuilder::kBottom;
    pedestal.box({-0.27f, 0, -0.20f}, {0.27f, 0.07f, 0.20f}, kStanding);
    pedestal.box({-0.23f, 0.07f, -0.16f}, {0.23f, kPedestal, 0.16f}, kStanding);
    // The cut below the shoulders is 2 mm inside the pedestal.
    const glm::mat4 bust = placed(foot + glm::vec3(0, 0.205f * kBustScale - 0.002f, 0), 0.38f, kBustScale);
    const Bounds headBox{{-0.165f, -0.215f, -0.125f}, {0.165f, 0.205f, 0.135f}};
    const Bounds earBox{{-0.016f, -0.037f, -0.013f}, {0.042f, 0.037f, 0.007f}};
    std::vector<Primitive> parts{pedestal.take(), surfaceOf(headField, headBox, 0.0055f, lab.m.skin, bust)};
    for (const float side : {-1.0f, 1.0f}) {
        // Built as two rotations, not as a mirror image, which would turn it inside out.
        const SolidField ear = [side](const glm::vec3& p) { return earField({side * p.x, p.y, p.z}); };
        const Bounds box = side > 0.0f ? earBox
                                       : Bounds{{-earBox.max.x, earBox.min.y, earBox.min.z},
                                                {-earBox.min.x, earBox.max.y, earBox.max.z}};
        const glm::mat4 at =
            glm::rotate(placed({0.066f * side, 0.052f, -0.012f}, 0.62f * side), 0.12f, glm::vec3(1, 0, 0));
        parts.push_back(surfaceOf(ear, box, 0.0017f, lab.m.skin, bust * at));
    }
    lab.place("bust", std::move(parts));
}

// A blade that rises from its stalk and bows; across it a shallow V.
void addLeaf(ShapeBuilder& leaves, const glm::vec3& root, float turn, float rise, float length) {
    const glm::vec3 out(std::cos(turn), 0, std::sin(turn)), side(-out.z, 0, out.x);
    const auto blade = [=](float u, float v) {  // v = 1 at the root
        const float t = 1.0f - v, s = 2.0f * u - 1.0f;
        const float width = 0.30f * length *
                            std::pow(std::sin(3.14159265f * (0.04f + 0.93f * std::pow(std::max(t, 0.0f), 0.8f))), 0.8f);
        const glm::vec3 spine =
            root + out * (length * t * (0.9f - 0.25f * t)) + glm::vec3(0, length * (rise * t - 0.75f * t * t), 0);
        return spine + side * (width * s) +
               glm::vec3(0, 0.25f * width * std::abs(s) + 0.012f * std::sin(14.0f * t + 2.0f * s), 0);
    };
    leaves.sheet(blade, 8, 18, 1.0f, 1.0f);
}

void addPlant(Lab& lab) {
    Random random(31);
    ShapeBuilder pot(lab.m.clay), soil(lab.m.soil), stalks(lab.m.leaf), leaves(lab.m.leaf), stool(lab.m.wood);
    addTable(stool, kPlant, 0.24f, 0.24f, 0.34f);
    const glm::vec3 base = kPlant + glm::vec3(0, 0.34f, 0);
    pot.setTransform(placed(base));
    const glm::vec2 profile[] = {{0.0f, 0.0f},    {0.105f, 0.0f},  {0.15f, 0.22f}, {0.165f, 0.22f},
                                 {0.165f, 0.26f}, {0.145f, 0.26f}, {0.135f, 0.20f}};
    pot.lathe(profile, 36);
    soil.setTransform(placed(base));
    const glm::vec2 disc[] = {{0.14f, 0.225f}, {0.0f, 0.235f}};
    soil.lathe(disc, 36);
    constexpr int kLeaves = 17;
    for (int i = 0; i < kLeaves; ++i) {
        const float t = static_cast<float>(i) / (kLeaves - 1), turn = 2.39996f * static_cast<float>(i) + 0.4f;
        const glm::vec3 out(std::cos(turn), 0, std::sin(turn));
        const glm::vec3 foot = base + glm::vec3(0, 0.225f, 0) + 0.045f * random.unit() * out;
        const glm::vec3 tip = foot + (0.10f + 0.10f * (1.0f - t)) * out + glm::vec3(0, 0.12f + 0.46f * t, 0);
        const glm::vec3 path[] = {foot, glm::mix(foot, tip, 0.4f) + glm::vec3(0, 0.06f, 0),
                                  glm::mix(foot, tip, 0.75f) + glm::vec3(0, 0.05f, 0), tip};
        const float radii[] = {0.0065f, 0.005f, 0.004f, 0.0025f};
        stalks.branch(path, radii, 8);
        addLeaf(leaves, tip, turn, glm::mix(0.35f, 1.05f, t), random.between(0.34f, 0.44f) * (1.0f - 0.2f * t));
    }
    lab.place("plant", {stool.take(), pot.take(), soil.take(), stalks.take(), leaves.take()});
}

}  // namespace

void addLiving(Lab& lab) {
    addBust(lab);
    addPlant(lab);
}

}  // namespace gnomon::renderer::lab
