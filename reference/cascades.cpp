// See cascades.h.
#include "reference/cascades.h"

#include "gpu_interface/numbers.h"

namespace gnomon::reference {
namespace {

constexpr double kBlendStart = 0.9, kBlendPerWay = 10.0;
constexpr double kMargin = gpu::kCascadeMarginPx;

/// One axis: inside the margins, and how far from the middle toward them.
struct AxisFit {
    Verdict inside = Verdict::Never;
    Interval way;
};
AxisFit axisFit(Interval px, double first, double size) {
    const double centre = first + 0.5 * size, half = 0.5 * size - kMargin;
    AxisFit fit;
    fit.inside = both(atLeast(px, first + kMargin), atLeast(-px, -(first + size - kMargin)));
    fit.way = abs(px - centre) / half;
    return fit;
}

Visibility mixed(Visibility near, Visibility far, Interval blend) {
    const auto at = [](double a, double b, double t) { return a * (1 - t) + b * t; };
    return {std::min(at(near.min, far.min, blend.lo), at(near.min, far.min, blend.hi)),
            std::max(at(near.max, far.max, blend.lo), at(near.max, far.max, blend.hi))};
}

}  // namespace

CascadeFit fitIn(const ShadowViewModel& cascade, const Pixel& pixel) {
    const ShadowPosition at = project(cascade, pixel.position, pixel.positionError);
    const AxisFit x = axisFit(within(at.xPx, at.xErrorPx), cascade.xPx, cascade.widthPx);
    const AxisFit y = axisFit(within(at.yPx, at.yErrorPx), cascade.yPx, cascade.heightPx);
    const Interval depth =
        rounded(cascade.depth.a) + rounded(cascade.depth.b) * within(at.linearDepth, at.linearDepthError);
    CascadeFit fit;
    fit.holds = both(both(x.inside, y.inside), both(atLeast(depth, 0.0), atLeast(-depth, -1.0)));
    fit.blend = clamp((max(x.way, y.way) - kBlendStart) * kBlendPerWay, 0.0, 1.0);
    return fit;
}

Visibility throughCascades(std::span<const ShadowViewModel> cascades, const Pixel& pixel,
                           const std::function<Visibility(std::size_t)>& sample) {
    Visibility result = kNone;
    for (std::size_t i = 0; i < cascades.size(); ++i) {
        const CascadeFit fit = fitIn(cascades[i], pixel);
        if (fit.holds == Verdict::Never) continue;
        Visibility here = sample(i);
        if (fit.blend.hi > 0) {
            const bool last = i + 1 == cascades.size();
            const Verdict next = last ? Verdict::Must : fitIn(cascades[i + 1], pixel).holds;
            const Visibility alone = here;
            if (next != Verdict::Never) here = mixed(here, last ? kLit : sample(i + 1), fit.blend);
            if (next == Verdict::May) here = merge(here, alone);
        }
        result = merge(result, here);
        if (fit.holds == Verdict::Must) return result;
    }
    return merge(result, kLit);
}

}  // namespace gnomon::reference
