// See pcss_quad.h.
#include "reference/pcss_quad.h"

#include "reference/cascades.h"
#include "reference/find_lights_accurate.h"
#include "reference/receiver_views.h"

namespace gnomon::reference {
namespace {

constexpr double kFlatness = 0.25, kLeastCosine = double(0.97f);
constexpr double kRadiusParts = 1024, kMostParts = gpu::kQuadMostRadius;
constexpr std::size_t kNoView = ~std::size_t{0};

/// A shadow view that a pixel may take first, or kNoView.
struct ViewTaken {
    std::size_t view = 0;
    Verdict verdict = Verdict::May;
};

std::vector<ViewTaken> cascadesTaken(std::span<const ShadowViewModel> cascades, const Pixel& pixel) {
    std::vector<ViewTaken> result;
    Verdict noneBefore = Verdict::Must;
    for (std::size_t i = 0; i < cascades.size(); ++i) {
        const Verdict holds = fitIn(cascades[i], pixel).holds;
        if (holds == Verdict::Never) continue;
        result.push_back({i, both(holds, noneBefore)});
        if (holds == Verdict::Must) return result;
        noneBefore = Verdict::May;
    }
    result.push_back({kNoView, noneBefore});
    return result;
}

std::vector<ViewTaken> viewsTaken(const LightModel& light, const Pixel& pixel, const ShadowInput& input) {
    if (light.type == LightType::Directional)
        return cascadesTaken(std::span(input.views).subspan(light.firstShadowView, light.viewCount()), pixel);
    const std::vector<std::size_t> faces = facesOf(light, pixel);
    std::vector<ViewTaken> result;
    for (const std::size_t face : faces) result.push_back({face, faces.size() == 1 ? Verdict::Must : Verdict::May});
    return result;
}

Verdict asks(const LightModel& light, const Pixel& pixel, const ShadowInput& input) {
    const Verdict reached = inInfluence(light, pixel);
    if (reached == Verdict::Never || pixel.subsurface || !input.facedAwayIsDark) return reached;
    const Facing facing = facingOf(light, pixel);
    return both(reached, !facing.mayFace ? Verdict::Never : facing.mayFaceAway ? Verdict::May : Verdict::Must);
}

/// One combination of pixels that ask.
class Sharing {
public:
    Sharing(const LightModel& light, const ShadowInput& input, std::vector<const Pixel*> asking)
        : light_(light), input_(input), asking_(std::move(asking)) {
        findMiddle();
    }
    void addTo(QuadFinding& out) const;

private:
    void findMiddle();
    [[nodiscard]] Verdict isFlat() const;
    [[nodiscard]] Verdict allTake(std::size_t view) const;
    void search(QuadFinding& out, std::size_t view) const;

