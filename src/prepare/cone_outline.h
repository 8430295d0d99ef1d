#pragma once
// Straight lines on the image plane that bound a spherical sector's image.

#include <limits>

#include "prepare/light_volume.h"
#include "prepare/screen_bounds.h"

namespace gnomon::prepare {

/// a * u + b * v <= c holds for every visible point of the volume.
struct HalfPlane {
    float a, b, c;
};

/// low <= a * u + b * v <= high holds for every visible point of the volume; a is positive.
struct Strip {
    float a, b, low, high;
};

struct ConeOutline {
    static constexpr double kInfinity = std::numeric_limits<double>::infinity();
    // Bounding rectangle of the image; infinite where unknown.
    double uLow = -kInfinity, uHigh = kInfinity, vLow = -kInfinity, vHigh = kInfinity;
    // The oblique lines. Of each array, the first `count` are set.
    int silhouetteCount = 0, stripCount = 0;
    HalfPlane silhouettes[2];
    Strip strips[2];
};

/// `volume` is a spot's, already flipped into the grid's coordinates; `depth` is its range of view depths.
ConeOutline outlineOfCone(const ScreenGrid& grid, const LightVolume& volume, const DepthRange& depth) noexcept;

}  // namespace gnomon::prepare
