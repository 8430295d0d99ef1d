// See pcss_quad.h.
#include "reference/pcss_quad.h"

#include "reference/cascades.h"
#include "reference/find_lights_accurate.h"
#include "reference/receiver_views.h"

namespace gnomon::reference {
namespace {

constexpr double kFlatness = 0.25;
constexpr double kRadiusParts = 1024, kMostParts = gpu::kQuadMostRadius;

/// A shadow view that a pixel may take alone, unblended.
struct ViewTaken {
    std::size_t view = 0;
    Verdict verdict = Verdict::May;
};

std::vector<ViewTaken> cascadesTaken(std::span<const ShadowViewModel> cascades, const Pixel& pixel) {
    std::vector<ViewTaken> result;
    Verdict noneBefore = Verdict::Must;
    for (std::size_t i = 0; i < cascades.size(); ++i) {
        const CascadeFit fit = fitIn(cascades[i], pixel);
        if (fit.holds == Verdict::Never) continue;
        const bool last = i + 1 == cascades.size();
        const Verdict next = last ? Verdict::Must : fitIn(cascades[i + 1], pixel).holds;
        Verdict alone = Verdict::Never;
        if (fit.blend.lo <= 0 || next != Verdict::Must) alone = Verdict::May;
        if (fit.blend.hi <= 0 || next == Verdict::Never) alone = Verdict::Must;
        const Verdict verdict = both(both(fit.holds, alone), noneBefore);
        if (verdict != Verdict::Never) result.push_back({i, verdict});
        if (fit.holds == Verdict::Must) break;
        noneBefore = Verdict::May;
    }
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
    [[nodiscard]] Vec3 awayOf(const Pixel& pixel) const { return pixel.position - middle_.position; }
    [[nodiscard]] double awayError(const Pixel& pixel) const {
        return asking_.size() == 1 ? 0.0 : pixel.positionError + middle_.positionError;
    }
    void search(QuadFinding& out, std::size_t view) const;

    const LightModel& light_;
    const ShadowInput& input_;
    std::vector<const Pixel*> asking_;
    Pixel middle_;
    Interval distance_ = 0.0;  ///< of the farthest from the middle, metres
};

void Sharing::findMiddle() {
    const Pixel& first = *asking_.front();
    middle_ = first;
    middle_.x = first.x & ~1u;
    middle_.y = first.y & ~1u;
    if (asking_.size() == 1) return;
    const double count = static_cast<double>(asking_.size());
    Vec3 sum;
    double error = 0, magnitude = 0;
    for (const Pixel* pixel : asking_) {
        sum = sum + pixel->position;
        error += pixel->positionError;
        magnitude += sumOfMagnitudes(pixel->position);
        if (pixel->offPlaneMetres <= middle_.offPlaneMetres) continue;
        middle_.offPlaneMetres = pixel->offPlaneMetres;
        middle_.offPlaneError = std::max(middle_.offPlaneError, pixel->offPlaneError);
    }
    middle_.position = sum / count;
    middle_.positionError = (error + 5 * kFloatRoundoff * magnitude) / count;
    for (const Pixel* pixel : asking_)
        distance_ = max(distance_, max(rounded(within(length(awayOf(*pixel)), awayError(*pixel)), 8), 0.0));
}

Verdict Sharing::isFlat() const {
    if (ignoresFaceNormals(input_)) return Verdict::Must;
    Interval off = 0.0;
    for (const Pixel* pixel : asking_) {
        const Vec3 away = awayOf(*pixel);
        const double error = awayError(*pixel) + 16 * kFloatRoundoff * length(away);
        off = max(off, abs(within(dot(pixel->faceNormal, away), error)));
    }
    const Interval most = kFlatness * distance_ + 2.0 * within(middle_.offPlaneMetres, middle_.offPlaneError);
    if (off.hi <= most.lo) return Verdict::Must;
    return off.lo > most.hi ? Verdict::Never : Verdict::May;
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
            if (found.mayBePartial) out.radiiPx.push_back(roundedToParts(found.radiusPx));
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
