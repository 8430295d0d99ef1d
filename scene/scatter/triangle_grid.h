#pragma once
// World-space triangles of a scene: ray casts and distances for placing lights in free space.
//
// A parked object or a sky dome would leave a grid over all of it with one cell for everything else. So there is a grid
// over the bulk of the scene (scene/bulk.h), and a second one for what reaches beyond.

#include "scene/scatter/triangle_cells.h"

namespace gnomon::renderer {

class TriangleGrid {
public:
    using Triangle = GridTriangle;
    using Hit = GridHit;

    // The scene at rest. Triangles without area are left out. Mirroring instances keep their outward winding.
    explicit TriangleGrid(const Scene& scene);

    [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
    // Of the bulk of the scene. Triangles may reach beyond, or lie there.
    [[nodiscard]] const Bounds& bounds() const { return bounds_; }

    // The nearest hit within (0, reach); `direction` is unit.
    [[nodiscard]] std::optional<Hit> cast(const glm::vec3& origin, const glm::vec3& direction, float reach) const;
    // The same among what touches the bounds: skies are not met.
    [[nodiscard]] std::optional<Hit> castInBulk(const glm::vec3& origin, const glm::vec3& direction, float reach) const;
    [[nodiscard]] bool anythingWithin(const glm::vec3& point, float distance) const;
    // What 14 rays all around meet first, within the bulk.
    struct Sight {
        int rays = 0, fronts = 0, backs = 0;
        // More than a quarter meet the inside of a surface.
        [[nodiscard]] bool isInsideSolid() const { return 4 * backs > rays; }
    };
    [[nodiscard]] Sight sightFrom(const glm::vec3& point) const;
    [[nodiscard]] bool insideSolid(const glm::vec3& point) const { return sightFrom(point).isInsideSolid(); }

private:
    std::vector<Triangle> triangles_;
    Bounds bounds_;
    std::vector<TriangleCells> cells_;
};

}  // namespace gnomon::renderer
