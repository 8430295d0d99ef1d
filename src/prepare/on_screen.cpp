#include "prepare/on_screen.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gnomon::prepare {
namespace {

struct Sphere {
    double distance;  // of the centre from the eye
    double radius;
};

// Around what the light reaches: for a spot of up to 60 degrees, around its cone with its round cap.
Sphere reachOf(const VisibleLight& light) {
    const double range = light.gpu.rangeMetres, cosine = light.gpu.cosOuter;
    if (!light.volume.spot || cosine < 0.5) return {light.volume.distance, range};
    const double radius = range / (2.0 * cosine);
    const Vec3 axis = {light.gpu.directionVs.x, light.gpu.directionVs.y, light.gpu.directionVs.z};
    return {length(light.volume.apexVs + axis * radius), radius};
}

// Pixels across of a sphere. From within, a sphere fills the view: the eye is taken to be no nearer to the centre than
// half a radius.
float diameterPx(const Sphere& sphere, const ViewCamera& camera, double pxPerUnit) {
    const double metres = 2.0 * sphere.radius;
    if (camera.orthographic) return static_cast<float>(metres * pxPerUnit);
    const double nearest = std::max(sphere.distance, 0.5 * sphere.radius);
    return nearest > 0.0 ? static_cast<float>(metres * pxPerUnit / nearest) : 0.0f;
}

}  // namespace

LightOnScreen measure(const VisibleLight& light, const ViewCamera& camera, float share) noexcept {
    LightOnScreen out;
    out.light = light.hostIndex;
    out.casts = light.casts;
    out.filter = light.filter;
    out.pcssPreset = light.pcssPreset;
    out.screenShare = share;
    // Pixels per view xy: at depth 1 if perspective, anywhere if orthographic.
    const double pxPerUnit = 1.0 / std::abs(camera.xyScale[1]);
    if (light.directional) {
        out.type = LightType::Directional;
        out.reachDiameterPx = std::numeric_limits<float>::infinity();
        if (!camera.orthographic) out.sourceDiameterPx = static_cast<float>(2.0 * light.shadowSourceRadius * pxPerUnit);
        out.farthestMetres = std::numeric_limits<float>::infinity();
        return out;
    }
    out.type = light.volume.spot ? LightType::Spot : LightType::Point;
    const Sphere reach = reachOf(light);
    out.reachDiameterPx = diameterPx(reach, camera, pxPerUnit);
    out.sourceDiameterPx = diameterPx({light.volume.distance, light.gpu.sourceRadius}, camera, pxPerUnit);
    out.nearestMetres = static_cast<float>(std::max(light.depth.nearest, 0.0));
    out.farthestMetres = static_cast<float>(light.depth.farthest);
    return out;
}

}  // namespace gnomon::prepare
