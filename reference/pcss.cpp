// See pcss.h.
#include "reference/pcss.h"

#include "gpu_interface/numbers.h"
#include "reference/blocker_search.h"
#include "reference/pcss_faces.h"

namespace gnomon::reference {
namespace {

constexpr double kMaxPieces = 64;
constexpr double kOnCentrePx = 1e-9;
constexpr double kPiecePx = 0.02;  // a filter radius known to less is not split further

/// How far aside blockers may lie, see pcss.h.
struct Region {
    Interval g0, g1;          // tangents or metres; per device depth
    double largestScale = 1;  // P: texels per unit
    Interval widest;          // G
    Interval search;          // S
    [[nodiscard]] Interval at(Interval deviceDepth) const { return g0 + g1 * deviceDepth; }
};
Region regionOf(const ShadowViewModel& view, const ReceiverPlane& plane, Interval radius) {
    Region region;
    const Interval a = rounded(view.depth.a), b = rounded(view.depth.b), z = plane.linearDepth;
    region.largestScale = std::max(view.pxPerMetreX, view.pxPerMetreY);
    const Interval p = rounded(region.largestScale);
    Interval widest;
    if (view.orthographic) {
        region.g1 = -(radius / b);
        region.g0 = radius * (z + a / b);
        widest = max(region.at(view.reversed ? 1.0 : 0.0), 0.0);
    } else {
        region.g1 = radius / b;
        region.g0 = -(radius * a / b) - radius / z;
        widest = 9.0 * radius / z;
    }
    region.widest = min(widest, double(gpu::kMaxPcssRadiusPx) / p);
    region.search = region.widest + 1.0 / p;
    return region;
}

struct TapPosition {
    Interval xPx, yPx;
};
TapPosition tapPosition(const ShadowViewModel& view, const ReceiverPlane& plane, DiskDirection direction,
                        Interval radius) {
    const Interval along = (plane.tangentX * direction.x + plane.tangentY * direction.y) / (1.0 + plane.ray);
    const Interval x = direction.x + plane.tangentX * along, y = direction.y + plane.tangentY * along;
    return {plane.xPx + x * radius * rounded(view.pxPerMetreX), plane.yPx + y * radius * rounded(view.pxPerMetreY)};
}

class Pcss {
public:
    Pcss(const PcssInput& input, const ReceiverPlane& plane)
        : input_(input),
          plane_(plane),
          view_(input.views[input.view]),
          comparison_{view_, input.atlases[view_.atlas], plane, true},
          region_(regionOf(view_, plane, input.sourceRadius)) {}

    [[nodiscard]] Visibility run() const;
    [[nodiscard]] PcssSearch search(Interval spreadMetres) const;
    [[nodiscard]] Visibility filtered(Interval radiusPx) const;

private:
    /// `spread` in the units of the region.
    [[nodiscard]] SearchTap searchTap(int index, Interval spread) const;
    [[nodiscard]] SearchTexel searchTexel(Verdict lit, Interval aside, Interval deviceDepth) const;
    [[nodiscard]] SearchAlternative fourTexels(Interval aside, int firstX, int firstY) const;
    [[nodiscard]] Interval radiusPxOf(Interval meanDepth) const;
    [[nodiscard]] Visibility filterAtRadius(Interval radius, int taps) const;
    [[nodiscard]] Visibility filterTap(TapPosition at) const;
    [[nodiscard]] bool hasFaces() const { return input_.views.size() == gpu::kPointLightFaces; }
    /// Does the position stay where its own face can answer? Others than point lights always do.
    [[nodiscard]] Verdict stays(TapPosition at) const;
    [[nodiscard]] TapPosition clamped(TapPosition at) const {
        return {clamp(at.xPx, view_.xPx + 1.0, view_.xPx + view_.widthPx - 1.0),
                clamp(at.yPx, view_.yPx + 1.0, view_.yPx + view_.heightPx - 1.0)};
    }
    [[nodiscard]] OtherFaces elsewhere(TapPosition at) const {
        return otherFaces(input_.views, input_.view, plane_, at.xPx, at.yPx);
    }

