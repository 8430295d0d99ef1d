// See filters.h.
#include "reference/filters.h"

#include <cstddef>

namespace gnomon::reference {
namespace {

constexpr double kMaxPositionWidthPx = 4.0;  // wider: anything may come out

/// Weights of the texels of one axis, the first of which is `first`.
struct AxisWeights {
    int first = 0;
    std::vector<double> weights;
};
AxisWeights axisWeights(double px, int radius) {
    const double fromCentre = px - 0.5;
    const double base = std::floor(fromCentre);
    const double f = fromCentre - base;
    AxisWeights result;
    result.first = static_cast<int>(base) - radius;
    result.weights.assign(2 * radius + 2, 1.0);
    result.weights.front() = 1.0 - f;
    result.weights.back() = f;
    return result;
}

/// The comparisons of a block of texels, made once.
struct LitTexels {
    int firstX = 0, firstY = 0, width = 0;
    std::vector<Visibility> lit;
    [[nodiscard]] Visibility at(int x, int y) const {
        return lit[static_cast<std::size_t>(y - firstY) * width + (x - firstX)];
    }
};
LitTexels compareBlock(const Comparison& comparison, TexelRange across, TexelRange down) {
    LitTexels block = {across.from, down.from, across.to - across.from + 1, {}};
    for (int y = down.from; y <= down.to; ++y)
        for (int x = across.from; x <= across.to; ++x) block.lit.push_back(visibilityOf(comparison.lit(x, y)));
    return block;
}

Visibility pcfExactlyAt(const LitTexels& block, int radius, double xPx, double yPx) {
    const AxisWeights across = axisWeights(xPx, radius), down = axisWeights(yPx, radius);
    Visibility sum = kDark;
    for (std::size_t j = 0; j < down.weights.size(); ++j) {
        for (std::size_t i = 0; i < across.weights.size(); ++i) {
            const double weight = across.weights[i] * down.weights[j];
            if (weight == 0.0) continue;
            const Visibility texel = block.at(across.first + static_cast<int>(i), down.first + static_cast<int>(j));
            sum.min += weight * texel.min;
            sum.max += weight * texel.max;
        }
    }
    const double all = (2.0 * radius + 1.0) * (2.0 * radius + 1.0);
    return {sum.min / all, sum.max / all};
}

/// The position clamped to where the kernel's support (radius + 1 to each side) fits.
Interval clampToSupport(Interval px, int radius, int first, int size) {
    return clamp(px, first + radius + 1.0, first + size - radius - 1.0);
}

/// The ends, and the texel centres between them: the filter is bilinear between texel centres, so it takes its extremes
/// there.
std::vector<double> extremePositions(Interval px) {
    std::vector<double> result = {px.lo};
    if (px.hi > px.lo) result.push_back(px.hi);
    for (double centre = std::floor(px.lo) + 0.5; centre < px.hi; centre += 1.0)
        if (centre > px.lo) result.push_back(centre);
    return result;
}

TexelRange supportOf(Interval px, int radius) {
    return {static_cast<int>(std::floor(px.lo - 0.5)) - radius, static_cast<int>(std::floor(px.hi - 0.5)) + 1 + radius};
}

}  // namespace

double Comparison::stored(int x, int y) const {
    return atlas.at(view.layer, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
}

Verdict Comparison::lit(int x, int y) const {
    return isLit(view, stored(x, y), depthOfPlane(view, plane, x + 0.5, y + 0.5, limited));
}

TexelRange texelsOf(Interval px, int first, int size) {
    const auto texel = [&](double v) {
        return static_cast<int>(std::clamp(std::floor(v), double(first), double(first + size - 1)));
    };
    return {texel(px.lo), texel(px.hi)};
}

Visibility hardAt(const Comparison& comparison, Interval xPx, Interval yPx) {
    const ShadowViewModel& view = comparison.view;
    const TexelRange across = texelsOf(xPx, view.xPx, view.widthPx), down = texelsOf(yPx, view.yPx, view.heightPx);
    Visibility result = kNone;
    for (int y = down.from; y <= down.to; ++y)
        for (int x = across.from; x <= across.to; ++x) result = merge(result, visibilityOf(comparison.lit(x, y)));
    return result;
}

Visibility pcfAt(const Comparison& comparison, int radius, Interval xPx, Interval yPx) {
    const ShadowViewModel& view = comparison.view;
    const Interval x = clampToSupport(xPx, radius, view.xPx, view.widthPx);
    const Interval y = clampToSupport(yPx, radius, view.yPx, view.heightPx);
    if (!(x.width() <= kMaxPositionWidthPx && y.width() <= kMaxPositionWidthPx)) return kAny;
    const LitTexels block = compareBlock(comparison, supportOf(x, radius), supportOf(y, radius));
    Visibility result = kNone;
    for (const double atY : extremePositions(y))
        for (const double atX : extremePositions(x)) result = merge(result, pcfExactlyAt(block, radius, atX, atY));
    return result;
}

}  // namespace gnomon::reference
