#pragma once
// Towns, rooms and skies for tests: plain triangles, one mesh per part.

#include "scene/random.h"
#include "scene/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::renderer::cities {

inline Primitive& add(Scene& scene, const char* name, std::vector<glm::vec3> positions,
                      std::vector<std::uint32_t> indices) {
    if (scene.materials.empty()) scene.materials.emplace_back();
    Primitive p;
    for (const glm::vec3& v : positions) p.bounds.add(v);
    p.positions = std::move(positions);
    p.indices = std::move(indices);
    scene.instances.push_back({name, static_cast<std::uint32_t>(scene.meshes.size()), glm::dmat4(1.0)});
    scene.meshes.push_back({name, {std::move(p)}});
    return scene.meshes.back().primitives.back();
}

// Counter-clockwise as seen from its front.
inline void quad(Primitive& p, const std::array<glm::vec3, 4>& corners) {
    const auto first = static_cast<std::uint32_t>(p.positions.size());
    for (const glm::vec3& v : corners) {
        p.positions.push_back(v);
        p.bounds.add(v);
    }
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) p.indices.push_back(first + i);
}

// Outward; `open` lacks its floor and its front, as a doll's house.
inline void box(Primitive& p, const glm::vec3& a, const glm::vec3& b, bool open = false) {
    quad(p, {{{a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {a.x, b.y, a.z}}});
    quad(p, {{{b.x, a.y, b.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}}});
    quad(p, {{{a.x, b.y, a.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}}});
    quad(p, {{{b.x, a.y, a.z}, {a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z}}});
    if (open) return;
    quad(p, {{{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z}}});
    quad(p, {{{a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}}});
}

// 550 wide: blocks of 24 parted by streets, on a ground.
inline Scene city(bool open = false, float street = 6.0f, bool ground = true) {
    constexpr float kWide = 550.0f, kBlock = 24.0f;
    Scene scene;
    Random random(11);
    Primitive& blocks = add(scene, "blocks", {}, {});
    for (float x = 0.0f; x + kBlock <= kWide; x += kBlock + street)
        for (float z = 0.0f; z + kBlock <= kWide; z += kBlock + street)
            box(blocks, {x, 0, z}, {x + kBlock, random.between(8.0f, 60.0f), z + kBlock}, open);
    if (ground) quad(add(scene, "ground", {}, {}), {{{0, 0, kWide}, {kWide, 0, kWide}, {kWide, 0, 0}, {0, 0, 0}}});
    return scene;
}

inline void forEachPrimitive(Scene& scene, const std::function<void(Primitive&)>& work) {
    for (Mesh& mesh : scene.meshes)
        for (Primitive& p : mesh.primitives) work(p);
}

// Every `each`-th triangle, from the first on.
inline Scene turned(Scene scene, std::size_t each = 1) {
    forEachPrimitive(scene, [&](Primitive& p) {
        for (std::size_t i = 0; i + 2 < p.indices.size(); i += 3 * each) std::swap(p.indices[i], p.indices[i + 1]);
    });
    return scene;
}

inline Scene moved(Scene scene, const glm::dmat4& by) {
    for (Instance& instance : scene.instances) instance.worldFromObject = by * instance.worldFromObject;
    return scene;
}

inline Scene scaled(Scene scene, double by) {
    return moved(std::move(scene), glm::scale(glm::dmat4(1.0), glm::dvec3(by)));
}

// Z up, as many tools have it.
inline Scene tipped(Scene scene) {
    return moved(std::move(scene), glm::rotate(glm::dmat4(1.0), 1.5707963267948966, glm::dvec3(1, 0, 0)));
}

inline Scene withDoubleSides(Scene scene) {
    for (Material& material : scene.materials) material.doubleSided = true;
    return scene;
}

inline Scene withTriangleAt(Scene scene, const glm::vec3& at) {
    add(scene, "parked", {at, at + glm::vec3(1, 0, 0), at + glm::vec3(0, 0, 1)}, {0, 2, 1});
    return scene;
}

// A ball of 2048 triangles; seen from within, its fronts show.
inline Scene withSky(Scene scene, const glm::vec3& centre, float radius, bool inward = true) {
    constexpr std::uint32_t kRings = 32, kSides = 32;
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> indices;
    for (std::uint32_t ring = 0; ring <= kRings; ++ring)
        for (std::uint32_t side = 0; side <= kSides; ++side) {
            const float polar = 3.14159265f * static_cast<float>(ring) / kRings,
                        turn = 6.28318531f * static_cast<float>(side) / kSides;
            positions.push_back(centre + radius * glm::vec3(std::sin(polar) * std::cos(turn), std::cos(polar),
                                                            std::sin(polar) * std::sin(turn)));
        }
    for (std::uint32_t ring = 0; ring < kRings; ++ring)
        for (std::uint32_t side = 0; side < kSides; ++side) {
            const std::uint32_t a = ring * (kSides + 1) + side, b = a + kSides + 1;
            for (const std::uint32_t i : {a, a + 1, b, b, a + 1, b + 1}) indices.push_back(i);  // outward
        }
    if (inward) std::ranges::reverse(indices);
    add(scene, "sky", std::move(positions), std::move(indices));
    return scene;
}

}  // namespace gnomon::renderer::cities
