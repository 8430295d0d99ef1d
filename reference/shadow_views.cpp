// See shadow_views.h.
#include "reference/shadow_views.h"

#include "gpu_interface/numbers.h"

namespace gnomon::reference {
namespace {

constexpr double kRoundings = 8;

struct Bounded {
    double value = 0, error = 0;
};
/// One row of a matrix applied to a point.
Bounded applyRow(const Mat4& a, int row, Vec3 p, double pointError) {
    const Vec3 r = rowOf(a, row);
    const double terms = std::abs(r.x * p.x) + std::abs(r.y * p.y) + std::abs(r.z * p.z) + std::abs(a.m[row][3]);
    return {dot(r, p) + a.m[row][3], kRoundings * kFloatRoundoff * terms + length(r) * pointError};
}

/// ndc = clip / w, then to atlas pixels.
Bounded toPixels(Bounded clip, Bounded w, double sizePx, double firstPx) {
    const double scale = 0.5 * sizePx, offset = firstPx + 0.5 * sizePx;
    const double ndc = clip.value / w.value;
    const double ndcError = (clip.error + std::abs(ndc) * w.error) / std::abs(w.value);
    const double rounding = kRoundings * kFloatRoundoff * (std::abs(ndc) * scale + std::abs(offset));
    return {ndc * scale + offset, ndcError * scale + rounding};
}

bool near(double a, double b, double tolerance) {
    return a == b || std::abs(a - b) <= tolerance;
}

}  // namespace

DepthFromLinear depthFromLinear(double n, double f, bool orthographic, bool reversed) {
    // Standard: 0 at n, 1 at f. Reversed depth is 1 - standard depth.
    DepthFromLinear standard;
    if (orthographic)
        standard = {-n / (f - n), 1.0 / (f - n)};
    else if (std::isinf(f))
        standard = {1.0, -n};
    else
        standard = {f / (f - n), -f * n / (f - n)};
    return reversed ? DepthFromLinear{1.0 - standard.a, -standard.b} : standard;
}

std::vector<ShadowViewModel> makeShadowViewModels(std::span<const ShadowView> views,
                                                  std::span<const AtlasCopy> atlases) {
    std::vector<ShadowViewModel> result;
    for (const ShadowView& view : views) {
        ShadowViewModel model;
        model.clipFromWorld = fromColumnMajor(view.clipFromWorld);
        model.atlas = view.atlas;
        model.layer = view.layer;
        if (view.atlas < atlases.size()) model.depthStep = atlases[view.atlas].depthStep;
        model.xPx = static_cast<int>(view.xPx);
        model.yPx = static_cast<int>(view.yPx);
        model.widthPx = static_cast<int>(view.widthPx);
        model.heightPx = static_cast<int>(view.heightPx);
        model.orthographic = view.orthographic;
        model.reversed = view.deviceDepth == DeviceDepth::ReversedZ;
        model.depth = depthFromLinear(view.nearMetres, view.farMetres, model.orthographic, model.reversed);
        // One metre across the view at linear depth 1 (or anywhere) is |row| of ndc, of which the rectangle holds two.
        model.pxPerMetreX = length(rowOf(model.clipFromWorld, 0)) * 0.5 * model.widthPx;
        model.pxPerMetreY = length(rowOf(model.clipFromWorld, 1)) * 0.5 * model.heightPx;
        model.mostBias = std::min(static_cast<double>(view.mostBias), model.mostBias);
        model.leastBias = view.leastBias;
        result.push_back(model);
    }
    return result;
}

Findings checkShadowViews(std::span<const ShadowView> views, std::span<const gpu::GpuShadowView> gpuViews) {
    Findings findings;
    if (gpuViews.size() < views.size()) {
        findings.add("%zu shadow views instead of %zu", gpuViews.size(), views.size());
        return findings;
    }
    const std::vector<ShadowViewModel> models = makeShadowViewModels(views);
    for (std::size_t i = 0; i < models.size(); ++i) {
        const ShadowViewModel& model = models[i];
        const gpu::GpuShadowView& view = gpuViews[i];
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column)
                if ((&view.clipFromWorld.column[column].x)[row] != views[i].clipFromWorld[column * 4 + row])
                    findings.add("shadow view %zu: matrix differs at row %d, column %d", i, row, column);
        if (view.rectMinPx.x != model.xPx || view.rectMinPx.y != model.yPx ||
            view.rectMaxPx.x != model.xPx + model.widthPx || view.rectMaxPx.y != model.yPx + model.heightPx)
            findings.add("shadow view %zu: rectangle differs", i);
        if (view.pxFromNdcScale.x != 0.5f * model.widthPx || view.pxFromNdcScale.y != 0.5f * model.heightPx ||
            view.pxFromNdcOffset.x != model.xPx + 0.5f * model.widthPx ||
            view.pxFromNdcOffset.y != model.yPx + 0.5f * model.heightPx)
            findings.add("shadow view %zu: pixels from ndc differ", i);
        if (!near(view.depthFromLinearA, model.depth.a, 1e-6) ||
            !near(view.depthFromLinearB, model.depth.b, 1e-6 * std::abs(model.depth.b)))
            findings.add("shadow view %zu: depth from linear is (%g, %g) instead of (%g, %g)", i, view.depthFromLinearA,
                         view.depthFromLinearB, model.depth.a, model.depth.b);
        const std::uint32_t flags = (model.orthographic ? gpu::kShadowViewOrthographicBit : 0u) |
                                    (model.reversed ? gpu::kShadowViewReversedZBit : 0u);
        if (view.flags != flags) findings.add("shadow view %zu: flags %u instead of %u", i, view.flags, flags);
        if ((view.atlasAndLayer & 0xFFu) != model.atlas || view.atlasAndLayer >> 8 != model.layer)
            findings.add("shadow view %zu: atlas and layer %x", i, view.atlasAndLayer);
        if (!near(view.pxPerMetre.x, model.pxPerMetreX, 1e-6 * model.pxPerMetreX) ||
            !near(view.pxPerMetre.y, model.pxPerMetreY, 1e-6 * model.pxPerMetreY))
            findings.add("shadow view %zu: %g x %g texels per metre instead of %g x %g", i, view.pxPerMetre.x,
                         view.pxPerMetre.y, model.pxPerMetreX, model.pxPerMetreY);
        if (!near(view.mostBias, model.mostBias, 1e-6 * model.mostBias))
            findings.add("shadow view %zu: bias of at most %g instead of %g", i, view.mostBias, model.mostBias);
        if (!near(view.leastBias, model.leastBias, 1e-6 * model.leastBias))
            findings.add("shadow view %zu: bias of at least %g instead of %g", i, view.leastBias, model.leastBias);
    }
    return findings;
}

