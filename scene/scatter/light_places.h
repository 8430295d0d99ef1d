#pragma once
// Where scattered lights hang. Two rules, each with its reasons in light_places.cpp.

#include "scene/random.h"
#include "scene/scatter/surface_sampler.h"
#include "scene/scatter/triangle_grid.h"

#include <optional>

namespace gnomon::renderer {

struct LightPlace {
    glm::vec3 position;
    float freeMetres;    // of air, back to the surface it was thrown from
    glm::vec3 down;      // unit, towards that surface
    bool spotsLookDown;  // a spot there should have that surface in its cone
};

// Unit: off the axis by an angle, to the side that `turn` says; radians. Straight down, x is at 0.
[[nodiscard]] glm::vec3 tilted(const glm::vec3& axis, float angle, float turn);

class LightPlaces {
public:
    explicit LightPlaces(const TriangleGrid& grid);

    // By the shape of the scene, above what looks up. Empty where the scene is too full for that.
    std::optional<LightPlace> overFloors(Random& random) const;
    // By what is around the place alone, no farther than `mostMetres` from its surface.
    std::optional<LightPlace> byRoom(Random& random, float mostMetres) const;
    // Whether a light there, of the kind and range that it has, shines on the front of anything.
    [[nodiscard]] bool shinesOnAnything(const SceneLight& light) const;

    [[nodiscard]] const SurfaceSampler& surfaces() const { return all_; }

private:
    enum class Demand { All, WithinBounds, OutsideSolids, None };
    [[nodiscard]] std::optional<LightPlace> tryRoom(const SurfaceSampler& feet, Random& random, float mostMetres,
                                                    Demand demand) const;
    [[nodiscard]] float roomAround(const glm::vec3& foot, const glm::vec3& up, float otherwise) const;

    const TriangleGrid& grid_;
    SurfaceSampler all_, upward_;
};

}  // namespace gnomon::renderer
