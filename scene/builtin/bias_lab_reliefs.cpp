// Sand, planes that lights graze, and plates from 1 to 20 mm.

#include "scene/builtin/bias_lab.h"
#include "scene/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::renderer::lab {
namespace {

constexpr std::array kThicknesses = {0.001f, 0.002f, 0.005f, 0.010f, 0.020f};  // metres
constexpr unsigned kStanding = ShapeBuilder::kAll & ~ShapeBuilder::kBottom;

// Smooth value noise over a unit lattice, 0 to 1.
float noise(float x, float y, std::uint32_t seed) {
    const float fx = x - std::floor(x), fy = y - std::floor(y);
    const float sx = fx * fx * (3.0f - 2.0f * fx), sy = fy * fy * (3.0f - 2.0f * fy);
    const auto at = [&](int i, int j) {
        return hashUnit(static_cast<std::uint32_t>(static_cast<int>(std::floor(x)) + i + 1024),
                        static_cast<std::uint32_t>(static_cast<int>(std::floor(y)) + j + 1024), seed);
    };
    return glm::mix(glm::mix(at(0, 0), at(1, 0), sx), glm::mix(at(0, 1), at(1, 1), sx), sy);
}

// Metres above the sand's level: a low dune, ripples of 9 cm and 12 mm height that wander, bumps of 3 cm and of 12 mm.
float sandHeight(float x, float z) {
    const float dune = 0.055f * std::exp(-3.0f * ((x - 0.35f) * (x - 0.35f) + 2.0f * (z + 0.1f) * (z + 0.1f)));
    const float bend = 0.7f * noise(2.0f * x, 2.0f * z, 5) + 0.25f * std::sin(3.0f * x);
    const float phase = 70.0f * (z + 0.35f * x) + 5.0f * bend;
    const float ripple = 0.006f * (std::sin(phase) + 0.3f * std::sin(2.0f * phase + 0.8f));
    const float bumps = 0.006f * noise(33.0f * x, 33.0f * z, 7) + 0.003f * noise(80.0f * x, 80.0f * z, 9);
    return dune + ripple + bumps;
}

void addSand(Lab& lab) {
    constexpr float kHalfX = 1.0f, kHalfZ = 0.7f, kFrame = 0.045f, kRim = kSandLevel + 0.045f;
    ShapeBuilder sand(lab.m.sand), frame(lab.m.wood), stones(lab.m.white);
    // One centimetre into the frame: no gap.
    const auto surface = [=](float u, float v) {
        const float x = (2.0f * u - 1.0f) * (kHalfX + 0.01f), z = (2.0f * v - 1.0f) * (kHalfZ + 0.01f);
        return kSand + glm::vec3(x, kSandLevel + sandHeight(x, z), z);
    };
    sand.sheet(surface, 140, 98, 2.0f * kHalfX, 2.0f * kHalfZ);
    lab.place("sand", sand);
    const auto bar = [&](float x0, float z0, float x1, float z1) {
        frame.box(kSand + glm::vec3(x0, 0, z0), kSand + glm::vec3(x1, kRim, z1), kStanding);
    };
    bar(-kHalfX - kFrame, -kHalfZ - kFrame, kHalfX + kFrame, -kHalfZ);
    bar(-kHalfX - kFrame, kHalfZ, kHalfX + kFrame, kHalfZ + kFrame);
    bar(-kHalfX - kFrame, -kHalfZ, -kHalfX, kHalfZ);
    bar(kHalfX, -kHalfZ, kHalfX + kFrame, kHalfZ);
    lab.place("sand tray", frame);
    Random random(17);
    for (int i = 0; i < 26; ++i) {
        const float x = random.between(-0.92f, 0.92f), z = random.between(-0.62f, 0.62f);
        const float radius = 0.006f + 0.024f * std::pow(random.unit(), 3.0f);
        stones.setTransform(
            glm::scale(placed(kSand + glm::vec3(x, kSandLevel + sandHeight(x, z) + 0.35f * radius, z)), glm::vec3(1)));
        stones.sphere({0, 0, 0}, radius, 10, 14);
    }
    lab.place("pebbles", stones);
}

// Wedges whose tops fall away from the sun, which stands 9.2 degrees above the floor: it meets them at 3, 1 and 0.4
// degrees, and leaves the last one in its own shade by 0.6. Pegs of 3 to 12 mm stand on them.
void addRamps(Lab& lab) {
    constexpr float kLength = 1.7f, kWidth = 0.34f, kLow = 0.03f;
    ShapeBuilder ramp(lab.m.white), pegs(lab.m.accent);
    const float degrees[] = {6.2f, 8.2f, 8.8f, 9.8f};
    for (int i = 0; i < 4; ++i) {
        const float slope = glm::radians(degrees[i]), high = kLow + kLength * std::tan(slope);
        const glm::vec3 near = kRamps + glm::vec3(-0.5f * kLength, 0, 0.75f - 0.5f * static_cast<float>(i));
        const glm::vec3 back(0, 0, -kWidth), up(0, kLow, 0), far(kLength, 0, 0), top(0, high, 0);
        ramp.quad(near + up, near + far + top, near + far + top + back, near + up + back);
        ramp.quad(near, near + far, near + far + top, near + up);
        ramp.quad(near + far + back, near + back, near + back + up, near + far + back + top);
        ramp.quad(near + far, near + far + back, near + far + back + top, near + far + top);
        ramp.quad(near + back, near, near + up, near + up + back);
        for (int k = 0; k < 4; ++k) {
            const float along = 0.3f + 0.4f * static_cast<float>(k), peg = 0.003f * static_cast<float>(1 + k);
            const glm::vec3 foot = near + glm::vec3(along, kLow + along * std::tan(slope), -0.5f * kWidth);
            pegs.setTransform(glm::rotate(glm::translate(glm::mat4(1.0f), foot), slope, glm::vec3(0, 0, 1)));
            const glm::vec2 profile[] = {{0.012f, 0.0f}, {0.012f, peg}, {0.0f, peg}};
            pegs.lathe(profile, 20);
        }
    }
    lab.place("ramps", ramp);
    lab.place("pegs", pegs);
}

// Slats between sun and lab, which lay stripes over the floor, and panels of every thickness on the grazed back wall.
void addGrazedWall(Lab& lab) {
    ShapeBuilder slats(lab.m.white), panels(lab.m.accent), battens(lab.m.wood);
    for (int i = 0; i < 6; ++i) {
        slats.setTransform(placed({5.75f, 0, -2.95f + 0.36f * static_cast<float>(i)}));
        slats.box({-0.02f, 0, -0.09f}, {0.02f, 2.2f, 0.09f}, kStanding);
    }
    slats.setTransform(placed({5.75f, 2.2f, -2.05f}));
    slats.box({-0.05f, 0, -1.1f}, {0.05f, 0.06f, 1.1f});
    lab.place("slats", slats);
    for (std::size_t i = 0; i < kThicknesses.size(); ++i) {
        const float x = 1.75f + 0.66f * static_cast<float>(i);
        panels.box({x, 1.1f, kWallZ}, {x + 0.44f, 1.72f, kWallZ + kThicknesses[i]},
                   ShapeBuilder::kAll & ~ShapeBuilder::kBack);
    }
    lab.place("panels", panels);
    battens.box({kWallX, 2.26f, kWallZ}, {5.45f, 2.30f, kWallZ + 0.012f}, ShapeBuilder::kAll & ~ShapeBuilder::kBack);
    battens.box({kWallX, 0.0f, kWallZ}, {5.45f, 0.08f, kWallZ + 0.012f},
                kStanding & ~(ShapeBuilder::kBack | ShapeBuilder::kLeft));
    lab.place("battens", battens);
}

// One plate of each thickness upright, one lying, one leaning; and blocks with gaps of 1, 2, 5 and 10 mm between them.
void addPlates(Lab& lab) {
    ShapeBuilder plates(lab.m.steel), blocks(lab.m.white), stand(lab.m.wood);
    addMat(lab, kPlates, 1.25f, 0.8f);
    const glm::vec3 onMat = kPlates + glm::vec3(0, kMat, 0);
    for (std::size_t i = 0; i < kThicknesses.size(); ++i) {
        const float thick = kThicknesses[i], x = -0.95f + 0.42f * static_cast<float>(i);
        plates.setTransform(placed(onMat + glm::vec3(x, 0, -0.42f), 0.45f));
        plates.box({-0.5f * thick, 0, -0.22f}, {0.5f * thick, 0.5f, 0.22f}, kStanding);
        plates.setTransform(placed(onMat + glm::vec3(x, 0, 0.52f), 0.12f));
        plates.box({-0.15f, 0, -0.1f}, {0.15f, thick, 0.1f}, kStanding);
    }
    // Each leans with its lower edge on the mat and its back 0.1 mm off the rail's edge.
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::mat4 foot = placed(onMat + glm::vec3(0.15f + 0.3f * static_cast<float>(i), 0, 0.18f));
        plates.setTransform(glm::rotate(foot, -0.35f, glm::vec3(1, 0, 0)));
        plates.box({-0.1f, 0, 0}, {0.1f, 0.32f, kThicknesses[i]});
    }
    lab.place("plates", plates);
    stand.box(onMat + glm::vec3(-0.05f, 0.0f, 0.06f), onMat + glm::vec3(0.95f, 0.2f, 0.1069f), kStanding);
    lab.place("rail", stand);
    float x = -1.05f;
    for (const float gap : {0.0f, 0.001f, 0.002f, 0.005f, 0.010f}) {
        x += gap;
        blocks.box(onMat + glm::vec3(x, 0, -0.02f), onMat + glm::vec3(x + 0.12f, 0.22f, 0.06f), kStanding);
        x += 0.12f;
    }
    lab.place("blocks", blocks);
}

}  // namespace

void addReliefs(Lab& lab) {
    addSand(lab);
    addRamps(lab);
    addGrazedWall(lab);
    addPlates(lab);
}

}  // namespace gnomon::renderer::lab
