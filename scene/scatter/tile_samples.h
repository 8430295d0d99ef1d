#pragma once
// How many shadowed lights reach a shadow tile of a picture. It is estimated on the CPU by ray casts: a few hundred
// tiles, nine pixels each. A light counts where phase 3 of the library would count it: at least one pixel lies in its
// range and cone, and looks towards it or lets light through.

#include "scene/scatter/scatter_lights.h"
#include "scene/scatter/triangle_grid.h"

#include <span>

namespace gnomon::renderer {

class TileSamples {
public:
    TileSamples() = default;
    TileSamples(const TriangleGrid& grid, const TileDensity& view);
    // No tile shows geometry.
    [[nodiscard]] bool empty() const { return tiles_.empty(); }
    [[nodiscard]] float meanShadowed(std::span<const SceneLight> lights) const;

private:
    struct Pixel {
        glm::vec3 position, normal;  // of the face, towards the camera; zero where light comes through
    };
    struct Tile {
        std::vector<Pixel> pixels;
        glm::vec3 centre;
        float radius;  // of a sphere around the pixels
    };
    static bool reaches(const SceneLight& light, const Tile& tile);
    std::vector<Tile> tiles_;
};

}  // namespace gnomon::renderer