    const LightModel& light_;
    const ShadowInput& input_;
    std::vector<const Pixel*> asking_;
    Pixel middle_;
    Interval distance_ = 0.0;  ///< half the diagonal of the box around them, metres
};

void Sharing::findMiddle() {
    const Pixel& first = *asking_.front();
    middle_ = first;
    middle_.x = first.x & ~1u;
    middle_.y = first.y & ~1u;
    if (asking_.size() == 1) return;
    Vec3 low = first.position, high = first.position;
    double error = 0, magnitude = 0;
    for (const Pixel* pixel : asking_) {
        const Vec3& p = pixel->position;
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        error = std::max(error, pixel->positionError);
        magnitude = std::max(magnitude, sumOfMagnitudes(p));
        if (pixel->offPlaneMetres <= middle_.offPlaneMetres) continue;
        middle_.offPlaneMetres = pixel->offPlaneMetres;
        middle_.offPlaneError = std::max(middle_.offPlaneError, pixel->offPlaneError);
    }
    const Vec3 centre = 0.5 * (low + high);
    const double off = ignoresFaceNormals(input_) ? 0.0 : dot(first.faceNormal, centre - first.position);
    middle_.position = centre - off * first.faceNormal;
    middle_.positionError = 3 * error + 16 * kFloatRoundoff * magnitude;
    distance_ = max(rounded(within(0.5 * length(high - low), 2 * error), 8), 0.0);
}

Verdict Sharing::isFlat() const {
    if (ignoresFaceNormals(input_)) return Verdict::Must;
    const Pixel& first = *asking_.front();
    Verdict flat = Verdict::Must;
    double offPlane = first.offPlaneMetres, offPlaneError = first.offPlaneError;
    for (std::size_t i = 1; i < asking_.size(); ++i) {
        const Pixel& pixel = *asking_[i];
        offPlane = std::max(offPlane, pixel.offPlaneMetres);
        offPlaneError = std::max(offPlaneError, pixel.offPlaneError);
        const Vec3 away = pixel.position - first.position;
        const double error = pixel.positionError + first.positionError + 16 * kFloatRoundoff * length(away);
        const Interval off = abs(within(dot(first.faceNormal, away), error));
        const Interval most = kFlatness * within(length(away), error) + 2.0 * within(offPlane, offPlaneError);
        flat = both(flat, atLeast(most - off, 0.0));
        flat = both(flat, atLeast(within(dot(first.faceNormal, pixel.faceNormal), 1e-5), kLeastCosine));
    }
    return flat;
}

Verdict Sharing::allTake(std::size_t view) const {
    Verdict all = Verdict::Must;
    for (const Pixel* pixel : asking_) {
        Verdict own = Verdict::Never;
        for (const ViewTaken& taken : viewsTaken(light_, *pixel, input_))
            if (taken.view == view) own = taken.verdict;
        all = both(all, own);
    }
    return all;
}

Interval roundedToParts(Interval radiusPx) {
    const Interval parts = radiusPx * kRadiusParts + 0.5;
    const auto whole = [](double value) { return std::clamp(std::floor(value), 1.0, kMostParts) / kRadiusParts; };
    return rounded(Interval(whole(parts.lo), whole(parts.hi)));
}

void Sharing::search(QuadFinding& out, std::size_t view) const {
    if (view == kNoView) {
        out.mayBeLit = true;
        return;
    }
    const PcssTapCounts taps = input_.pcssPresets[light_.pcssPreset];
    const std::vector<DiskDirection> directions = diskDirections(middle_.x, middle_.y, input_.patternTurn, taps.search);
    const auto views = std::span(input_.views).subspan(light_.firstShadowView, light_.viewCount());
    const PcssInput pcss = {views, input_.atlases, view, rounded(light_.sourceRadius, 1), {taps.search, 0}, directions,
                            true};
    const Facing facing = facingOf(light_, middle_);
    const bool always = input_.facedAwayIsDark || middle_.subsurface;
    for (const bool toward : {true, false}) {
        if (toward ? !(always || facing.mayFace) : always || !facing.mayFaceAway) continue;
        const ReceiverInView receiver = receiverInView(light_, view, middle_, input_, toward);
        out.unknown = out.unknown || receiver.unknown;
        out.mayBeOwn = out.mayBeOwn || receiver.mayBeBehind;
        for (const ReceiverPlane& plane : receiver.planes) {
            const PcssSearch found = pcssSearchAt(pcss, plane, distance_);
            out.mayBeDark = out.mayBeDark || found.mayBeDark;
            out.mayBeLit = out.mayBeLit || found.mayBeLit;
            if (found.mayBePartial) out.radii.push_back({view, roundedToParts(found.radiusPx)});
        }
    }
}

void Sharing::addTo(QuadFinding& out) const {
    Verdict shares = Verdict::Never;
    const auto subsurface = std::count_if(asking_.begin(), asking_.end(), [](const Pixel* p) { return p->subsurface; });
    if (subsurface == 0 || subsurface == static_cast<std::ptrdiff_t>(asking_.size())) {
        const Verdict flat = isFlat();
        for (const ViewTaken& taken : viewsTaken(light_, *asking_.front(), input_)) {
            const Verdict here = both(flat, allTake(taken.view));
            if (here != Verdict::Never) search(out, taken.view);
            shares = either(shares, here);
        }
    }
    out.mayBeOwn = out.mayBeOwn || shares != Verdict::Must;
}

}  // namespace

QuadPixels quadOf(const PixelGrid& grid, std::uint32_t x, std::uint32_t y) {
    QuadPixels quad = {};
    for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t atX = (x & ~1u) + (i & 1u), atY = (y & ~1u) + (i >> 1);
        if (atX < grid.widthPx && atY < grid.heightPx) quad[i] = &grid.at(atX, atY);
    }
    return quad;
}

QuadFinding findQuad(const LightModel& light, const QuadPixels& quad, const ShadowInput& input) {
    QuadFinding out;
    std::array<Verdict, 4> asking = {};
    for (std::size_t i = 0; i < 4; ++i) {
        if (quad[i] == nullptr || quad[i]->background) continue;
        if (!quad[i]->hasFaceNormal && !ignoresFaceNormals(input)) {
            out.unknown = true;
            return out;
        }
        asking[i] = asks(light, *quad[i], input);
    }
    for (unsigned combination = 1; combination < 16; ++combination) {
        std::vector<const Pixel*> pixels;
        bool possible = true;
        for (std::size_t i = 0; i < 4; ++i) {
            const bool in = (combination >> i & 1u) != 0;
            possible = possible && asking[i] != (in ? Verdict::Never : Verdict::Must);
            if (in) pixels.push_back(quad[i]);
        }
        if (possible) Sharing(light, input, std::move(pixels)).addTo(out);
    }
    return out;
}

const QuadFinding* QuadFindings::at(std::uint32_t x, std::uint32_t y) {
    if (light_.filter != Filter::PcssShared || !light_.casts) return nullptr;
    const auto [found, fresh] = found_.try_emplace({x / 2, y / 2});
    if (fresh) found->second = findQuad(light_, quadOf(grid_, x, y), input_);
    return &found->second;
}

}  // namespace gnomon::reference
