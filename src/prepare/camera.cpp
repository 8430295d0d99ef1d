// Camera: from the host's viewFromWorld and clipFromView to eye, axes, near, far, and the two mappings that shaders use
// (pixel -> view xy, device depth -> view depth).
//
// Plain way: ask the host for all of these.
// What we do: the depth buffer was drawn with exactly one matrix. So that matrix is the one truth, and everything else
// is read out of it. A projection without shear has six numbers:
//
//     clip.x = m00 x + m02 z (+ m03 if orthographic)     clip.z = m22 z + m23
//     clip.y = m11 y + m12 z (+ m13 if orthographic)     clip.w = +-z (perspective) or 1 (orthographic)
//
// Whether the view looks down +z or -z: for perspective the sign of clip.w says it. For an orthographic matrix it
// follows from whether device depth grows or falls along z, and from what the host says of its depth.
// Near and far are where device depth takes its end values.
//
// Limits: oblique near planes, sheared and rotated projections are refused. They are no product of a pixel's x and y.

#include "prepare/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gnomon::prepare {
namespace {

constexpr double kRigidTolerance = 1e-3;
constexpr double kShearTolerance = 1e-6;  // relative to the scales
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Element in row r and column c of a column-major matrix.
double at(const float* m, int r, int c) {
    return static_cast<double>(m[c * 4 + r]);
}

bool allFinite(const float* m) {
    return std::all_of(m, m + 16, [](float f) { return std::isfinite(f); });
}

Result bad(const char* sentence) {
    return Result::failure(Status::BadArgument, "%s", sentence);
}

// Takes the rotation apart; z still points along the host's view z.
Result deriveAxes(const float* m, ViewCamera& out) {
    if (!allFinite(m)) return bad("Camera::viewFromWorld has a value that is not finite; give a rigid matrix.");
    Vec3 x{at(m, 0, 0), at(m, 0, 1), at(m, 0, 2)};
    Vec3 y{at(m, 1, 0), at(m, 1, 1), at(m, 1, 2)};
    Vec3 z{at(m, 2, 0), at(m, 2, 1), at(m, 2, 2)};
    const double errors[] = {dot(x, x) - 1, dot(y, y) - 1, dot(z, z) - 1, dot(x, y),   dot(y, z),
                             dot(z, x),     at(m, 3, 0),   at(m, 3, 1),   at(m, 3, 2), at(m, 3, 3) - 1};
    for (const double error : errors) {
        if (std::abs(error) > kRigidTolerance) {
            return bad(
                "Camera::viewFromWorld is not rigid; give a rotation and a translation alone, in column-major order.");
        }
    }
    if (dot(cross(x, y), z) < 0) {
        return bad("Camera::viewFromWorld mirrors; give a rotation and a translation, and mirror in clipFromView.");
    }
    z = z * (1.0 / length(z));
    x = x - z * dot(x, z);
    x = x * (1.0 / length(x));
    y = cross(z, x);
    out.axisXWs = x;
    out.axisYWs = y;
    out.axisZWs = z;
    out.eyeWs = (x * at(m, 0, 3) + y * at(m, 1, 3) + z * at(m, 2, 3)) * -1.0;
    return {};
}

// Rejects what the six numbers cannot hold. `wScale` is what clip.w is divided by to be +-z or 1.
Result checkShape(const float* m, bool perspective, double wScale) {
    const double scaleX = std::abs(at(m, 0, 0)), scaleY = std::abs(at(m, 1, 1));
    if (!(scaleX > 1e-12 * wScale) || !(scaleY > 1e-12 * wScale)) {
        return bad("Camera::clipFromView is singular: its x or y scale is zero; set both.");
    }
    const int otherColumn = perspective ? 3 : 2;  // the column that holds no centre offset
    const double scale = kShearTolerance * std::max(scaleX, scaleY);
    const double shears[] = {at(m, 0, 1), at(m, 1, 0), at(m, 0, otherColumn), at(m, 1, otherColumn)};
    for (const double shear : shears) {
        if (std::abs(shear) > scale) {
            return bad("Camera::clipFromView shears or rotates; only scales, centre offsets and depth are allowed.");
        }
    }
    if (std::abs(at(m, 2, 0)) > scale || std::abs(at(m, 2, 1)) > scale) {
        return bad("Camera::clipFromView has an oblique near plane; give one across the view axis.");
    }
    return {};
}

Result derivePerspectiveDepth(double scaleZ, double offset, bool reversed, ViewCamera& out) {
    // Device depth = scaleZ + offset / view depth.
    if (offset == 0.0) return bad("Camera::clipFromView is singular: its depth does not change along the view axis.");
    if ((offset > 0) != reversed) {
        return bad("Camera::clipFromView's depth runs against Camera::deviceDepth; set the other DeviceDepth.");
    }
    const double nearDevice = reversed ? 1 : 0, farDevice = reversed ? 0 : 1;
    out.nearMetres = offset / (nearDevice - scaleZ);
    if (!(out.nearMetres > 0) || !std::isfinite(out.nearMetres)) {
        return bad(
            "Camera::clipFromView has no near plane in front of the eye; check its depth range against Vulkan's.");
    }
    const double farDistance = offset / (farDevice - scaleZ);
    // A little short of infinity is how some hosts write infinity: the sign then says "behind".
    out.farMetres = (farDevice == scaleZ || farDistance <= 0) ? kInfinity : farDistance;
    if (!(out.farMetres > out.nearMetres)) {
        return bad("Camera::clipFromView has its far plane before its near plane; check Camera::deviceDepth.");
    }
    const double mapping[4] = {0, offset, 1, -scaleZ};
    std::copy(mapping, mapping + 4, out.depthFromDevice);
    return {};
}

Result deriveOrthographicDepth(double scaleZ, double offset, bool reversed, ViewCamera& out) {
    // Device depth = scaleZ * view depth + offset.
    out.nearMetres = ((reversed ? 1 : 0) - offset) / scaleZ;
    out.farMetres = ((reversed ? 0 : 1) - offset) / scaleZ;
    const double depthSpan = out.farMetres - out.nearMetres;
    if (out.nearMetres < -1e-4 * depthSpan) {
        return bad("Camera::clipFromView's orthographic near plane is behind the eye; move the camera back.");
    }
    out.nearMetres = std::max(out.nearMetres, 0.0);
    const double mapping[4] = {1.0 / scaleZ, -offset / scaleZ, 0, 1};
    std::copy(mapping, mapping + 4, out.depthFromDevice);
    return {};
}

}  // namespace

