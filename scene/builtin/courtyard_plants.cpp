// What grows in the courtyard: trees with crowns of leaf cards, orange trees and ferns in pots, ivy on columns, and
// bougainvillea that climbs the arcades and hangs from the gallery. Crowns are shells of cards around the ends of
// branches: most leaves of a real crown hang at its outside too.

#include "scene/builtin/courtyard.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::renderer::courtyard {
namespace {

glm::vec3 anyDirection(Random& random) {
    const float y = random.between(-1.0f, 1.0f), turn = 6.2831853f * random.unit(), r = std::sqrt(1.0f - y * y);
    return {r * std::cos(turn), y, r * std::sin(turn)};
}

// One card that grows from `root` towards `growth`, turned by chance around it.
void addCard(ShapeBuilder& cards, Random& random, const glm::vec3& root, const glm::vec3& growth,
             const glm::vec3& outward, float size) {
    const glm::vec3 up = glm::normalize(growth + 0.35f * anyDirection(random));
    glm::vec3 side = glm::cross(up, outward) + 0.7f * anyDirection(random);
    side = glm::normalize(side - up * glm::dot(side, up));
    cards.card(root, size * up, size * side, outward);
}

struct Crown {
    glm::vec3 centre;
    float radius;
    int cards;
    float size;  // metres, of one card
};

void addCrown(ShapeBuilder& cards, Random& random, const Crown& crown) {
    for (int i = 0; i < crown.cards; ++i) {
        const glm::vec3 out = anyDirection(random);
        if (out.y < -0.75f) continue;  // open below: the branch comes in there
        const float depth = 0.35f + 0.65f * std::sqrt(random.unit());
        const glm::vec3 root =
            crown.centre + out * glm::vec3(1.0f, 0.8f, 1.0f) * (depth * crown.radius - 0.5f * crown.size);
        addCard(cards, random, root, out + glm::vec3(0, 0.35f, 0), out, crown.size * random.between(0.8f, 1.2f));
    }
}

void addPotBody(ShapeBuilder& pot, ShapeBuilder& soil, float radius, float height) {
    const glm::vec2 profile[] = {{0.62f * radius, 0.0f},           {0.80f * radius, 0.4f * height},
                                 {0.97f * radius, 0.82f * height}, {1.08f * radius, 0.85f * height},
                                 {1.1f * radius, 0.97f * height},  {1.06f * radius, height},
                                 {0.96f * radius, height},         {0.92f * radius, 0.84f * height}};
    pot.lathe(profile, 20);
    const glm::vec2 disc[] = {{0.95f * radius, 0.88f * height}, {0.0f, 0.90f * height}};
    soil.lathe(disc, 20);
}

// Bends from `from` to `to` with some wandering, thinning from `thick` to `thin`.
void addBranch(ShapeBuilder& wood, Random& random, const glm::vec3& from, const glm::vec3& to, float thick, float thin,
               int sides) {
    constexpr int kPoints = 7;
    glm::vec3 path[kPoints];
    float radii[kPoints];
    const float length = glm::length(to - from);
    for (int i = 0; i < kPoints; ++i) {
        const float t = static_cast<float>(i) / (kPoints - 1), middle = 4.0f * t * (1.0f - t);
        // Leaves the trunk sideways first, then turns upwards.
        path[i] = glm::mix(from, to, t) - glm::vec3(0, 0.09f * length * middle, 0);
        if (i > 0 && i + 1 < kPoints) path[i] += 0.035f * length * anyDirection(random);
        radii[i] = glm::mix(thick, thin, std::pow(t, 0.8f));
    }
    wood.branch(path, radii, sides);
}

// A tree of about 5.4 m in a ring of stone, its crown in seven to nine parts.
std::uint32_t courtTreeMesh(Parts& parts, std::uint64_t seed) {
    Random random(seed);
    ShapeBuilder ring(parts.materials.stone), soil(parts.materials.soil), wood(parts.materials.bark),
        leaves(parts.materials.leaves);
    const glm::vec2 profile[] = {{1.22f, -0.02f}, {1.22f, 0.34f}, {1.28f, 0.36f},
                                 {1.28f, 0.46f},  {0.94f, 0.46f}, {0.94f, 0.30f}};
    ring.lathe(profile, 12, true);
    const glm::vec2 disc[] = {{1.0f, 0.34f}, {0.0f, 0.40f}};
    soil.lathe(disc, 12);
    const glm::vec3 fork(0.10f, 2.35f, -0.06f);
    const glm::vec3 trunk[] = {{-0.02f, 0.2f, 0.0f}, {0, 0.42f, 0},       {0.05f, 0.9f, 0.03f},
                               {0.01f, 1.5f, 0.05f}, {0.06f, 2.0f, 0.0f}, fork + 0.12f * glm::vec3(0.1f, 1, 0)};
    const float radii[] = {0.30f, 0.22f, 0.175f, 0.16f, 0.15f, 0.10f};
    wood.branch(trunk, radii, 14);
    const int limbs = 6;
    for (int i = 0; i < limbs; ++i) {
        const float turn = 6.2831853f * (static_cast<float>(i) + 0.5f * random.unit()) / limbs;
        const float reach = random.between(1.15f, 1.6f);
        const glm::vec3 end =
            fork + glm::vec3(reach * std::cos(turn), random.between(0.9f, 1.5f), reach * std::sin(turn));
        addBranch(wood, random, fork - glm::vec3(0, random.between(0.0f, 0.35f), 0), end, 0.085f, 0.025f, 8);
        for (int k = 0; k < 3; ++k)
            addBranch(wood, random, glm::mix(fork, end, 0.55f + 0.12f * static_cast<float>(k)) - glm::vec3(0, 0.05f, 0),
                      end + 0.75f * anyDirection(random) * glm::vec3(1, 0.6f, 1), 0.03f, 0.009f, 5);
        addCrown(leaves, random, {end + glm::vec3(0, 0.15f, 0), random.between(0.85f, 1.0f), 160, 0.46f});
    }
    const glm::vec3 top = fork + glm::vec3(0.05f, 1.9f, 0.1f);
    addBranch(wood, random, fork, top, 0.095f, 0.03f, 8);
    addCrown(leaves, random, {top + glm::vec3(0, 0.2f, 0), 1.15f, 230, 0.46f});
    return parts.builder.mesh("tree", {ring.take(), soil.take(), wood.take(), leaves.take()});
}

std::uint32_t orangeTreeMesh(Parts& parts) {
    Random& random = parts.random;
    ShapeBuilder pot(parts.materials.clay), soil(parts.materials.soil), wood(parts.materials.bark),
        leaves(parts.materials.leaves), fruit(parts.materials.orange);
    addPotBody(pot, soil, 0.40f, 0.62f);
    const glm::vec3 trunk[] = {{0, 0.45f, 0}, {0.03f, 0.9f, 0.02f}, {-0.02f, 1.3f, 0.0f}, {0.02f, 1.75f, 0.02f}};
    const float radii[] = {0.055f, 0.042f, 0.038f, 0.024f};
    wood.branch(trunk, radii, 8);
    const glm::vec3 middle(0.0f, 1.95f, 0.0f);
    for (int i = 0; i < 7; ++i) {
        const glm::vec3 out = glm::normalize(anyDirection(random) + glm::vec3(0, 0.7f, 0));
        addBranch(wood, random, {0.01f, 1.5f + 0.03f * static_cast<float>(i), 0.01f}, middle + 0.48f * out, 0.018f,
                  0.006f, 5);
    }
    addCrown(leaves, random, {middle, 0.72f, 210, 0.34f});
    for (int i = 0; i < 16; ++i) {
        const glm::vec3 out = anyDirection(random) * glm::vec3(1.0f, 0.75f, 1.0f);
        fruit.sphere(middle + 0.64f * out, 0.042f, 8, 10);
    }
    return parts.builder.mesh("orange tree", {pot.take(), soil.take(), wood.take(), leaves.take(), fruit.take()});
}

// Fronds that rise from a pot and bow down.
std::uint32_t fernMesh(Parts& parts) {
    Random& random = parts.random;
    ShapeBuilder pot(parts.materials.clay), soil(parts.materials.soil), fronds(parts.materials.frond);
    addPotBody(pot, soil, 0.24f, 0.38f);
    for (int i = 0; i < 19; ++i) {
        const float turn = 2.39996f * static_cast<float>(i) + random.between(-0.2f, 0.2f);
        const float rise = glm::mix(1.25f, 0.45f, static_cast<float>(i) / 18.0f), length = random.between(0.62f, 0.85f);
        const glm::vec3 out(std::cos(turn), 0, std::sin(turn)), across(-out.z, 0, out.x);
        const auto at = [=](float u, float v) {  // v = 1 at the root
            const float t = 1.0f - v, side = u - 0.5f;
            const float bow = rise - 1.35f * t * t;
            const glm::vec3 spine = glm::vec3(0, 0.30f, 0) + out * (0.05f + length * (t - 0.18f * t * t)) +
                                    glm::vec3(0, length * t * bow, 0);
            return spine + across * (0.36f * length * side) -
                   glm::vec3(0, 0.10f * length * std::abs(side) * (0.3f + t), 0);
        };
        fronds.sheet(at, 2, 6, 1.0f, 1.0f);
    }
    return parts.builder.mesh("fern", {pot.take(), soil.take(), fronds.take()});
}

// Ivy around a lower column and out onto the wall above it, thinning out upwards.
std::uint32_t ivyMesh(Parts& parts) {
    Random& random = parts.random;
    ShapeBuilder cards(parts.materials.ivy);
    for (int i = 0; i < 150; ++i) {
        const float u = random.unit(), y = 0.16f + 4.0f * std::pow(u, 1.35f);
        const float facing = 1.57f + 2.6f * (random.unit() - 0.5f) * (1.0f - 0.35f * u) + 0.7f * std::sin(2.3f * y);
        const bool onWall = y > 2.2f;
        const glm::vec3 out(std::cos(facing), 0.12f, std::sin(facing));
        glm::vec3 root(0.23f * out.x, y, 0.23f * out.z);
        if (onWall) root = {random.between(-0.34f, 0.34f) * (y - 1.4f), y, 0.30f + 0.02f * random.unit()};
        const glm::vec3 outward = onWall ? glm::vec3(0.1f * random.between(-1, 1), 0.15f, 1.0f) : out;
        const glm::vec3 growth(random.between(-0.7f, 0.7f), random.between(-0.2f, 1.0f), 0.25f);
        const float size = random.between(0.22f, 0.36f) * (1.0f - 0.25f * u);
        addCard(cards, random, root + 0.04f * outward, growth, outward, size);
    }
    return parts.builder.mesh("ivy", {cards.take()});
}

// Bougainvillea over one bay's gallery railing: vines that bow outwards from the rail and hang down the wall,
// their blossom in bunches along them.
std::uint32_t hangingBlossomMesh(Parts& parts, std::uint64_t seed) {
    Random random(seed);
    ShapeBuilder blossom(parts.materials.blossom), leaves(parts.materials.ivy), vines(parts.materials.bark);
    constexpr int kVines = 26, kPoints = 9;
    for (int i = 0; i < kVines; ++i) {
        const float across = (static_cast<float>(i) + 0.5f) / kVines * 2.0f - 1.0f, x = 1.12f * across;
        const float drop = random.between(0.5f, 1.75f) * (1.0f - 0.55f * across * across);
        const float lean = random.between(-0.16f, 0.16f), bow = random.between(0.34f, 0.44f);
        glm::vec3 path[kPoints];
        float radii[kPoints];
        for (int k = 0; k < kPoints; ++k) {
            const float t = static_cast<float>(k) / (kPoints - 1);
            const float out = glm::mix(0.05f, bow, std::min(1.0f, 2.0f * t));
            path[k] = {x + lean * t + 0.02f * std::sin(9.0f * t + x), kGallery + 0.93f - (0.5f + drop) * t, out};
            radii[k] = glm::mix(0.006f, 0.003f, t);
        }
        vines.branch(path, radii, 4);
        const int cards = 4 + static_cast<int>(5.0f * drop);
        for (int c = 0; c < cards; ++c) {
            const float t = std::pow((static_cast<float>(c) + random.unit()) / static_cast<float>(cards), 0.9f);
            const auto k = std::min(static_cast<int>(t * (kPoints - 1)), kPoints - 2);
            const glm::vec3 root = glm::mix(path[k], path[k + 1], t * (kPoints - 1) - static_cast<float>(k));
            const glm::vec3 outward(0.4f * random.between(-1, 1), 0.35f, 1.0f);
            const glm::vec3 growth(random.between(-0.7f, 0.7f), random.between(-0.9f, 0.5f) + (t < 0.15f ? 0.5f : 0.0f),
                                   0.35f);
            addCard((c + i) % 3 == 0 ? leaves : blossom, random, root, growth, outward, random.between(0.22f, 0.34f));
        }
    }
    return parts.builder.mesh("hanging blossom", {blossom.take(), leaves.take(), vines.take()});
}

void addClimbers(Parts& parts) {
    SceneBuilder& b = parts.builder;
    const std::uint32_t ivy = ivyMesh(parts), fern = fernMesh(parts);
    const std::uint32_t blossoms[] = {hangingBlossomMesh(parts, 5), hangingBlossomMesh(parts, 11)};
    for (std::size_t s = 0; s < parts.sides.size(); ++s) {
        const Side& side = parts.sides[s];
        for (int bay = 1; bay < side.bays; ++bay) {
            const glm::vec3 column(-side.halfLength + kBay * static_cast<float>(bay), 0, 0);
            const int kind = (bay * 3 + static_cast<int>(s) * 2) % 5;
            if (kind == 0) b.place(ivy, side.worldFromSide * placed(column));
            const glm::vec3 pot = column + glm::vec3(0.0f, kArcadeFloor, -0.72f);
            if (kind <= 1) b.place(fern, side.worldFromSide * placed(pot, 2.0f * column.x));
            const glm::vec3 above = column + glm::vec3(0.35f, kGallery, -0.55f);
            if (kind == 2) b.place(fern, side.worldFromSide * placed(above, column.x, 0.8f));
        }
    }
    struct Hanging {
        std::size_t side, mesh;
        int bay;
    };
    for (const Hanging& h :
         {Hanging{0, 0, 0}, {0, 1, 1}, {0, 0, 5}, {0, 1, 8}, {2, 1, 1}, {2, 0, 4}, {1, 0, 2}, {1, 1, 7}, {3, 0, 4}}) {
        const Side& side = parts.sides[h.side];
        const float x = -side.halfLength + kBay * (static_cast<float>(h.bay) + 0.5f);
        b.place(blossoms[h.mesh], side.worldFromSide * placed({x, 0, 0}));
    }
}

}  // namespace

void addPlants(Parts& parts) {
    SceneBuilder& b = parts.builder;
    const std::uint32_t orange = orangeTreeMesh(parts);
    b.place(courtTreeMesh(parts, 3), placed({8.1f, 0, -4.3f}, 0.4f));
    b.place(courtTreeMesh(parts, 8), placed({7.4f, 0, 4.6f}, 2.1f, 0.88f));
    for (const glm::vec3& p : {glm::vec3(-9.9f, 0, 7.2f), {-8.6f, 0, -4.4f}, {2.6f, 0, 6.9f}, {3.0f, 0, -6.9f}})
        b.place(orange, placed(p, 1.3f * p.x));
    addClimbers(parts);
}

}  // namespace gnomon::renderer::courtyard
