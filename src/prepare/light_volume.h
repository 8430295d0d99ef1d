#pragma once
// The volume that one point or spot light reaches, in view space, and the half-space tests that all culling rests on.

#include "gnomon/scene.h"
#include "prepare/camera.h"
#include "prepare/vec3.h"

namespace gnomon::prepare {

/// A ball, or a spherical sector (ball and cone of the same apex). Widened a little beyond the light itself: no float
/// arithmetic on the GPU may find the light where these bounds say it is not.
struct LightVolume {
    Vec3 apexVs;
    double distance = 0;  // of the apex from the eye
    double range = 0;     // widened
    bool spot = false;
    Vec3 axisVs;          // spot: unit
    double cosOuter = 0;  // spot: of the widened half-angle
    double sinOuter = 0;
    double slack = 0;  // metres added in every direction, on top
};

/// Half-space dot(inward, x) >= offset, with a unit normal.
struct Plane {
    Vec3 inward;
    double offset = 0;
};

struct Frustum {
    Plane planes[6];  // near first
    int count = 0;    // five where the far plane is at infinity
};

Frustum frustumOf(const ViewCamera& camera, double widthPx, double heightPx) noexcept;

LightVolume ballVolume(const ViewCamera& camera, Vec3 positionWs, double rangeMetres) noexcept;
/// Narrows a ball to a sector. `directionWs` has unit length; `cosine` is that of the cone's half-angle.
void narrowToCone(LightVolume& volume, const ViewCamera& camera, Vec3 directionWs, double cosine) noexcept;

/// Largest dot(normal, x) over the volume. The normal has unit length.
double support(const LightVolume& volume, Vec3 normal) noexcept;

/// False only if the volume lies wholly beyond one plane.
bool mayBeVisible(const LightVolume& volume, const Frustum& frustum) noexcept;

/// Range of view depths, rounded outward.
struct DepthRange {
    double nearest = 0, farthest = 0;
};
DepthRange depthRange(const LightVolume& volume) noexcept;

}  // namespace gnomon::prepare
