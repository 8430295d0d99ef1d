// See camera.h.
#include "reference/camera.h"

namespace gnomon::reference {
namespace {

Vec3 viewFromPixel(const CameraModel& camera, double xPx, double yPx, double deviceDepth) {
    const Vec3 ndc = {2.0 * xPx / camera.widthPx - 1.0, 2.0 * yPx / camera.heightPx - 1.0, deviceDepth};
    return transformPoint(camera.viewFromClip, ndc);
}

}  // namespace

CameraModel makeCameraModel(const Camera& camera, std::uint32_t widthPx, std::uint32_t heightPx) {
    CameraModel model;
    model.viewFromWorld = fromColumnMajor(camera.viewFromWorld);
    model.worldFromView = inverse(model.viewFromWorld);
    model.clipFromView = fromColumnMajor(camera.clipFromView);
    model.viewFromClip = inverse(model.clipFromView);
    model.clipFromWorld = model.clipFromView * model.viewFromWorld;
    model.widthPx = widthPx;
    model.heightPx = heightPx;
    model.orthographic = model.clipFromView.m[3][2] == 0.0;
    model.reversed = camera.deviceDepth == DeviceDepth::ReversedZ;
    model.nearDeviceDepth = model.reversed ? 1.0 : 0.0;
    model.backgroundDepth = model.reversed ? 0.0 : 1.0;

    const double nearZ = viewFromPixel(model, 0.5 * widthPx, 0.5 * heightPx, model.nearDeviceDepth).z;
    const double fartherZ = viewFromPixel(model, 0.5 * widthPx, 0.5 * heightPx, 0.5).z;
    model.forwardSign = fartherZ > nearZ ? 1.0 : -1.0;
    model.nearMetres = model.forwardSign * nearZ;
    const Vec4 farPoint = model.viewFromClip * Vec4{0, 0, model.backgroundDepth, 1};
    const bool infiniteFar = std::abs(farPoint.w) < 1e-12 * std::abs(farPoint.z);
    model.farMetres = infiniteFar ? kInfinity : model.forwardSign * farPoint.z / farPoint.w;

    for (const double x : {0.0, static_cast<double>(widthPx)}) {
        for (const double y : {0.0, static_cast<double>(heightPx)}) {
            Vec3 corner = viewFromPixel(model, x, y, 0.5);
            if (!model.orthographic) corner = corner / std::abs(corner.z);
            model.maxSlope = std::max({model.maxSlope, std::abs(corner.x), std::abs(corner.y)});
        }
    }
    model.eye = transformPoint(model.worldFromView, {0, 0, 0});
    model.forward = normalize(transformPoint(model.worldFromView, {0, 0, model.forwardSign}) - model.eye);
    return model;
}

bool isBackground(const CameraModel& camera, float deviceDepth) {
    return deviceDepth == camera.backgroundDepth;
}

Vec3 worldFromPixel(const CameraModel& camera, double xPx, double yPx, double deviceDepth) {
    return transformPoint(camera.worldFromView, viewFromPixel(camera, xPx, yPx, deviceDepth));
}

Vec3 worldAtViewDepth(const CameraModel& camera, double xPx, double yPx, double viewDepthMetres) {
    // Two points of the pixel's ray; the third lies on their line.
    const Vec3 a = worldFromPixel(camera, xPx, yPx, camera.nearDeviceDepth);
    const Vec3 b = worldFromPixel(camera, xPx, yPx, 0.5);
    const double depthA = viewDepth(camera, a);
    const double depthB = viewDepth(camera, b);
    return a + (b - a) * ((viewDepthMetres - depthA) / (depthB - depthA));
}

double viewDepth(const CameraModel& camera, Vec3 positionWs) {
    return camera.forwardSign * transformPoint(camera.viewFromWorld, positionWs).z;
}

double viewDepthPerDeviceDepth(const CameraModel& camera, double deviceDepth, double& errorShare) {
    // The derivative of z = (d e - b) / (a - d c), as in viewDepthError().
    const double a = camera.clipFromView.m[2][2], b = camera.clipFromView.m[2][3];
    const double c = camera.clipFromView.m[3][2], e = camera.clipFromView.m[3][3];
    const double denominator = std::abs(a - deviceDepth * c);
    errorShare = kErrorFactor * kFloatRoundoff * (2.0 * (std::abs(a) + std::abs(deviceDepth * c)) / denominator + 4.0);
    return std::abs(a * e - b * c) / (denominator * denominator);
}

PixelPosition pixelFromWorld(const CameraModel& camera, Vec3 positionWs) {
    const Vec4 clip = camera.clipFromWorld * Vec4{positionWs.x, positionWs.y, positionWs.z, 1.0};
    PixelPosition result;
    result.clipW = clip.w;
    result.xPx = (clip.x / clip.w * 0.5 + 0.5) * camera.widthPx;
    result.yPx = (clip.y / clip.w * 0.5 + 0.5) * camera.heightPx;
    result.deviceDepth = clip.z / clip.w;
    return result;
}

double viewDepthError(const CameraModel& camera, double deviceDepth) {
    // device depth d = (a z + b) / (c z + e), so z = (d e - b) / (a - d c); each of the four terms may be off by a few
    // roundings of its own magnitude.
    const double a = camera.clipFromView.m[2][2], b = camera.clipFromView.m[2][3];
    const double c = camera.clipFromView.m[3][2], e = camera.clipFromView.m[3][3];
    const double denominator = std::abs(a - deviceDepth * c);
    const double z = std::abs((deviceDepth * e - b) / denominator);
    const double numeratorTerms = std::abs(deviceDepth * e) + std::abs(b);
    const double denominatorTerms = std::abs(a) + std::abs(deviceDepth * c);
    return kErrorFactor * kFloatRoundoff * (numeratorTerms + z * denominatorTerms) / denominator;
}

double positionError(const CameraModel& camera, Vec3 positionWs, double deviceDepth) {
    const double depth = std::abs(viewDepth(camera, positionWs));
    const double slope = camera.orthographic ? 1.0 : 1.0 + 2.0 * camera.maxSlope;
    const double across = camera.orthographic ? camera.maxSlope : camera.maxSlope * depth;
    const double magnitudes = sumOfMagnitudes(camera.eye) + sumOfMagnitudes(positionWs) + depth + 2.0 * across;
    return viewDepthError(camera, deviceDepth) * slope + kErrorFactor * kFloatRoundoff * magnitudes;
}

}  // namespace gnomon::reference
