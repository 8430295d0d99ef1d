#pragma once
// The bias lab, in parts: everything that is known to break shadowmaps, as stations on one floor. Lab space: x to the
// right, y up, z towards the default camera, y = 0 on the lab's floor, metres.
//
// The lab stands at kOrigin, 5.8 km from the origin of the world. There a float's step is 0.5 mm. Meshes keep their
// lab-space vertices, and every instance has the same exact transform. So plates of 1 mm are 1 mm thick to the
// micrometre, and whoever computes in world-space floats goes wrong.

#include "scene/builtin/shapes.h"

namespace gnomon::renderer::lab {

inline constexpr glm::vec3 kOrigin{4096.0f, 0.0f, -4096.0f};

inline constexpr float kWallZ = -3.2f, kWallX = -5.7f;  // the faces of the back and the left wall
inline constexpr float kMat = 0.005f;                   // thickness of the mats that stations stand on

// Places of the stations on the floor.
inline constexpr glm::vec3 kCurtain{-4.2f, 0, -1.9f}, kBust{-1.95f, 0, -1.7f}, kPlant{0.0f, 0, -2.1f},
    kPlates{2.0f, 0, -1.35f}, kRamps{4.45f, 0, -1.7f};
inline constexpr glm::vec3 kSheets{-3.3f, 0, 0.75f}, kContacts{-1.25f, 0, 0.95f}, kLaceCloth{0.75f, 0, 0.95f},
    kSand{2.8f, 0, 0.95f};
inline constexpr float kPedestal = 1.05f, kTable = 0.6f, kSandLevel = 0.10f;

struct Materials {
    std::uint32_t floor, ground, wall, mat, wood, white, steel, black, glow, accent, sand, clay, soil;
    std::uint32_t lace, paper, banner;  // double-sided
    std::uint32_t skin, leaf;           // subsurface
};

struct Lab {
    SceneBuilder builder{"bias-lab"};
    Materials m{};

    // Lab-space geometry, one mesh.
    void place(const char* name, ShapeBuilder& shape) { builder.place(name, shape, placed(kOrigin)); }
    void place(const char* name, std::vector<Primitive> primitives) {
        builder.place(builder.mesh(name, std::move(primitives)), placed(kOrigin));
    }
};

void addReliefs(Lab& lab);   // bias_lab_reliefs.cpp: sand, grazing planes, thin plates
void addCloths(Lab& lab);    // bias_lab_cloths.cpp: lace, and sheets without thickness
void addContacts(Lab& lab);  // bias_lab_contacts.cpp: balls, a chain, a cup, a foot
void addLiving(Lab& lab);    // bias_lab_living.cpp: what light shines through
void addLights(Lab& lab);    // bias_lab_lights.cpp: with their lamps

// A table of four legs; its top is `height` above the floor.
void addTable(ShapeBuilder& wood, const glm::vec3& foot, float halfX, float halfZ, float height);
// A slab that lies on the floor.
void addMat(Lab& lab, const glm::vec3& middle, float halfX, float halfZ);

Image paintGrid(std::uint32_t size);  // bias_lab_textures.cpp: 1 m of floor with lines every 25 cm
Image paintLace(std::uint32_t size);  // alpha; repeats
Image paintLeaf(std::uint32_t size);  // midrib along v

}  // namespace gnomon::renderer::lab
