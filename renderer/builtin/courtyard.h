#pragma once
// The night courtyard, in parts. Plan: a court of 26.0 by 18.2 m (x by z) whose four sides are arcades of two storeys,
// 3 m deep, in bays of 2.6 m. Each side is built in its own frame: x along the side, +z into the court, z = 0 on the
// line of the columns, y = 0 on the cobbles.

#include "renderer/builtin/random.h"
#include "renderer/builtin/shapes.h"

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

struct Materials {
    std::uint32_t stone, trim, plaster, cobbles, flags, wood, darkWood, clay, tiles, iron, rope, glow, coolGlow, water,
        spray, leaf, bronze;
    std::array<std::uint32_t, 4> cloth;
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
};

void addArchitecture(Parts& parts);  // courtyard_architecture.cpp
void addFurniture(Parts& parts);     // courtyard_furniture.cpp
void addLights(Parts& parts);        // courtyard_lights.cpp: lanterns, festoons, lamps and their lights

}  // namespace gnomon::renderer::courtyard
