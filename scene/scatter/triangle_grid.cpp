#include "scene/scatter/triangle_grid.h"

#include <algorithm>
#include <cmath>

#include "scene/bulk.h"
#include "scene/pose.h"

namespace gnomon::renderer {
namespace {

void addTriangles(const Scene& scene, const glm::mat4& worldFromObject, const Primitive& primitive,
                  const std::vector<glm::vec3>& positions, std::vector<GridTriangle>& triangles) {
    const bool mirrored = turnsWinding(glm::dmat3(glm::mat3(worldFromObject)));
    const auto world = [&](std::uint32_t i) { return glm::vec3(worldFromObject * glm::vec4(positions[i], 1.0f)); };
    const Material& material = scene.materials[primitive.material];
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
        GridTriangle t{world(primitive.indices[i]), world(primitive.indices[i + 1]), world(primitive.indices[i + 2]),
                       material.doubleSided, material.subsurface};
        if (mirrored) std::swap(t.b, t.c);
        const float area = glm::length(t.areaNormal());
        if (area > 0.0f && std::isfinite(area)) triangles.push_back(t);
    }
}

// What is far from the bulk of the scene, or too large to belong to it, has no part in the box.
Bounds bulkBounds(const Scene& scene, const Pose& rest, const Bounds& whole) {
    const std::vector<bool> moves(scene.instances.size(), false);
    const std::vector<Thing> things = thingsOf(scene, rest, moves, false);
    const Bulk bulk(things);
    if (bulk.leftOut() == 0) return whole;
    Bounds box;
    for (const Thing& thing : things)
        bulk.forEachHeld(thing, [&](const WorldTriangle& t) {
            for (const glm::dvec3& p : t) box.add(glm::vec3(p));
        });
    return box.empty() ? whole : box;
}

}  // namespace

TriangleGrid::TriangleGrid(const Scene& scene) {
    const Pose rest = restPose(scene);
    auto posed = rest.deformed.begin();
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        for (const Primitive& primitive : scene.meshes[scene.instances[i].mesh].primitives)
            addTriangles(scene, glm::mat4(rest.worldFromObject[i]), primitive,
                         deforms(scene.instances[i], primitive) ? (posed++)->positions : primitive.positions,
                         triangles_);
    if (triangles_.empty()) return;
    Bounds whole;
    for (const Triangle& t : triangles_)
        for (const glm::vec3& p : {t.a, t.b, t.c}) whole.add(p);
    bounds_ = bulkBounds(scene, rest, whole);
    cells_.emplace_back(triangles_, std::vector<bool>(triangles_.size(), true), bounds_);
    std::vector<bool> beyond;
    for (const Triangle& t : triangles_) beyond.push_back(!isWithin(t.bounds(), bounds_));
    if (std::ranges::find(beyond, true) != beyond.end()) cells_.emplace_back(triangles_, beyond, whole);
}

std::optional<TriangleGrid::Hit> TriangleGrid::cast(const glm::vec3& origin, const glm::vec3& direction,
                                                    float reach) const {
    std::optional<Hit> nearest;
    for (const TriangleCells& cells : cells_) cells.cast(triangles_, origin, direction, reach, nearest);
    return nearest;
}

std::optional<TriangleGrid::Hit> TriangleGrid::castInBulk(const glm::vec3& origin, const glm::vec3& direction,
                                                          float reach) const {
    std::optional<Hit> nearest;
    if (!cells_.empty()) cells_.front().cast(triangles_, origin, direction, reach, nearest);
    return nearest;
}

bool TriangleGrid::anythingWithin(const glm::vec3& point, float distance) const {
    return std::ranges::any_of(
        cells_, [&](const TriangleCells& cells) { return cells.anythingWithin(triangles_, point, distance); });
}

TriangleGrid::Sight TriangleGrid::sightFrom(const glm::vec3& point) const {
    const float reach = 2.5f * bounds_.radius() + glm::length(point - bounds_.centre());
    Sight sight;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z) {
                const int length = x * x + y * y + z * z;
                if (length != 1 && length != 3) continue;  // six axes, eight diagonals
                // A small tilt keeps rays off the edges of axis-aligned geometry.
                const glm::vec3 direction = glm::normalize(glm::vec3(x, y, z) + glm::vec3(0.013f, 0.029f, 0.021f));
                const std::optional<Hit> hit = castInBulk(point, direction, reach);
                ++sight.rays;
                if (hit) ++(hit->backFace ? sight.backs : sight.fronts);
            }
    return sight;
}

}  // namespace gnomon::renderer
