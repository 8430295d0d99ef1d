#pragma once
// Random points of a scene's surfaces, by area.
//
// Triangles are clipped to the bounds of the grid, which are those of the bulk of the scene. So of a sky or of a plate
// to the horizon no more counts than what is there. Where nothing reaches beyond the bounds, nothing is clipped.

#include "scene/random.h"
#include "scene/scatter/triangle_grid.h"

#include <functional>
#include <vector>

namespace gnomon::renderer {

struct SurfacePoint {
    glm::vec3 position;
    std::uint32_t triangle;  // of the grid
    float sizeMetres;        // longest edge of the triangle, or of the clipped piece
};

class SurfaceSampler {
public:
    // Of the triangles whose unit normal `accept` takes.
    SurfaceSampler(const TriangleGrid& grid, const std::function<bool(const glm::vec3&)>& accept);

    [[nodiscard]] bool empty() const { return pieces_.empty(); }
    // Takes four numbers from `random`.
    SurfacePoint point(Random& random) const;

private:
    struct Piece {
        glm::vec3 a, b, c;
        std::uint32_t triangle;
    };
    void addClipped(std::uint32_t triangle, double& sum);
    [[nodiscard]] Piece pieceOf(std::uint32_t index) const;

    const TriangleGrid& grid_;
    std::vector<double> sums_;           // of areas, up to and with each piece
    std::vector<std::uint32_t> pieces_;  // a triangle of the grid, or after these one of clipped_
    std::vector<Piece> clipped_;
};

}  // namespace gnomon::renderer
