// What has no thickness: lace, with holes besides, and sheets and cards.

#include "scene/builtin/bias_lab.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin/numbers.h"

namespace gnomon::renderer::lab {
namespace {

// Hangs in folds from a rod, its hem 3 cm above the floor.
void addCurtain(Lab& lab) {
    constexpr float kHalf = 0.85f, kTop = 2.05f;
    ShapeBuilder lace(lab.m.lace), rod(lab.m.black);
    const auto folds = [=](float u, float v) {
        const float x = (2.0f * u - 1.0f) * kHalf, deep = 0.045f + 0.03f * v;
        const float wave = std::sin(17.0f * u + 0.7f * std::sin(5.0f * u)) + 0.3f * std::sin(31.0f * u + 1.0f);
        return kCurtain + glm::vec3(x + 0.02f * v * std::sin(9.0f * u), kTop - (kTop - 0.03f) * v, deep * wave);
    };
    lace.sheet(folds, 96, 20, 2.4f, 2.0f);
    lab.place("lace curtain", lace);
    const glm::vec3 across[] = {kCurtain + glm::vec3(-1.0f, kTop + 0.016f, 0),
                                kCurtain + glm::vec3(1.0f, kTop + 0.016f, 0)};
    rod.tube(across, 0.012f, 14);
    for (const float x : {-0.93f, 0.93f}) {
        const glm::vec2 post[] = {
            {0.14f, 0.0f}, {0.14f, 0.012f}, {0.016f, 0.02f}, {0.016f, kTop + 0.1f}, {0.0f, kTop + 0.1f}};
        rod.setTransform(placed(kCurtain + glm::vec3(x, 0, 0)));
        rod.lathe(post, 20);
    }
    lab.place("curtain rail", rod);
}

// A round cloth over a round table: 6 mm above its top, which leaves shadowmaps little room, and hanging over its rim.
void addLaceCloth(Lab& lab) {
    constexpr float kRadius = 0.52f, kClothRadius = 0.66f, kAir = 0.006f;
    ShapeBuilder table(lab.m.accent), lace(lab.m.lace), vase(lab.m.white);
    table.setTransform(placed(kLaceCloth));
    const glm::vec2 profile[] = {
        {0.26f, 0.0f},     {0.26f, 0.015f}, {0.035f, 0.04f}, {0.035f, kTable - 0.03f}, {kRadius, kTable - 0.03f},
        {kRadius, kTable}, {0.0f, kTable}};
    table.lathe(profile, 64);
    lab.place("round table", table);
    // Over the top flat, beyond the rim down in folds.
    const auto cloth = [=](float u, float v) {
        const float turn = 2.0f * kPi * u, out = kClothRadius * (0.02f + 0.98f * (1.0f - v));
        const float over = std::max(out - kRadius + 0.01f, 0.0f), drop = over * over / (over + 0.03f);
        const float fold = 1.0f + 0.06f * (over / 0.14f) * std::sin(11.0f * turn);
        const float away = std::min(out, kRadius + 0.004f + 0.25f * over) * fold;
        return kLaceCloth + glm::vec3(away * std::cos(turn), kTable + kAir - drop, away * std::sin(turn));
    };
    const std::size_t first = lace.vertexCount();
    lace.sheet(cloth, 132, 44, 1.0f, 1.0f);
    std::vector<Primitive> primitives{lace.take()};
    Primitive& mesh = primitives.front();
    for (std::size_t i = first; i < mesh.positions.size(); ++i) {  // the pattern as laid flat, not wrapped around
        const auto row = static_cast<float>(i / 133), column = static_cast<float>(i % 133);
        const float out = kClothRadius * (0.02f + 0.98f * (1.0f - row / 44.0f)), turn = 2.0f * kPi * column / 132.0f;
        mesh.texcoords[0][i] = {out * std::cos(turn), out * std::sin(turn)};
    }
    lab.place("lace cloth", std::move(primitives));
    vase.setTransform(placed(kLaceCloth + glm::vec3(-0.12f, kTable + kAir + 0.001f, -0.16f)));
    const glm::vec2 body[] = {{0.0f, 0.0f},     {0.05f, 0.0f},   {0.075f, 0.05f}, {0.082f, 0.10f},
                              {0.06f, 0.17f},   {0.03f, 0.22f},  {0.028f, 0.26f}, {0.04f, 0.285f},
                              {0.036f, 0.285f}, {0.024f, 0.26f}, {0.0f, 0.25f}};
    vase.lathe(body, 40);
    lab.place("vase", vase);
}

// A screen bent like an S that stands on the floor.
void addBanner(Lab& lab) {
    ShapeBuilder banner(lab.m.banner);
    const auto bent = [](float u, float v) {
        const float s = 2.0f * u - 1.0f;
        return kSheets +
               glm::vec3(-1.55f + 0.75f * s, 1.15f * (1.0f - v), -0.2f + 0.28f * std::sin(kPi * s) - 0.25f * s);
    };
    banner.sheet(bent, 48, 1, 1.6f, 1.15f);
    lab.place("banner", banner);
}

// Cards 1, 3 and 10 mm above a table, two that lean against each other, a sheet that curls up from it.
void addCards(Lab& lab) {
    constexpr float kHalfX = 0.65f, kHalfZ = 0.42f;
    ShapeBuilder wood(lab.m.wood), cards(lab.m.paper), bright(lab.m.banner);
    addTable(wood, kSheets, kHalfX, kHalfZ, kTable);
    lab.place("card table", wood);
    const glm::vec3 top = kSheets + glm::vec3(0, kTable, 0);
    const float heights[] = {0.001f, 0.003f, 0.010f};
    for (int i = 0; i < 3; ++i) {
        const float x = 0.02f + 0.21f * static_cast<float>(i);
        cards.setTransform(placed(top + glm::vec3(x, heights[i], 0.22f), 0.15f - 0.12f * static_cast<float>(i)));
        cards.quad({-0.075f, 0, 0.1f}, {0.075f, 0, 0.1f}, {0.075f, 0, -0.1f}, {-0.075f, 0, -0.1f});
    }
    for (const float side : {-1.0f, 1.0f}) {
        cards.setTransform(placed(top + glm::vec3(0.38f, 0, -0.16f), 0.5f));
        cards.quad({0.075f * side, 0, 0.09f}, {0.001f * side, 0.16f, 0.09f}, {0.001f * side, 0.16f, -0.09f},
                   {0.075f * side, 0, -0.09f});
    }
    cards.setTransform(placed(top + glm::vec3(-0.36f, 0.0005f, 0.02f), 0.3f));
    // Flat for 12 cm, half a millimetre above the table, then up in an arc.
    const auto curl = [](float u, float v) {
        const float along = 0.46f * u, over = std::max(along - 0.12f, 0.0f), angle = over / 0.17f;
        return glm::vec3(0.2f - std::min(along, 0.12f) - 0.17f * std::sin(angle), 0.17f * (1.0f - std::cos(angle)),
                         0.34f * (v - 0.5f));
    };
    cards.sheet(curl, 40, 1, 0.46f, 0.34f);
    lab.place("cards", cards);
    bright.setTransform(placed(kSheets + glm::vec3(-0.28f, 0, kHalfZ + 0.24f)));  // leans, 2 mm off the table's edge
    bright.sheet([](float u, float v) { return glm::vec3(0.6f * u - 0.3f, 0.62f * (1.0f - v), -0.246f * (1.0f - v)); },
                 1, 1, 0.6f, 0.67f);
    lab.place("sheet", bright);
}

}  // namespace

void addCloths(Lab& lab) {
    addCurtain(lab);
    addLaceCloth(lab);
    addBanner(lab);
    addCards(lab);
}

}  // namespace gnomon::renderer::lab
