#pragma once
// The courtyard, in parts. Plan: a court of 26.0 by 18.2 m (x by z) whose four sides are arcades of two storeys,
// 3 m deep, in bays of 2.6 m. Each side is built in its own frame: x along the side, +z into the court, z = 0 on the
// line of the columns, y = 0 on the cobbles.

#include "scene/builtin/shapes.h"
#include "scene/random.h"

#include <array>

namespace gnomon::renderer::courtyard {

inline constexpr float kBay = 2.6f;  // metres between columns of the lower arcade; half of it above
inline constexpr float kHalfX = 13.0f, kHalfZ = 9.1f;
inline constexpr float kDepth = 3.0f;         // of the arcades
inline constexpr float kArcadeFloor = 0.15f;  // one step above the court
inline constexpr float kSpringing = 2.45f;    // of the lower arches
inline constexpr float kGallery = 4.4f;       // floor of the upper storey
inline constexpr float kUpperSpringing = 6.3f;
inline constexpr float kEaves = 7.3f;  // underside of the roof deck at its front edge, z = kEavesFront
inline constexpr float kEavesFront = 0.45f;
inline constexpr float kRoofSlope = 0.4f;  // rise per metre away from the court
inline constexpr float kDeck = 0.1f;       // thickness of the roof deck

inline constexpr float kLoopSeconds = 12.0f;  // everything that moves is back where it was after this time

inline constexpr glm::vec3 kRedStall{5.6f, 0, -7.0f};
inline constexpr float kRedStallTurn = -0.15f;
inline constexpr glm::vec3 kBlueStall{-6.2f, 0, -7.2f};
inline constexpr float kBlueStallTurn = 0.1f;
// Around the fountain, each facing it.
inline constexpr std::array<glm::vec3, 4> kBenches = {
    glm::vec3(4.6f, 0, 0), {-4.6f, 0, 0}, {0, 0, 4.7f}, {0, 0, -4.7f}};

// Night: a weak moon, and lanterns that light the court. Day: a low sun, and the same lanterns in its shade.
// Bench: night with more and smaller lights, so that about three shadowed lights reach a tile in the mean.
enum class Hour { Night, Day, Bench };

struct Materials {
    std::uint32_t stone, trim, plaster, cobbles, flags, wood, darkWood, clay, tiles, iron, rope, glow, coolGlow, water,
        spray, bronze;
    std::uint32_t soil, bark, leaves, ivy, blossom, frond, orange, straw, fur, feather, sheetIron, pierced, leather,
        candle;
    std::array<std::uint32_t, 4> cloth;
    std::array<std::uint32_t, 6> wear;  // plain cloth for clothes
    std::array<std::uint32_t, 3> skin, hair, paper;
};

struct Side {
    glm::mat4 worldFromSide;
    float halfLength;
    int bays;
};

struct Parts {
    SceneBuilder builder{"courtyard"};
    Materials materials{};
    std::array<Side, 4> sides;  // north (-z), south, east (+x), west
    Random random{2023};
    Hour hour = Hour::Night;
};

void addArchitecture(Parts& parts);  // courtyard_architecture.cpp
void addFurniture(Parts& parts);     // courtyard_furniture.cpp
void addPlants(Parts& parts);        // courtyard_plants.cpp
void addFigures(Parts& parts);       // courtyard_figures.cpp: people, over courtyard_figure.h
void addWildlife(Parts& parts);      // courtyard_wildlife.cpp: what else moves
void addLights(Parts& parts);        // courtyard_lights.cpp: lanterns, festoons, lamps and their lights

}  // namespace gnomon::renderer::courtyard