ShadowPosition project(const ShadowViewModel& view, Vec3 positionWs, double pointError) {
    const Bounded x = applyRow(view.clipFromWorld, 0, positionWs, pointError);
    const Bounded y = applyRow(view.clipFromWorld, 1, positionWs, pointError);
    const Bounded z = applyRow(view.clipFromWorld, 2, positionWs, pointError);
    const Bounded w = applyRow(view.clipFromWorld, 3, positionWs, pointError);
    ShadowPosition result;
    result.clipW = w.value;
    result.clipWError = w.error;
    const Bounded px = toPixels(x, w, view.widthPx, view.xPx);
    const Bounded py = toPixels(y, w, view.heightPx, view.yPx);
    result.xPx = px.value;
    result.xErrorPx = px.error;
    result.yPx = py.value;
    result.yErrorPx = py.error;
    if (view.orthographic) {
        const double deviceDepth = z.value / w.value;
        result.linearDepth = (deviceDepth - view.depth.a) / view.depth.b;
        result.linearDepthError =
            (z.error + kRoundings * kFloatRoundoff * (std::abs(deviceDepth) + std::abs(view.depth.a))) /
            std::abs(view.depth.b);
    } else {
        result.linearDepth = w.value;
        result.linearDepthError = w.error;
    }
    return result;
}

}  // namespace gnomon::reference
