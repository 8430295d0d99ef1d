// What stands and hangs in the courtyard: the fountain, stalls with draped awnings, banners, benches, crates, plants.

#include "scene/builtin/courtyard.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::renderer::courtyard {
namespace {

// Eight arcs of water from the bowl into the basin.
void addJets(ShapeBuilder& jets) {
    for (int i = 0; i < 8; ++i) {
        const float angle = 0.785398f * (static_cast<float>(i) + 0.5f);
        glm::vec3 path[9];
        for (int k = 0; k < 9; ++k) {
            const float t = static_cast<float>(k) / 8.0f, r = 0.95f + 0.5f * t;
            path[k] = {r * std::cos(angle), 1.9f + 0.25f * t - 1.4f * t * t, r * std::sin(angle)};
        }
        jets.tube(path, 0.014f, 5);
    }
}

void addFountain(Parts& parts) {
    ShapeBuilder steps(parts.materials.stone), basin(parts.materials.trim), water(parts.materials.water);
    ShapeBuilder figure(parts.materials.bronze), jets(parts.materials.spray);
    const glm::vec2 stepProfile[] = {{3.1f, -0.02f}, {3.1f, 0.16f}, {2.65f, 0.16f}, {2.65f, 0.32f}, {1.5f, 0.32f}};
    steps.lathe(stepProfile, 8, true);
    const glm::vec2 basinProfile[] = {{2.28f, 0.30f}, {2.28f, 0.38f}, {2.15f, 0.44f}, {2.1f, 0.50f},
                                      {2.1f, 0.80f},  {2.16f, 0.85f}, {2.25f, 0.88f}, {2.25f, 0.97f},
                                      {1.82f, 0.97f}, {1.82f, 0.40f}, {0.2f, 0.40f}};
    basin.lathe(basinProfile, 16, true);
    const glm::vec2 bowl[] = {{0.46f, 0.38f}, {0.46f, 0.56f}, {0.36f, 0.62f}, {0.26f, 0.74f},
                              {0.22f, 1.0f},  {0.28f, 1.2f},  {0.22f, 1.34f}, {0.28f, 1.42f},
                              {0.62f, 1.52f}, {0.9f, 1.68f},  {1.0f, 1.86f},  {1.03f, 1.92f},
                              {0.97f, 1.94f}, {0.84f, 1.78f}, {0.5f, 1.70f},  {0.1f, 1.69f}};
    basin.lathe(bowl, 32);
    const glm::vec2 turnedFigure[] = {{0.24f, 1.66f}, {0.24f, 1.92f}, {0.17f, 1.98f}, {0.13f, 2.08f}, {0.17f, 2.25f},
                                      {0.21f, 2.42f}, {0.17f, 2.60f}, {0.12f, 2.72f}, {0.16f, 2.86f}, {0.2f, 2.98f},
                                      {0.16f, 3.08f}, {0.06f, 3.14f}, {0.05f, 3.19f}, {0.09f, 3.25f}, {0.11f, 3.33f},
                                      {0.09f, 3.41f}, {0.03f, 3.47f}, {0.0f, 3.58f}};
    figure.lathe(turnedFigure, 20);
    for (const auto& [radius, height] : {std::pair{1.83f, 0.80f}, std::pair{0.9f, 1.84f}}) {
        const glm::vec2 disc[] = {{radius, height}, {0.0f, height}};
        water.lathe(disc, 32);
    }
    addJets(jets);
    std::vector<Primitive> all;
    for (ShapeBuilder* shape : {&steps, &basin, &water, &figure, &jets}) all.push_back(shape->take());
    parts.builder.place(parts.builder.mesh("fountain", std::move(all)), glm::mat4(1.0f));
}

// A draped cloth over a frame of poles: rear edge high, front edge low with a scalloped valance.
std::uint32_t awningMesh(Parts& parts, std::uint32_t cloth, float width, float depth, float rearHeight,
                         float frontHeight, bool rearPoles) {
    ShapeBuilder sheet(cloth), poles(parts.materials.darkWood);
    const auto roof = [=](float u, float v) {
        const float sag = 0.16f * std::sin(3.14159265f * v) * (1.0f + 0.35f * std::cos(6.2831853f * 2.0f * u));
        return glm::vec3(width * (u - 0.5f), rearHeight + (frontHeight - rearHeight) * v - sag, depth * v);
    };
    sheet.sheet(roof, 24, 12, width, depth);
    sheet.sheet(
        [=](float u, float v) {
            const float scallop = 0.2f + 0.08f * std::abs(std::sin(3.14159265f * 6.0f * u));
            return glm::vec3(width * (u - 0.5f), frontHeight - scallop * v, depth + 0.03f * std::sin(25.0f * u) * v);
        },
        36, 2, width, 0.28f);
    const float half = 0.5f * width - 0.03f;
    for (const float x : {-half, half}) {
        const glm::vec3 front[] = {{x, -0.02f, depth - 0.03f}, {x, frontHeight - 0.035f, depth - 0.03f}};
        poles.tube(front, 0.028f, 8);
        const glm::vec3 rear[] = {{x, -0.02f, 0.04f}, {x, rearHeight - 0.06f, 0.04f}};
        if (rearPoles) poles.tube(rear, 0.028f, 8);
    }
    const glm::vec3 bar[] = {{-half, frontHeight - 0.05f, depth - 0.03f}, {half, frontHeight - 0.05f, depth - 0.03f}};
    poles.tube(bar, 0.02f, 6);
    return parts.builder.mesh("awning", {sheet.take(), poles.take()});
}

std::uint32_t tableMesh(Parts& parts) {
    ShapeBuilder table(parts.materials.wood);
    table.box({-1.2f, 0.80f, -0.4f}, {1.2f, 0.85f, 0.4f});
    for (const float x : {-1.1f, 1.1f})
        for (const float z : {-0.32f, 0.32f}) table.box({x - 0.04f, -0.01f, z - 0.04f}, {x + 0.04f, 0.81f, z + 0.04f});
    table.box({-1.1f, 0.2f, -0.03f}, {1.1f, 0.26f, 0.03f});
    return parts.builder.mesh("table", {table.take()});
}

std::uint32_t crateMesh(Parts& parts) {
    ShapeBuilder crate(parts.materials.wood), slats(parts.materials.darkWood);
    crate.box({-0.3f, 0.01f, -0.3f}, {0.3f, 0.59f, 0.3f});
    for (const float x : {-0.29f, 0.29f})
        for (const float z : {-0.29f, 0.29f}) slats.box({x - 0.04f, 0.0f, z - 0.04f}, {x + 0.04f, 0.6f, z + 0.04f});
    for (const float y : {0.0f, 0.525f})
        for (const float z : {-0.305f, 0.305f})
            slats.box({-0.26f, y + 0.003f, z - 0.02f}, {0.26f, y + 0.07f, z + 0.02f});
    for (const float y : {0.0f, 0.525f})
        for (const float x : {-0.305f, 0.305f})
            slats.box({x - 0.02f, y + 0.004f, -0.26f}, {x + 0.02f, y + 0.071f, 0.26f});
    return parts.builder.mesh("crate", {crate.take(), slats.take()});
}

std::uint32_t barrelMesh(Parts& parts) {
    ShapeBuilder staves(parts.materials.wood), hoops(parts.materials.iron);
    const glm::vec2 body[] = {{0.24f, 0.0f},  {0.29f, 0.2f},  {0.31f, 0.42f}, {0.29f, 0.64f},
                              {0.24f, 0.84f}, {0.22f, 0.84f}, {0.22f, 0.80f}, {0.0f, 0.80f}};
    staves.lathe(body, 12);
    for (const auto& [y, r] :
         {std::pair{0.1f, 0.272f}, std::pair{0.26f, 0.304f}, std::pair{0.54f, 0.304f}, std::pair{0.70f, 0.282f}}) {
        const glm::vec2 hoop[] = {{r - 0.03f, y}, {r, y}, {r, y + 0.04f}, {r - 0.03f, y + 0.04f}};
        hoops.lathe(hoop, 12);
    }
    return parts.builder.mesh("barrel", {staves.take(), hoops.take()});
}

std::uint32_t benchMesh(Parts& parts) {
    ShapeBuilder seat(parts.materials.wood), legs(parts.materials.trim);
    for (int i = 0; i < 4; ++i) {
        const float z = -0.22f + 0.115f * static_cast<float>(i);
        seat.box({-0.9f, 0.44f, z}, {0.9f, 0.48f, z + 0.095f});
    }
    for (int i = 0; i < 2; ++i) {
        const float y = 0.62f + 0.14f * static_cast<float>(i);
        seat.box({-0.9f, y, -0.27f}, {0.9f, y + 0.1f, -0.235f});
    }
    for (const float x : {-0.65f, 0.65f}) {
        legs.box({x - 0.06f, -0.01f, -0.2f}, {x + 0.06f, 0.445f, 0.2f});
        legs.box({x - 0.03f, 0.1f, -0.24f}, {x + 0.03f, 0.84f, -0.19f});
    }
    return parts.builder.mesh("bench", {seat.take(), legs.take()});
}

// Banners with pointed tails over every other column, hung from a bar at the gallery's edge.
void addBanners(Parts& parts) {
    std::array<std::uint32_t, 4> meshes{};
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        ShapeBuilder cloth(parts.materials.cloth[i]), bar(parts.materials.iron);
        const float phase = 1.7f * static_cast<float>(i);
        cloth.sheet(
            [=](float u, float v) {
                const float tail = 1.35f + 0.25f * (1.0f - std::abs(2.0f * u - 1.0f));
                const float wave = 0.045f * v * std::sin(9.0f * u + 3.0f * v + phase);
                return glm::vec3(0.8f * (u - 0.5f), 4.03f - tail * v, 0.47f + wave);
            },
            12, 14, 0.8f, 1.5f);
        const glm::vec3 ends[] = {{-0.46f, 4.05f, 0.47f}, {0.46f, 4.05f, 0.47f}};
        bar.tube(ends, 0.014f, 6);
        for (const float x : {-0.3f, 0.3f}) bar.box({x - 0.01f, 4.04f, 0.24f}, {x + 0.01f, 4.06f, 0.475f});
        meshes[i] = parts.builder.mesh("banner", {cloth.take(), bar.take()});
    }
    std::size_t next = 0;
    for (const Side& side : parts.sides) {
        for (int bay = 2; bay < side.bays - 1; bay += 2) {
            const glm::vec3 column(-side.halfLength + kBay * static_cast<float>(bay), 0, 0);
            parts.builder.place(meshes[next++ % meshes.size()], side.worldFromSide * placed(column));
        }
    }
}

