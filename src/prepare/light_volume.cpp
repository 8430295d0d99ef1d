// Light volumes: balls and spherical sectors against half-spaces.
//
// Problem: frustum culling, depth bins and screen bounds each ask how far a light reaches in some direction.
// Plain way: bounding spheres or boxes for everything. A narrow spot then reaches far too wide.
// What we do: one exact function answers all. The *support function* of a convex volume is h(n) = max of dot(n, x) over
// it. For a ball it is n.c + r |n|. For a spherical sector (apex p, axis d, half-angle a <= 90 degrees, radius r) let t
// be the angle between n and d. The farthest point is
//     the ball's own, p + r n,             if t <= a          (it lies on the cap),
//     on the rim, r cos(t - a) away,       if a < t < a + 90  (the rim's nearest point to n),
//     the apex itself,                     beyond.
// cos(t - a) = cos t cos a + sin t sin a: no angle is ever computed. The volume misses a half-space iff h is below its
// offset. So a plane test is exact, and a depth range is two evaluations.
//
// Margins: the GPU tests pixels in float. Positions carry errors of a few 2^-24 of the largest coordinate in play. A
// cone's cosine cannot tell angles nearer than 2^-24 / sin a. Each volume is widened by several times that. At 16 km
// from the origin it is 16 mm.
// Limits: planes are tested one by one. That keeps a volume which misses the frustum only past an edge or a corner. The
// tile masks then find it nowhere.

#include "prepare/light_volume.h"

#include <algorithm>
#include <cmath>

namespace gnomon::prepare {
namespace {

constexpr double kRelativeSlack = 1e-6;  // of the largest coordinate in play: 16 float roundings
constexpr double kAngleSlack = 1e-5;     // radians
constexpr double kCosineSlack = 1e-6;    // of a cone's cosine
constexpr double kDepthRelativeSlack = 1e-5;

}  // namespace

Frustum frustumOf(const ViewCamera& camera, double widthPx, double heightPx) noexcept {
    Frustum frustum;
    frustum.planes[frustum.count++] = {{0, 0, 1}, camera.nearMetres};
    const double extent[2] = {widthPx, heightPx};
    for (int i = 0; i < 2; ++i) {
        const double ends[2] = {camera.xyOffset[i], camera.xyOffset[i] + extent[i] * camera.xyScale[i]};
        const double low = std::min(ends[0], ends[1]), high = std::max(ends[0], ends[1]);
        const Vec3 axis = i == 0 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
        if (camera.orthographic) {
            frustum.planes[frustum.count++] = {axis, low};
            frustum.planes[frustum.count++] = {axis * -1.0, -high};
        } else {
            const Vec3 depth{0, 0, 1};
            frustum.planes[frustum.count++] = {(axis - depth * low) * (1.0 / std::sqrt(1 + low * low)), 0};
            frustum.planes[frustum.count++] = {(depth * high - axis) * (1.0 / std::sqrt(1 + high * high)), 0};
        }
    }
    if (std::isfinite(camera.farMetres)) frustum.planes[frustum.count++] = {{0, 0, -1}, -camera.farMetres};
    return frustum;
}

LightVolume ballVolume(const ViewCamera& camera, Vec3 positionWs, double rangeMetres) noexcept {
    LightVolume volume;
    volume.apexVs = camera.positionVs(positionWs);
    volume.distance = length(volume.apexVs);
    volume.range = rangeMetres;
    const double largest =
        std::max(largestCoordinate(camera.eyeWs), largestCoordinate(positionWs)) + volume.distance + rangeMetres;
    volume.slack = kRelativeSlack * largest;
    return volume;
}

void narrowToCone(LightVolume& volume, const ViewCamera& camera, Vec3 directionWs, double cosine) noexcept {
    volume.spot = true;
    volume.axisVs = camera.directionVs(directionWs);
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    const double widen = kAngleSlack + kCosineSlack / std::max(sine, 1e-3);
    // cos and sin of (angle + widen), for widen of at most 1.01e-3.
    const double widenCosine = std::sqrt(1 - widen * widen);
    volume.cosOuter = cosine * widenCosine - sine * widen;
    volume.sinOuter = sine * widenCosine + cosine * widen;
}

double support(const LightVolume& volume, Vec3 normal) noexcept {
    const double atApex = dot(normal, volume.apexVs) + volume.slack;
    if (!volume.spot) return atApex + volume.range;
    const double along = dot(normal, volume.axisVs);
    if (along >= volume.cosOuter) return atApex + volume.range;
    const double across = std::sqrt(std::max(0.0, 1 - along * along));
    return atApex + volume.range * std::max(0.0, along * volume.cosOuter + across * volume.sinOuter);
}

bool mayBeVisible(const LightVolume& volume, const Frustum& frustum) noexcept {
    for (int i = 0; i < frustum.count; ++i) {
        const Plane& plane = frustum.planes[i];
        // The apex alone is enough, and mostly it is inside.
        if (dot(plane.inward, volume.apexVs) + volume.slack >= plane.offset) continue;
        if (support(volume, plane.inward) < plane.offset) return false;
    }
    return true;
}

DepthRange depthRange(const LightVolume& volume) noexcept {
    const double nearest = -support(volume, {0, 0, -1}), farthest = support(volume, {0, 0, 1});
    return {nearest - kDepthRelativeSlack * std::abs(nearest), farthest + kDepthRelativeSlack * std::abs(farthest)};
}

}  // namespace gnomon::prepare
