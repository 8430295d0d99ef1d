#include "scene/builtin/courtyard_lamps.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin/numbers.h"

namespace gnomon::renderer::courtyard {
namespace {

// Four posts, thin rings above and below, a pyramid roof; open to the sides.
void addCage(ShapeBuilder& cage, float low, float high) {
    constexpr float kHalf = 0.1f, kBar = 0.006f;
    for (const float x : {-kHalf, kHalf})
        for (const float z : {-kHalf, kHalf}) cage.box({x - kBar, low - 0.004f, z - kBar}, {x + kBar, high, z + kBar});
    for (const float y : {low, high - 0.05f}) {  // none at the light's own height: it would darken the horizon
        for (const float s : {-kHalf, kHalf}) {
            cage.box({-kHalf, y, s - 0.8f * kBar}, {kHalf, y + 0.012f, s + 0.8f * kBar});
            cage.box({s - 0.8f * kBar, y, -kHalf}, {s + 0.8f * kBar, y + 0.012f, kHalf});
        }
    }
    const glm::vec2 roof[] = {{0.0f, high - 0.005f}, {0.17f, high - 0.005f}, {0.17f, high + 0.012f},
                              {0.06f, high + 0.09f}, {0.03f, high + 0.10f},  {0.0f, high + 0.13f}};
    cage.setTransform(glm::rotate(glm::mat4(1.0f), 0.785398f, glm::vec3(0, 1, 0)));
    cage.lathe(roof, 4, true);
    cage.setTransform(glm::mat4(1.0f));
}

// Flat links along the y axis, alternately turned.
void addChain(ShapeBuilder& chain, float low, float high) {
    const int links = std::max(1, static_cast<int>((high - low) / 0.07f));
    const float step = (high - low) / static_cast<float>(links);
    for (int i = 0; i < links; ++i) {
        chain.setTransform(placed({0, low + step * (static_cast<float>(i) + 0.5f), 0}, (i & 1) != 0 ? 1.5708f : 0.0f));
        const float h = 0.62f * step, w = 0.012f, t = 0.003f;
        chain.box({-w, -h, -t}, {-w + 2 * t, h, t});
        chain.box({w - 2 * t, -h, -t}, {w, h, t});
        chain.box({-w + t, h - 2 * t, -0.9f * t}, {w - t, h - 0.1f * t, 0.9f * t});
    }
    chain.setTransform(glm::mat4(1.0f));
}

}  // namespace

std::uint32_t hangingLantern(Parts& parts, float chainLength) {
    ShapeBuilder iron(parts.materials.iron), bulb(parts.materials.glow);
    addCage(iron, -0.16f, 0.14f);
    addChain(iron, 0.25f, 0.25f + chainLength);
    bulb.sphere({0, 0.1f, 0}, 0.05f, 8, 12);
    return parts.builder.mesh("hanging lantern", {iron.take(), bulb.take()});
}

std::uint32_t standingLantern(Parts& parts, float height, float postRadius) {
    ShapeBuilder iron(parts.materials.iron), flame(parts.materials.glow), foot(parts.materials.trim);
    addCage(iron, -0.16f, 0.2f);
    iron.box({-0.11f, -0.18f, -0.11f}, {0.11f, -0.159f, 0.11f});
    const float bottom = -height;
    const glm::vec2 post[] = {{2.2f * postRadius, bottom + 0.3f}, {postRadius, bottom + 0.42f},
                              {0.8f * postRadius, -0.4f},         {1.6f * postRadius, -0.36f},
                              {0.8f * postRadius, -0.32f},        {2.0f * postRadius, -0.175f}};
    iron.lathe(post, 10);
    const glm::vec2 base[] = {{3.6f * postRadius, bottom - 0.01f},
                              {3.6f * postRadius, bottom + 0.14f},
                              {2.6f * postRadius, bottom + 0.18f},
                              {2.4f * postRadius, bottom + 0.31f},
                              {0.0f, bottom + 0.31f}};
    foot.lathe(base, 8, true);
    const glm::vec2 candle[] = {{0.034f, -0.162f}, {0.034f, -0.09f}, {0.022f, -0.07f}, {0.0f, -0.045f}};
    flame.lathe(candle, 10);
    return parts.builder.mesh("standing lantern", {iron.take(), flame.take(), foot.take()});
}

std::uint32_t paperLantern(Parts& parts, std::uint32_t paper, float cordLength) {
    ShapeBuilder shade(paper), frame(parts.materials.iron);
    shade.sheet(
        [](float u, float v) {
            const float a = kTau * u, y = 0.26f - 0.52f * v, bulge = 1.0f - (y / 0.3f) * (y / 0.3f);
            const float r = 0.13f + 0.13f * bulge + 0.004f * std::cos(kTau * 9.0f * v);
            return glm::vec3(r * std::sin(a), y, r * std::cos(a));
        },
        20, 18, 1.0f, 0.5f);
    const glm::vec3 cord[] = {{0, 0.27f, 0}, {0, 0.27f + cordLength, 0}};
    frame.tube(cord, 0.006f, 5);
    const glm::vec3 bar[] = {{-0.15f, 0.262f, 0}, {0.15f, 0.262f, 0}};
    frame.tube(bar, 0.006f, 5);
    return parts.builder.mesh("paper lantern", {shade.take(), frame.take()});
}

std::uint32_t piercedDrum(Parts& parts) {
    constexpr float kRadius = 0.21f, kHalf = 0.22f;
    ShapeBuilder drum(parts.materials.pierced), rims(parts.materials.iron);
    drum.sheet(
        [](float u, float v) {
            const float a = kTau * u;
            return glm::vec3(kRadius * std::sin(a), kHalf * (1.0f - 2.0f * v), kRadius * std::cos(a));
        },
        36, 1, 3.0f, 1.0f);
    for (const float y : {-kHalf, kHalf}) {
        drum.sheet(
            [y](float u, float v) {
                const float a = (y > 0.0f ? -kTau : kTau) * u, r = kRadius * (0.12f + 0.88f * v);
                return glm::vec3(r * std::sin(a), y * (1.3f - 0.3f * v * v), r * std::cos(a));
            },
            36, 4, 2.0f, 0.5f);
        const float low = y - 0.008f, high = y + 0.008f;
        const glm::vec2 rim[] = {{kRadius - 0.006f, low},
                                 {kRadius + 0.006f, low},
                                 {kRadius + 0.006f, high},
                                 {kRadius - 0.006f, high},
                                 {kRadius - 0.006f, low}};
        rims.lathe(rim, 24);
    }
    return parts.builder.mesh("pierced drum", {drum.take(), rims.take()});
}

std::uint32_t drumChain(Parts& parts, float length) {
    ShapeBuilder iron(parts.materials.iron), bulb(parts.materials.glow);
    addChain(iron, 0.28f, 0.28f + length);
    iron.sphere({0, 0.28f, 0}, 0.03f, 6, 10);
    bulb.sphere({0, 0.075f, 0}, 0.03f, 8, 12);
    return parts.builder.mesh("drum's chain", {iron.take(), bulb.take()});
}

std::uint32_t thickCandle(Parts& parts) {
    ShapeBuilder dish(parts.materials.clay), wax(parts.materials.candle), flame(parts.materials.glow);
    const glm::vec2 bowl[] = {
        {0.06f, -0.152f}, {0.085f, -0.125f}, {0.078f, -0.125f}, {0.055f, -0.143f}, {0.0f, -0.143f}};
    dish.lathe(bowl, 14);
    const glm::vec2 body[] = {{0.04f, -0.145f}, {0.04f, -0.085f}, {0.032f, -0.08f}, {0.0f, -0.082f}};
    wax.lathe(body, 14);
    const glm::vec2 tongue[] = {{0.004f, -0.085f}, {0.009f, -0.072f}, {0.006f, -0.055f}, {0.0f, -0.042f}};
    flame.lathe(tongue, 8);
    return parts.builder.mesh("candle", {dish.take(), wax.take(), flame.take()});
}

std::uint32_t wallLamp(Parts& parts) {
    ShapeBuilder iron(parts.materials.iron), bulb(parts.materials.glow);
    iron.box({-0.05f, 0.02f, -0.32f}, {0.05f, 0.22f, -0.28f});
    const glm::vec3 arm[] = {{0, 0.16f, -0.3f}, {0, 0.21f, -0.2f}, {0, 0.22f, -0.1f}, {0, 0.19f, 0}, {0, 0.14f, 0}};
    iron.tube(arm, 0.01f, 6);
    const glm::vec2 hood[] = {{0.125f, 0.04f}, {0.13f, 0.042f}, {0.09f, 0.11f}, {0.04f, 0.145f}, {0.0f, 0.15f}};
    iron.lathe(hood, 16);
    const glm::vec2 inside[] = {{0.0f, 0.13f}, {0.085f, 0.095f}, {0.125f, 0.04f}};
    iron.lathe(inside, 16);
    bulb.sphere({0, 0.075f, 0}, 0.035f, 8, 10);
    return parts.builder.mesh("wall lamp", {iron.take(), bulb.take()});
}

std::uint32_t eavesLamp(Parts& parts) {
    ShapeBuilder body(parts.materials.iron), lens(parts.materials.coolGlow);
    const glm::mat4 backwards = glm::rotate(glm::mat4(1.0f), 1.5707963f, glm::vec3(1, 0, 0));  // y becomes +z: behind
    body.setTransform(backwards);
    const glm::vec2 can[] = {{0.09f, 0.05f}, {0.105f, 0.05f}, {0.11f, 0.25f}, {0.06f, 0.30f}, {0.0f, 0.31f}};
    body.lathe(can, 12);
    lens.setTransform(backwards);
    const glm::vec2 front[] = {{0.0f, 0.055f}, {0.1f, 0.055f}};
    lens.lathe(front, 12);
    body.setTransform(glm::mat4(1.0f));
    body.box({-0.015f, 0.08f, 0.13f}, {0.015f, 0.5f, 0.16f});
    return parts.builder.mesh("eaves lamp", {body.take(), lens.take()});
}

}  // namespace gnomon::renderer::courtyard
