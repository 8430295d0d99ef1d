// Walls, floors, arcades, galleries and roofs of the courtyard. Repeated parts are instances of one bay wide, so that
// every view can cull them; solids overlap by some centimetres where they meet, so that no light leaks and no faces
// coincide.

#include "scene/builtin/courtyard.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::renderer::courtyard {
namespace {

constexpr float kPierHalf = 0.31f;
constexpr int kTilesPerStrip = 7;
constexpr int kTileSides = 4;
constexpr float kTileWidth = 0.325f, kTileLength = 0.57f;

glm::mat4 on(const Side& side, const glm::vec3& position, float turn = 0.0f) {
    return side.worldFromSide * placed(position, turn);
}

void addFloors(Parts& parts) {
    ShapeBuilder court(parts.materials.cobbles);
    const float x = kHalfX + kDepth + 0.4f, z = kHalfZ + kDepth + 0.4f;
    court.quad({-x, 0, z}, {x, 0, z}, {x, 0, -z}, {-x, 0, -z});
    parts.builder.place("court", court);
    for (const Side& side : parts.sides) {
        ShapeBuilder floor(parts.materials.flags);
        floor.mitred({side.halfLength, 0.55f, -kDepth - 0.1f, 0, 0, kArcadeFloor, kArcadeFloor, false});
        parts.builder.place("arcade floor", floor, side.worldFromSide);
        ShapeBuilder slab(parts.materials.trim);
        slab.mitred({side.halfLength, 0.40f, -kDepth - 0.1f, 4.2f, 4.2f, kGallery, kGallery});
        slab.mitred({side.halfLength, 0.33f, 0.1f, 4.1f, 4.1f, 4.22f, 4.22f});
        parts.builder.place("gallery slab", slab, side.worldFromSide);
        ShapeBuilder wall(parts.materials.plaster);
        wall.mitred({side.halfLength, -kDepth, -kDepth - 0.4f, -0.2f, -0.2f, 9.0f, 9.0f});
        parts.builder.place("outer wall", wall, side.worldFromSide);
        ShapeBuilder plinth(parts.materials.stone);
        plinth.mitred({side.halfLength, -kDepth + 0.06f, -kDepth - 0.05f, 0.05f, 0.05f, 0.95f, 0.95f, false});
        plinth.mitred({side.halfLength, -kDepth + 0.06f, -kDepth - 0.05f, 3.95f, 3.95f, 4.25f, 4.25f});
        parts.builder.place("plinth", plinth, side.worldFromSide);
    }
}

std::uint32_t lowerColumnMesh(Parts& parts) {
    ShapeBuilder column(parts.materials.trim);
    column.box({-0.29f, kArcadeFloor - 0.02f, -0.29f}, {0.29f, 0.33f, 0.29f},
               ShapeBuilder::kAll & ~ShapeBuilder::kBottom);
    const glm::vec2 profile[] = {{0.28f, 0.33f},   {0.285f, 0.37f},  {0.265f, 0.41f}, {0.225f, 0.43f}, {0.235f, 0.47f},
                                 {0.225f, 0.51f},  {0.2f, 0.53f},    {0.205f, 1.2f},  {0.175f, 2.0f},  {0.175f, 2.02f},
                                 {0.205f, 2.035f}, {0.205f, 2.065f}, {0.175f, 2.08f}, {0.18f, 2.14f},  {0.21f, 2.22f},
                                 {0.27f, 2.29f},   {0.29f, 2.32f}};
    column.lathe(profile, 14);
    column.box({-0.32f, 2.31f, -0.32f}, {0.32f, kSpringing + 0.015f, 0.32f});
    std::vector<Primitive> primitives;
    primitives.push_back(column.take());
    return parts.builder.mesh("column", std::move(primitives));
}

std::uint32_t upperColumnMesh(Parts& parts) {
    ShapeBuilder column(parts.materials.trim);
    const unsigned sides = ShapeBuilder::kAll & ~ShapeBuilder::kBottom;
    column.box({-0.15f, kGallery - 0.02f, -0.15f}, {0.15f, kGallery + 0.14f, 0.15f}, sides);
    const float y = kGallery;
    const glm::vec2 profile[] = {{0.14f, y + 0.14f},  {0.145f, y + 0.17f},  {0.11f, y + 0.20f},  {0.09f, y + 0.22f},
                                 {0.085f, y + 1.62f}, {0.105f, y + 1.635f}, {0.105f, y + 1.66f}, {0.085f, y + 1.675f},
                                 {0.10f, y + 1.75f},  {0.15f, y + 1.82f}};
    column.lathe(profile, 10);
    column.box({-0.17f, y + 1.81f, -0.17f}, {0.17f, kUpperSpringing + 0.01f, 0.17f});
    std::vector<Primitive> primitives;
    primitives.push_back(column.take());
    return parts.builder.mesh("gallery column", std::move(primitives));
}

// Balusters and rails of half a bay: spindles, 3.6 cm thick in the middle.
std::uint32_t railingMesh(Parts& parts) {
    ShapeBuilder railing(parts.materials.iron);
    constexpr int kBalusters = 8;
    const glm::vec2 profile[] = {{0.011f, 0.1f}, {0.018f, 0.46f}, {0.011f, 0.91f}};
    for (int i = 0; i < kBalusters; ++i) {
        const float x = -0.5f * kBay * 0.5f + 0.5f * kBay * (static_cast<float>(i) + 0.5f) / kBalusters;
        railing.setTransform(placed({x, kGallery, 0.0f}));
        railing.lathe(profile, 5);
    }
    railing.setTransform(placed({0, kGallery, 0}));
    railing.box({-0.65f, 0.90f, -0.035f}, {0.65f, 0.95f, 0.035f});
    railing.box({-0.65f, 0.08f, -0.02f}, {0.65f, 0.11f, 0.02f});
    std::vector<Primitive> primitives;
    primitives.push_back(railing.take());
    return parts.builder.mesh("railing", std::move(primitives));
}

void addArcades(Parts& parts) {
    ShapeBuilder lower(parts.materials.stone), upper(parts.materials.trim);
    lower.arch({kBay, kSpringing, 4.25f, 1.05f, 0.5f, 24, 0.16f, 0.05f});
    upper.arch({0.5f * kBay, kUpperSpringing, 7.48f, 0.51f, 0.26f, 18, 0.09f, 0.03f});
    const std::uint32_t lowerArch = parts.builder.mesh("arch", {lower.take()});
    const std::uint32_t upperArch = parts.builder.mesh("gallery arch", {upper.take()});
    const std::uint32_t lowerColumn = lowerColumnMesh(parts), upperColumn = upperColumnMesh(parts);
    const std::uint32_t railing = railingMesh(parts);
    for (const Side& side : parts.sides) {
        for (int bay = 0; bay < side.bays; ++bay) {
            const float left = -side.halfLength + kBay * static_cast<float>(bay);
            parts.builder.place(lowerArch, on(side, {left + 0.5f * kBay, 0, 0}));
            for (int half = 0; half < 2; ++half) {
                const float start = left + 0.5f * kBay * static_cast<float>(half);
                parts.builder.place(upperArch, on(side, {start + 0.25f * kBay, 0, 0}));
                parts.builder.place(railing, on(side, {start + 0.25f * kBay, 0, 0}));
                if (bay + half > 0) parts.builder.place(upperColumn, on(side, {start, 0, 0}));
            }
            if (bay > 0) parts.builder.place(lowerColumn, on(side, {left, 0, 0}));
        }
    }
}

void addPiers(Parts& parts) {
    ShapeBuilder pier(parts.materials.stone);
    pier.box({-kPierHalf - 0.08f, 0.1f, -kPierHalf - 0.08f}, {kPierHalf + 0.08f, 0.5f, kPierHalf + 0.08f});
    pier.box({-kPierHalf, 0.45f, -kPierHalf}, {kPierHalf, 4.3f, kPierHalf});
    pier.box({-kPierHalf - 0.05f, 2.31f, -kPierHalf - 0.05f}, {kPierHalf + 0.05f, 2.475f, kPierHalf + 0.05f});
    pier.box({-0.2f, 4.3f, -0.2f}, {0.2f, 7.46f, 0.2f});
    pier.box({-0.24f, 6.2f, -0.24f}, {0.24f, 6.33f, 0.24f});
    const std::uint32_t mesh = parts.builder.mesh("corner pier", {pier.take()});
    for (const float x : {-kHalfX, kHalfX})
        for (const float z : {-kHalfZ, kHalfZ}) parts.builder.place(mesh, placed({x, 0, z}));
}

// Ceiling beams over the lower arcade, rafters under the roof.
void addBeams(Parts& parts) {
    ShapeBuilder beam(parts.materials.darkWood), rafter(parts.materials.darkWood);
    beam.box({-0.1f, 3.98f, -kDepth - 0.03f}, {0.1f, 4.23f, -0.2f});
    const float angle = std::atan(kRoofSlope);
    // The rafter's frame: origin on the deck's underside over the column line, -z up the slope.
    rafter.setTransform(glm::rotate(placed({0, kEaves + kRoofSlope * kEavesFront, 0}), angle, glm::vec3(1, 0, 0)));
    rafter.box({-0.05f, -0.14f, -3.2f}, {0.05f, 0.02f, 0.4f});
    const std::uint32_t beams = parts.builder.mesh("beam", {beam.take()});
    const std::uint32_t rafters = parts.builder.mesh("rafter", {rafter.take()});
    for (const Side& side : parts.sides) {
        for (int i = 1; i < 2 * side.bays; ++i) {
            const float x = -side.halfLength + 0.5f * kBay * static_cast<float>(i);
            parts.builder.place(beams, on(side, {x, 0, 0}));
            parts.builder.place(rafters, on(side, {x, 0, 0}));
        }
    }
}

// One half-round tile, open below, its upper end at the origin and its course running towards +z and down the slope.
void addTile(ShapeBuilder& strip, const glm::mat4& stripFromTile) {
    strip.setTransform(stripFromTile);
    constexpr float kRadius = 0.5f * kTileWidth;
    const auto outside = [](float u, float v) {
        const float angle = 3.14159265359f * (1.0f - u), radius = kRadius * (0.86f + 0.14f * v);
        return glm::vec3(radius * std::cos(angle), 0.6f * radius * std::sin(angle), kTileLength * v);
    };
    strip.sheet([&](float u, float v) { return outside(u, v); }, kTileSides, 1, 0.42f, kTileLength);
    // The lower end: a face, so that the tile looks solid.
    glm::vec3 rim[kTileSides + 1];
    for (int i = 0; i <= kTileSides; ++i) rim[i] = outside(1.0f - static_cast<float>(i) / kTileSides, 1.0f);
    strip.polygon(rim);
}

void addRoofs(Parts& parts) {
    const float back = -kDepth - 0.1f, rise = kRoofSlope * (kEavesFront - back);
    for (const Side& side : parts.sides) {
        ShapeBuilder deck(parts.materials.darkWood);
        deck.mitred({side.halfLength, kEavesFront, back, kEaves, kEaves + rise, kEaves + kDeck, kEaves + kDeck + rise});
        parts.builder.place("roof deck", deck, side.worldFromSide);
    }
    const float angle = std::atan(kRoofSlope), spacing = 0.53f;  // metres along the slope between courses
    std::array<std::uint32_t, kTilesPerStrip + 1> strips{};
    for (int count = 1; count <= kTilesPerStrip; ++count) {
        ShapeBuilder strip(parts.materials.tiles);
        for (int i = 0; i < count; ++i) {
            // Each course lies 2 cm above the one below it, tilted so that its upper end dives under the next.
            const glm::mat4 course = glm::rotate(glm::mat4(1.0f), angle, glm::vec3(1, 0, 0));
            const glm::mat4 tile = glm::translate(course, glm::vec3(0, 0.005f, spacing * static_cast<float>(i)));
            addTile(strip, glm::rotate(tile, -0.05f, glm::vec3(1, 0, 0)));
        }
        strips[static_cast<std::size_t>(count)] = parts.builder.mesh("roof tiles", {strip.take()});
    }
    const float top = -kDepth - 0.02f, topHeight = kEaves + kDeck + kRoofSlope * (kEavesFront - top);
    for (const Side& side : parts.sides) {
        const int columns = static_cast<int>(2.0f * (side.halfLength + kDepth) / kTileWidth);
        for (int i = 0; i < columns; ++i) {
            const float x = kTileWidth * (static_cast<float>(i) + 0.5f - 0.5f * static_cast<float>(columns));
            const float lowest =
                std::min(kEavesFront + 0.1f, side.halfLength - std::abs(x));  // the valley cuts the strip
            const float slope = (lowest - top) / std::cos(angle);
            const int count = std::min(kTilesPerStrip, static_cast<int>(slope / spacing + 0.35f));
            if (count > 0) parts.builder.place(strips[static_cast<std::size_t>(count)], on(side, {x, topHeight, top}));
        }
    }
}

// A door in a stone frame: jambs, arch, and boards set back from the frame's face.
std::uint32_t doorMesh(Parts& parts) {
    ShapeBuilder frame(parts.materials.trim), boards(parts.materials.wood), iron(parts.materials.iron);
    const float y = kArcadeFloor;
    for (const float x : {-0.6f, 0.6f}) frame.box({x - 0.125f, y - 0.05f, -0.1f}, {x + 0.125f, y + 1.76f, 0.185f});
    frame.arch({1.44f, y + 1.75f, y + 2.55f, 0.48f, 0.36f, 12, 0.0f, 0.0f});
    frame.box({-0.8f, y + 2.53f, -0.1f}, {0.8f, y + 2.65f, 0.22f});
    frame.box({-0.72f, y + 1.75f, -0.1f}, {0.72f, y + 2.54f, 0.18f}, ShapeBuilder::kLeft | ShapeBuilder::kRight);
    boards.box({-0.55f, y - 0.02f, -0.1f}, {0.55f, y + 2.4f, 0.1f});
    for (const float height : {0.45f, 1.55f}) iron.box({-0.44f, y + height, 0.08f}, {0.4f, y + height + 0.06f, 0.115f});
    iron.box({0.3f, y + 0.95f, 0.09f}, {0.34f, y + 1.1f, 0.16f});
    return parts.builder.mesh("door", {frame.take(), boards.take(), iron.take()});
}

void addDoorsAndStairs(Parts& parts) {
    const std::uint32_t door = doorMesh(parts);
    ShapeBuilder step(parts.materials.trim);
    step.box({-1.0f, -0.02f, 0.5f}, {1.0f, 0.08f, 0.9f});
    const std::uint32_t steps = parts.builder.mesh("step", {step.take()});
    for (const Side& side : parts.sides) {
        for (int bay = 1; bay < side.bays - 1; bay += 2) {
            const float x = -side.halfLength + kBay * (static_cast<float>(bay) + 0.5f);
            parts.builder.place(door, on(side, {x, 0, -kDepth}));
            parts.builder.place(door, on(side, {x, kGallery - kArcadeFloor, -kDepth}));
            if (bay % 4 == 1) parts.builder.place(steps, on(side, {x, 0, 0}));
        }
    }
}

}  // namespace

void addArchitecture(Parts& parts) {
    addFloors(parts);
    addArcades(parts);
    addPiers(parts);
    addBeams(parts);
    addRoofs(parts);
    addDoorsAndStairs(parts);
}

}  // namespace gnomon::renderer::courtyard