    const PcssInput& input_;
    const ReceiverPlane& plane_;
    const ShadowViewModel& view_;
    Comparison comparison_;
    Region region_;
};

Verdict Pcss::stays(TapPosition at) const {
    if (!hasFaces()) return Verdict::Must;
    const auto inside = [](Interval px, double from, double to) { return both(atLeast(px, from), atLeast(-px, -to)); };
    return both(inside(at.xPx, view_.xPx + 1.0, view_.xPx + view_.widthPx - 1.0),
                inside(at.yPx, view_.yPx + 1.0, view_.yPx + view_.heightPx - 1.0));
}

/// A texel `aside` from the receiver in the units of the region. A blocker must lie within its own region.
SearchTexel Pcss::searchTexel(Verdict lit, Interval aside, Interval deviceDepth) const {
    const Interval reach = region_.at(deviceDepth) + 1.5 / rounded(region_.largestScale);
    return {lit, atLeast(reach - aside, 0.0), deviceDepth};
}

SearchAlternative Pcss::fourTexels(Interval aside, int firstX, int firstY) const {
    SearchAlternative texels;
    for (int y = firstY; y <= firstY + 1; ++y)
        for (int x = firstX; x <= firstX + 1; ++x)
            texels.push_back(searchTexel(comparison_.lit(x, y), aside, comparison_.stored(x, y)));
    return texels;
}

SearchTap Pcss::searchTap(int index, Interval spread) const {
    SearchTap tap;
    const Interval share = rounded((index + 0.5) / input_.taps.search);
    const Interval radius = share * share * (region_.search + spread);
    const Interval aside = max(radius - spread, 0.0);
    const TapPosition at = tapPosition(view_, plane_, input_.directions[index], radius);
    const Verdict staying = stays(at);
    if (staying != Verdict::Never) {
        const TapPosition kept = clamped(at);
        // Of a footprint that begins right on a texel's centre, the one before is as good.
        const auto first = [](Interval px) { return Interval(px.lo - 0.5 - kOnCentrePx, px.hi - 0.5); };
        const TexelRange across = texelsOf(first(kept.xPx), view_.xPx, view_.widthPx - 1);
        const TexelRange down = texelsOf(first(kept.yPx), view_.yPx, view_.heightPx - 1);
        for (int y = down.from; y <= down.to; ++y)
            for (int x = across.from; x <= across.to; ++x) tap.alternatives.push_back(fourTexels(aside, x, y));
    }
    if (staying == Verdict::Must) return tap;
    const OtherFaces others = elsewhere(at);
    if (others.unknown) tap.alternatives.push_back({SearchTexel{Verdict::May, Verdict::May, {0.0, 1.0}, 4}});
    for (const OtherTexel& other : others.texels) {
        const ShadowViewModel& view = input_.views[other.face];
        const double stored = input_.atlases[view.atlas].at(view.layer, other.x, other.y);
        SearchTexel texel = searchTexel(isLit(view, stored, other.depth), aside, inOwnView(view_, view, other, stored));
        texel.count = 4;
        tap.alternatives.push_back({texel});
    }
    return tap;
}

Visibility Pcss::filterTap(TapPosition at) const {
    const Verdict staying = stays(at);
    Visibility result = kNone;
    if (staying != Verdict::Never) {
        const TapPosition kept = clamped(at);
        result = pcfAt(comparison_, 0, kept.xPx, kept.yPx);
    }
    if (staying == Verdict::Must) return result;
    const OtherFaces others = elsewhere(at);
    if (others.unknown) return kAny;
    for (const OtherTexel& other : others.texels) {
        const ShadowViewModel& view = input_.views[other.face];
        const double stored = input_.atlases[view.atlas].at(view.layer, other.x, other.y);
        result = merge(result, visibilityOf(isLit(view, stored, other.depth)));
    }
    return result;
}

Visibility Pcss::filterAtRadius(Interval radius, int taps) const {
    Visibility sum = kDark;
    for (int i = 0; i < taps; ++i) {
        const Interval share = rounded(std::sqrt((i + 0.5) / taps), 10);
        const Visibility tap = filterTap(tapPosition(view_, plane_, input_.directions[i], share * radius));
        sum.min += tap.min;
        sum.max += tap.max;
    }
    return {sum.min / taps, sum.max / taps};
}

/// All taps share one radius, so an interval of radii is looked at in pieces.
Visibility Pcss::filtered(Interval radiusPx) const {
    const int pieces = static_cast<int>(std::clamp(std::ceil(radiusPx.width() / kPiecePx), 1.0, kMaxPieces));
    Visibility result = kNone;
    for (int i = 0; i < pieces; ++i) {
        const double step = radiusPx.width() / pieces;
        const Interval piece = {radiusPx.lo + i * step, radiusPx.lo + (i + 1) * step};
        const int all = input_.taps.filter;
        const TapRange taps = input_.tapsByRadius ? tapsForRadius(all, piece) : TapRange{all, all};
        for (int count = taps.from; count <= taps.to; ++count)
            result = merge(result, filterAtRadius(piece / rounded(region_.largestScale), count));
    }
    return result;
}

Interval Pcss::radiusPxOf(Interval meanDepth) const {
    const Interval texel = 1.0 / rounded(region_.largestScale);
    const Interval radius = min(max(region_.at(meanDepth), texel), max(region_.widest, texel));
    return radius * rounded(region_.largestScale);
}

PcssSearch Pcss::search(Interval spreadMetres) const {
    const Interval spread = view_.orthographic ? spreadMetres : spreadMetres / plane_.linearDepth;
    std::vector<SearchTap> taps;
    for (int i = 0; i < input_.taps.search; ++i) taps.push_back(searchTap(i, spread));
    const SearchOutcome outcome = searchOutcome(taps);
    PcssSearch result = {outcome.mayBeDark, outcome.mayBeLit, outcome.mayBePartial, {}};
    if (outcome.mayBePartial) result.radiusPx = radiusPxOf(rounded(outcome.meanDepth, 2.0 * input_.taps.search + 8));
    return result;
}

Visibility Pcss::run() const {
    const PcssSearch found = search(0.0);
    Visibility result = kNone;
    if (found.mayBeDark) result = merge(result, kDark);
    if (found.mayBeLit) result = merge(result, kLit);
    if (result.min == 0 && result.max == 1) return result;
    if (found.mayBePartial) result = merge(result, filtered(found.radiusPx));
    return result;
}

}  // namespace

std::vector<DiskDirection> diskDirections(std::uint32_t x, std::uint32_t y, std::uint32_t turn, int count) {
    const std::uint32_t hash = x * 3242174889u + y * 2447445414u + turn;
    const Interval f = static_cast<double>((hash << 2) >> 8) / 16777216.0;
    const Interval t = (2.0 * f - 1.0) * double(0.41421356f);
    Interval cosine = (1.0 - t * t) / (1.0 + t * t), sine = 2.0 * t / (1.0 + t * t);
    for (std::uint32_t quarter = hash >> 30; quarter > 0; --quarter) {
        const Interval before = cosine;
        cosine = -sine;
        sine = before;
    }
    // Intervals would grow with the turn, as boxes do that are turned and boxed again. An error's length does not.
    const double error = cosine.width() + sine.width() + 8 * kFloatRoundoff, c = cosine.middle(), s = sine.middle();
    const double golden = kPi * (3 - std::sqrt(5.0));
    std::vector<DiskDirection> result;
    for (int i = 0; i < count; ++i) {
        const double x = std::cos(i * golden), y = std::sin(i * golden);
        result.push_back({within(c * x - s * y, error), within(s * x + c * y, error)});
    }
    return result;
}

TapRange tapsForRadius(int most, Interval radiusPx) {
    const Interval wanted = double(most) * (rounded(5.0 / 12.0) + radiusPx * radiusPx * (1.0 / 32.0));
    const auto taps = [&](double value) { return std::min(static_cast<int>(std::min(value, 64.0)) + 1, most); };
    return {taps(wanted.lo), taps(wanted.hi)};
}

Visibility pcssAt(const PcssInput& input, const ReceiverPlane& plane) {
    return Pcss(input, plane).run();
}

PcssSearch pcssSearchAt(const PcssInput& input, const ReceiverPlane& plane, Interval spreadMetres) {
    return Pcss(input, plane).search(spreadMetres);
}

Visibility pcssFilterAt(const PcssInput& input, const ReceiverPlane& plane, Interval radiusPx) {
    return Pcss(input, plane).filtered(radiusPx);
}

}  // namespace gnomon::reference
