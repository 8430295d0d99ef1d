#include "visibility/shadow_views.h"

#include <algorithm>
#include <cmath>

#include "gpu_interface/numbers.h"

namespace gnomon {
namespace {

constexpr float kNoLimit = 3.0e38f;  // 0 times it is 0, which cannot be said of infinity

Result checkView(std::size_t index, const ShadowView& view, std::span<const ShadowAtlas> atlases) {
    const auto number = static_cast<unsigned>(index);
    for (float value : view.clipFromWorld) {
        if (!std::isfinite(value)) {
            return Result::failure(Status::BadArgument,
                                   "Shadow view %u: clipFromWorld holds a value that is not finite.", number);
        }
    }
    if (view.atlas >= atlases.size()) {
        return Result::failure(Status::BadArgument, "Shadow view %u names atlas %u, but the frame has %u.", number,
                               view.atlas, static_cast<unsigned>(atlases.size()));
    }
    const ShadowAtlas& atlas = atlases[view.atlas];
    const bool inside = view.widthPx <= atlas.widthPx && view.xPx <= atlas.widthPx - view.widthPx &&
                        view.heightPx <= atlas.heightPx && view.yPx <= atlas.heightPx - view.heightPx &&
                        view.layer < atlas.layers;
    if (!inside) {
        return Result::failure(Status::BadArgument,
                               "Shadow view %u lies outside its atlas of %ux%u pixels and %u layers.", number,
                               atlas.widthPx, atlas.heightPx, atlas.layers);
    }
    if (view.widthPx < gpu::kMinShadowViewSizePx || view.heightPx < gpu::kMinShadowViewSizePx) {
        return Result::failure(Status::BadArgument, "Shadow view %u has %ux%u pixels; it needs at least %u each way.",
                               number, view.widthPx, view.heightPx, gpu::kMinShadowViewSizePx);
    }
    const bool nearOk = std::isfinite(view.nearMetres) && (view.orthographic || view.nearMetres > 0.0f);
    const bool farOk = view.farMetres > view.nearMetres && (std::isfinite(view.farMetres) || !view.orthographic);
    if (!nearOk || !farOk) {
        return Result::failure(Status::BadArgument,
                               "Shadow view %u needs 0 < near < far (and a finite far plane if orthographic).", number);
    }
    if (!(view.leastBias >= 0.0f && view.leastBias <= view.mostBias && std::isfinite(view.leastBias))) {
        return Result::failure(Status::BadArgument,
                               "Shadow view %u: its leastBias must be finite, at least 0 and at most its mostBias.",
                               number);
    }
    return {};
}

// Device depth as A + B / linear depth (perspective) or A + B * linear depth (orthographic).
void depthCoefficients(const ShadowView& view, double& a, double& b) {
    const double n = view.nearMetres;
    const double f = view.farMetres;
    const bool infinite = std::isinf(view.farMetres);
    const bool reversed = view.deviceDepth == DeviceDepth::ReversedZ;
    if (view.orthographic) {
        a = reversed ? f / (f - n) : -n / (f - n);
        b = (reversed ? -1.0 : 1.0) / (f - n);
    } else if (infinite) {
        a = reversed ? 0.0 : 1.0;
        b = reversed ? n : -n;
    } else {
        a = reversed ? -n / (f - n) : f / (f - n);
        b = (reversed ? 1.0 : -1.0) * n * f / (f - n);
    }
}

// Length of a row of the matrix' upper 3x3, in NDC per metre (at linear depth 1 if perspective).
double rowLength(const float* m, int row) {
    return std::hypot(double(m[row]), double(m[row + 4]), double(m[row + 8]));
}

struct Row {
    double x, y, z;
};
Row cross(const Row& a, const Row& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// What the shader makes of this stands at GpuShadowView::planeX. The rows x, y and z of the matrix give clip.xyw as
// (x p, y p, z p), up to constants. So along a plane, the inverse of linear depth (orthographic: the depth itself) is
// linear in ndc. The coefficients are the cross products of the rows.
bool setPlane(const float* m, bool orthographic, double b, float depthStep, gpu::GpuShadowView& v) {
    const auto row = [&](int i, double scale) {
        return Row{double(m[i]) * scale, double(m[i + 4]) * scale, double(m[i + 8]) * scale};
    };
    const Row x = row(0, 1.0), y = row(1, 1.0), z = orthographic ? row(2, 1.0 / b) : row(3, 1.0);
    const Row across[] = {cross(y, z), cross(z, x), cross(x, y)};
    const double area = std::hypot(across[2].x, across[2].y, across[2].z);
    if (!(area > 0.0)) return false;
    const double slope = orthographic ? -b : b;
    gpu::vec3* const out[] = {&v.planeX, &v.planeY, &v.planeZ};
    for (int i = 0; i < 3; ++i)
        *out[i] = {static_cast<float>(across[i].x / area), static_cast<float>(across[i].y / area),
                   static_cast<float>(across[i].z / area)};
    v.planeSlopePerPxX = static_cast<float>(slope / double(v.pxFromNdcScale.x));
    v.planeSlopePerPxY = static_cast<float>(slope / double(v.pxFromNdcScale.y));
    v.depthStep = depthStep;
    return true;
}

gpu::GpuShadowView convert(const ShadowView& view, const ShadowAtlas& atlas) {
    gpu::GpuShadowView v = {};
    for (int c = 0; c < 4; ++c) {
        const float* m = view.clipFromWorld + 4 * c;
        v.clipFromWorld.column[c] = {m[0], m[1], m[2], m[3]};
    }
    const float width = static_cast<float>(view.widthPx);
    const float height = static_cast<float>(view.heightPx);
    v.rectMinPx = {static_cast<float>(view.xPx), static_cast<float>(view.yPx)};
    v.rectMaxPx = {v.rectMinPx.x + width, v.rectMinPx.y + height};
    v.pxFromNdcScale = {0.5f * width, 0.5f * height};
    v.pxFromNdcOffset = {v.rectMinPx.x + 0.5f * width, v.rectMinPx.y + 0.5f * height};
    double a = 0.0, b = 0.0;
    depthCoefficients(view, a, b);
    v.depthFromLinearA = static_cast<float>(a);
    v.depthFromLinearB = static_cast<float>(b);
    v.flags = (view.orthographic ? gpu::kShadowViewOrthographicBit : 0u) |
              (view.deviceDepth == DeviceDepth::ReversedZ ? gpu::kShadowViewReversedZBit : 0u);
    v.atlasAndLayer = view.atlas | view.layer << 8;
    v.pxPerMetre = {static_cast<float>(rowLength(view.clipFromWorld, 0) * 0.5 * view.widthPx),
                    static_cast<float>(rowLength(view.clipFromWorld, 1) * 0.5 * view.heightPx)};
    if (!view.orthographic)
        v.tangentPerNdc = {v.pxFromNdcScale.x / v.pxPerMetre.x, v.pxFromNdcScale.y / v.pxPerMetre.y};
    if (!setPlane(view.clipFromWorld, view.orthographic, b, atlas.depthStep, v)) v.pxPerMetre = {};
    v.mostBias = std::min(view.mostBias, kNoLimit);
    v.leastBias = std::min(view.leastBias, v.mostBias);
    v.atlasPerTexel = {1.0f / static_cast<float>(atlas.widthPx), 1.0f / static_cast<float>(atlas.heightPx)};
    return v;
}

}  // namespace

Result convertShadowViews(std::span<const ShadowView> views, std::span<const ShadowAtlas> atlases,
                          gpu::GpuShadowView* out) noexcept {
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (Result checked = checkView(i, views[i], atlases); !checked) return checked;
        const gpu::GpuShadowView view = convert(views[i], atlases[views[i].atlas]);
        if (!(view.pxPerMetre.x > 0.0f && view.pxPerMetre.y > 0.0f)) {
            return Result::failure(Status::BadArgument, "Shadow view %u: clipFromWorld is singular.",
                                   static_cast<unsigned>(i));
        }
        out[i] = view;
    }
    return {};
}

}  // namespace gnomon
