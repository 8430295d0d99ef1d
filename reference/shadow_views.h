#pragma once
// Shadow views and copies of the shadow atlases, in double precision.
//
// Source: gnomon/scene.h (ShadowView) and gpu_interface/structs.h (GpuShadowView).
//
// What: the projection of a world point into a view's rectangle, its linear depth, and how far 32-bit floats may be
// off.
//
// Limits: perspective matrices have clip.w = linear depth in metres.

#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/scene.h"
#include "gpu_interface/structs.h"
#include "reference/findings.h"
#include "reference/vector_math.h"

namespace gnomon::reference {

/// A shadow atlas image. Texels of a layer in rows; layers one after the other.
struct AtlasCopy {
    std::uint32_t widthPx = 0, heightPx = 0, layers = 1;
    double depthStep = 0;  ///< between neighbouring values, beyond that of floats
    std::vector<float> depth;

    [[nodiscard]] float at(std::uint32_t layer, std::uint32_t x, std::uint32_t y) const {
        return depth[(std::size_t(layer) * heightPx + y) * widthPx + x];
    }
    float& at(std::uint32_t layer, std::uint32_t x, std::uint32_t y) {
        return depth[(std::size_t(layer) * heightPx + y) * widthPx + x];
    }
};

/// Device depth = a + b / linear depth (perspective), or a + b * linear depth (orthographic).
struct DepthFromLinear {
    double a = 0, b = 0;
};
/// farMetres may be infinite for perspective.
DepthFromLinear depthFromLinear(double nearMetres, double farMetres, bool orthographic, bool reversed);

struct ShadowViewModel {
    Mat4 clipFromWorld;
    std::uint32_t atlas = 0, layer = 0;
    int xPx = 0, yPx = 0, widthPx = 0, heightPx = 0;  ///< rectangle
    bool orthographic = false;
    bool reversed = true;
    DepthFromLinear depth;
    double depthStep = 0;                     ///< of the atlas
    double pxPerMetreX = 0, pxPerMetreY = 0;  ///< texels per metre, at linear depth 1 m (perspective) or anywhere
    /// Of the lights' bias: shares of linear depth (perspective) or metres. At most what a float holds.
    double mostBias = 3e38, leastBias = 0.0;
};

/// `atlases`: whence the depth steps, which are 0 where there are none.
std::vector<ShadowViewModel> makeShadowViewModels(std::span<const ShadowView> views,
                                                  std::span<const AtlasCopy> atlases = {});

/// Every GpuShadowView against the host's description of it.
Findings checkShadowViews(std::span<const ShadowView> views, std::span<const gpu::GpuShadowView> gpuViews);

/// A point in a view, each value with the most that 32-bit floats may be off, given that the point itself is known to
/// within `pointError` metres.
struct ShadowPosition {
    double clipW = 0, clipWError = 0;
    double xPx = 0, yPx = 0;  ///< atlas pixels
    double xErrorPx = 0, yErrorPx = 0;
    double linearDepth = 0, linearDepthError = 0;
};
ShadowPosition project(const ShadowViewModel& view, Vec3 positionWs, double pointError);

}  // namespace gnomon::reference