Result deriveCamera(const Camera& camera, std::uint32_t widthPx, std::uint32_t heightPx, ViewCamera& out) noexcept {
    if (Result result = deriveAxes(camera.viewFromWorld, out); !result) return result;
    const float* m = camera.clipFromView;
    if (!allFinite(m)) return bad("Camera::clipFromView has a value that is not finite; give the projection matrix.");
    const double rowW[4] = {at(m, 3, 0), at(m, 3, 1), at(m, 3, 2), at(m, 3, 3)};
    const double wScale = std::max(std::abs(rowW[2]), std::abs(rowW[3]));
    const bool perspective = std::abs(rowW[2]) > std::abs(rowW[3]);
    const double wOther = perspective ? rowW[3] : rowW[2];
    const bool wIsPlain =
        wScale > 0 && (perspective || rowW[3] > 0) &&
        std::max({std::abs(rowW[0]), std::abs(rowW[1]), std::abs(wOther)}) <= kShearTolerance * wScale;
    if (!wIsPlain) {
        return bad("Camera::clipFromView's last row is neither (0,0,+-1,0) nor (0,0,0,1); give a projection matrix.");
    }
    if (Result result = checkShape(m, perspective, wScale); !result) return result;

    const double divide = 1.0 / wScale;  // makes clip.w exactly +-z or 1
    const bool reversed = camera.deviceDepth == DeviceDepth::ReversedZ;
    const double m22 = at(m, 2, 2) * divide, m23 = at(m, 2, 3) * divide;
    out.orthographic = !perspective;
    out.backgroundDevice = reversed ? 0 : 1;
    if (!perspective && m22 == 0) return bad("Camera::clipFromView is singular: its depth scale is zero; set it.");
    const double side = (perspective ? rowW[2] > 0 : (m22 < 0) == reversed) ? 1 : -1;  // of the host's view z
    out.axisZWs = out.axisZWs * side;
    for (int i = 0; i < 2; ++i) {
        const double scale = at(m, i, i) * divide;
        const double centreNdc = at(m, i, perspective ? 2 : 3) * divide * (perspective ? side : 1);
        const double extent = i == 0 ? widthPx : heightPx;
        out.xyScale[i] = 2.0 / (extent * scale);
        out.xyOffset[i] = (-1.0 - centreNdc) / scale;
    }
    return perspective ? derivePerspectiveDepth(m22 * side, m23, reversed, out)
                       : deriveOrthographicDepth(m22 * side, m23, reversed, out);
}

void fillCameraConstants(const ViewCamera& camera, gpu::GpuFrame& frame) noexcept {
    const auto toVec2 = [](double x, double y) { return gpu::vec2{static_cast<float>(x), static_cast<float>(y)}; };
    const auto toVec3 = [](Vec3 v) {
        return gpu::vec3{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    };
    frame.eyeWs = toVec3(camera.eyeWs);
    frame.backgroundDepth = static_cast<float>(camera.backgroundDevice);
    frame.axisXWs = toVec3(camera.axisXWs);
    frame.axisYWs = toVec3(camera.axisYWs);
    frame.axisZWs = toVec3(camera.axisZWs);
    frame.viewXyPerPixel = toVec2(camera.xyScale[0], camera.xyScale[1]);
    frame.viewXyAtPixel0 = toVec2(camera.xyOffset[0], camera.xyOffset[1]);
    const double* d = camera.depthFromDevice;
    frame.viewDepthNumerator = toVec2(d[0], d[1]);
    frame.viewDepthDenominator = toVec2(d[2], d[3]);
}

}  // namespace gnomon::prepare
