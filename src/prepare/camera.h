#pragma once
// The host's two camera matrices, taken apart into what culling and the shaders need.

#include <cstdint>

#include "gnomon/result.h"
#include "gnomon/scene.h"
#include "gpu_interface/structs.h"
#include "prepare/vec3.h"

namespace gnomon::prepare {

/// View space is (host's view x, host's view y, view depth): z is the positive distance along the view axis.
struct ViewCamera {
    bool orthographic = false;
    Vec3 eyeWs;
    Vec3 axisXWs, axisYWs, axisZWs;        // unit, orthogonal
    double nearMetres = 0, farMetres = 0;  // far may be infinite
    // View xy (at depth 1 where perspective) = pixel * scale + offset. Either scale may be negative.
    double xyScale[2] = {}, xyOffset[2] = {};
    double depthFromDevice[4] = {};  // view depth = (x * d + y) / (z * d + w)
    double backgroundDevice = 0;

    [[nodiscard]] Vec3 directionVs(Vec3 ws) const { return {dot(axisXWs, ws), dot(axisYWs, ws), dot(axisZWs, ws)}; }
    [[nodiscard]] Vec3 positionVs(Vec3 ws) const { return directionVs(ws - eyeWs); }
};

/// Fails with a sentence where the camera breaks a rule of scene.h.
Result deriveCamera(const Camera& camera, std::uint32_t widthPx, std::uint32_t heightPx, ViewCamera& out) noexcept;

/// Sets the members of `frame` that come from the camera alone, and no others.
void fillCameraConstants(const ViewCamera& camera, gpu::GpuFrame& frame) noexcept;

}  // namespace gnomon::prepare
