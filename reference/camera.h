#pragma once
// The camera, in double precision, by inverse matrices.
//
// Problem: a pixel and its device depth name a point of the world, for every kind of camera that the library accepts:
// perspective or orthographic, standard or reversed depth, finite or infinite far plane, jittered, off-centre, looking
// down its -z or its +z axis.
//
// Source: the specification, Conventions, and gnomon/scene.h. View depth is the positive distance along the view axis.
//
// What: the plain way. Pixel to normalised device coordinates, through the inverse matrices, divided by w. Which way
// the camera looks is found by un-projecting two depths.
//
// Limits: the matrices are taken as they are (floats widened), so a view matrix that is rigid only to 1e-3 is inverted
// as it stands, while the library may take its transpose. Image rows run from the top, and ndc y = -1 is the top row.

#include <cstdint>

#include "gnomon/scene.h"
#include "reference/vector_math.h"

namespace gnomon::reference {

struct CameraModel {
    Mat4 viewFromWorld, worldFromView, clipFromView, viewFromClip, clipFromWorld;
    std::uint32_t widthPx = 0, heightPx = 0;
    bool orthographic = false;
    bool reversed = true;
    double forwardSign = -1;  ///< view depth = forwardSign * z of view space
    double nearDeviceDepth = 1;
    double backgroundDepth = 0;    ///< device depth of background pixels: the far value
    double nearMetres = 0;         ///< view depth of the near plane
    double farMetres = kInfinity;  ///< view depth of the far plane
    double maxSlope = 0;           ///< largest |view x| or |view y| on the screen, at view depth 1 if perspective
    Vec3 eye;                      ///< origin-relative metres
    Vec3 forward;                  ///< unit, world space
};

CameraModel makeCameraModel(const Camera& camera, std::uint32_t widthPx, std::uint32_t heightPx);

/// True where the device depth is exactly the far value.
bool isBackground(const CameraModel& camera, float deviceDepth);

/// Origin-relative position of a continuous pixel position (the centre of pixel (3, 4) is 3.5, 4.5) at a device depth.
Vec3 worldFromPixel(const CameraModel& camera, double xPx, double yPx, double deviceDepth);
/// The same for a view depth in metres.
Vec3 worldAtViewDepth(const CameraModel& camera, double xPx, double yPx, double viewDepthMetres);

double viewDepth(const CameraModel& camera, Vec3 positionWs);
/// Metres of view depth per unit of device depth, without its sign, and the share by which floats may have it wrong.
double viewDepthPerDeviceDepth(const CameraModel& camera, double deviceDepth, double& errorShare);

struct PixelPosition {
    double xPx = 0, yPx = 0;
    double deviceDepth = 0;
    double clipW = 0;  ///< above zero in front of a perspective camera; x, y and depth hold only then
};
PixelPosition pixelFromWorld(const CameraModel& camera, Vec3 positionWs);

/// How far, in metres, a reconstruction in 32-bit floats may be off: in view depth, from the cancellation in the
/// formula that turns device depth into view depth; in position, from that and from the magnitudes of the terms summed.
/// Both allow kErrorFactor roundings per term; plain float code stays below a sixth of that (tests/unit/reference).
inline constexpr double kErrorFactor = 4;
double viewDepthError(const CameraModel& camera, double deviceDepth);
double positionError(const CameraModel& camera, Vec3 positionWs, double deviceDepth);

}  // namespace gnomon::reference