void addStalls(Parts& parts) {
    SceneBuilder& b = parts.builder;
    const Materials& m = parts.materials;
    const std::uint32_t red = awningMesh(parts, m.cloth[0], 3.0f, 2.3f, 2.75f, 2.3f, true);
    const std::uint32_t blue = awningMesh(parts, m.cloth[1], 3.0f, 2.3f, 2.75f, 2.3f, true);
    const std::uint32_t lean = awningMesh(parts, m.cloth[2], 2.3f, 1.9f, 3.3f, 2.55f, false);
    const std::uint32_t table = tableMesh(parts), crate = crateMesh(parts), barrel = barrelMesh(parts);
    struct Stall {
        std::uint32_t awning;
        glm::vec3 at;
        float turn;
    };
    for (const Stall& stall : {Stall{red, kRedStall, kRedStallTurn}, Stall{blue, kBlueStall, kBlueStallTurn}}) {
        const glm::mat4 frame = placed(stall.at, stall.turn);
        b.place(stall.awning, frame);
        b.place(table, frame * placed({0, 0, 1.2f}));
        b.place(crate, frame * placed({1.0f, 0, 0.45f}, 0.2f));
        b.place(crate, frame * placed({-0.9f, 0, 0.4f}, -0.1f));
        b.place(crate, frame * placed({-0.8f, 0.85f, 1.15f}, 0.4f, 0.5f));
        b.place(barrel, frame * placed({0.75f, 0.85f, 1.2f}, 0.0f, 0.42f));
        b.place(barrel, frame * placed({1.95f, 0, 1.5f}));
    }
    // Two lean-to awnings before bays of the eastern and the southern arcade.
    b.place(lean, parts.sides[2].worldFromSide * placed({-2.6f * 1.0f, 0, 0.34f}));
    b.place(lean, parts.sides[1].worldFromSide * placed({3.9f, 0, 0.34f}));
    const std::array<glm::vec4, 9> crates = {
        glm::vec4(10.9f, 0, -7.2f, 0.3f), {11.5f, 0, -6.5f, 0.9f},  {11.15f, 0.6f, -6.9f, 0.5f},
        {-11.2f, 0, -3.2f, 0.2f},         {-11.3f, 0, -2.4f, 1.2f}, {9.6f, 0, 6.9f, 0.1f},
        {10.3f, 0, 7.3f, 0.7f},           {9.9f, 0.6f, 7.1f, 0.4f}, {-1.2f, 0, -7.6f, 0.5f}};
    for (const glm::vec4& c : crates) b.place(crate, placed(glm::vec3(c), c.w));
    for (const glm::vec3& p : {glm::vec3(10.0f, 0, -7.6f),
                               {11.4f, 0, -5.6f},
                               {-11.5f, 0, -1.5f},
                               {-10.8f, 0, -4.0f},
                               {11.3f, 0, 6.6f},
                               {-0.4f, 0, -7.8f}})
        b.place(barrel, placed(p, p.x));
}

void addBenches(Parts& parts) {
    const std::uint32_t bench = benchMesh(parts);
    for (const glm::vec3& p : kBenches) parts.builder.place(bench, placed(p, std::atan2(-p.x, -p.z)));
}

}  // namespace

void addFurniture(Parts& parts) {
    addFountain(parts);
    addStalls(parts);
    addBanners(parts);
    addBenches(parts);
}

}  // namespace gnomon::renderer::courtyard
