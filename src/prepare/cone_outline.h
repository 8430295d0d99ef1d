#pragma once
// Straight lines on the image plane that bound a spherical sector's image.

#include "prepare/light_volume.h"
#include "prepare/screen_bounds.h"

namespace gnomon::prepare {

/// a * u + b * v <= c holds for every visible point of the volume.
struct HalfPlane {
    float a = 0, b = 0, c = 0;
};

struct ConeOutline {
    static constexpr int kMaxHalfPlanes = 6;
    // Bounding rectangle of the image; infinite where unknown.
    double uLow = 0, uHigh = 0, vLow = 0, vHigh = 0;
    HalfPlane halfPlanes[kMaxHalfPlanes];  // the oblique ones
    int count = 0;
};

/// `volume` is a spot's, already flipped into the grid's coordinates.
ConeOutline outlineOfCone(const ScreenGrid& grid, const LightVolume& volume) noexcept;

}  // namespace gnomon::prepare
