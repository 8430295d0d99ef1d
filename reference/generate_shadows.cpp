// See generate_shadows.h.
#include "reference/generate_shadows.h"

#include "gpu_interface/numbers.h"
#include "reference/cascades.h"
#include "reference/pcss_quad.h"
#include "reference/receiver_views.h"

namespace gnomon::reference {
namespace {

/// One light at one pixel.
struct Sampler {
    const LightModel& light;
    const Pixel& pixel;
    const ShadowInput& input;
    const QuadFinding* quad = nullptr;  ///< of Filter::PcssShared
    std::vector<DiskDirection> directions;

    [[nodiscard]] std::span<const ShadowViewModel> views() const {
        return std::span(input.views).subspan(light.firstShadowView, light.viewCount());
    }
    [[nodiscard]] Visibility soft(std::size_t which, const ReceiverPlane& plane) const;
    [[nodiscard]] Visibility sampleView(std::size_t which, bool faces) const;
    [[nodiscard]] Visibility sampleLight(bool faces) const;
};

Visibility Sampler::soft(std::size_t which, const ReceiverPlane& plane) const {
    // Perspective: metres; orthographic: a tangent. Both came through one rounding to float.
    PcssTapCounts taps = input.pcssPresets[light.pcssPreset];
    if (quad != nullptr) taps.search = (taps.search + 1) / 2;
    const PcssInput pcss = {views(), input.atlases, which,          rounded(light.sourceRadius, 1),
                            taps,    directions,    quad != nullptr};
    if (quad == nullptr) return pcssAt(pcss, plane);
    Visibility result = quad->mayBeOwn ? pcssAt(pcss, plane) : kNone;
    const auto texelsPerUnit = [&](std::size_t view) {
        return rounded(std::max(views()[view].pxPerMetreX, views()[view].pxPerMetreY));
    };
    for (const QuadFinding::Radius& radius : quad->radii) {
        Interval px = radius.px;
        if (radius.view != which) px = max(px * texelsPerUnit(which) / texelsPerUnit(radius.view), 1.0);
        result = merge(result, pcssFilterAt(pcss, plane, px));
    }
    return result;
}

Visibility Sampler::sampleView(std::size_t which, bool faces) const {
    const ReceiverInView receiver = receiverInView(light, which, pixel, input, faces || pixel.subsurface);
    if (receiver.unknown) return kAny;
    Visibility result = receiver.mayBeBehind ? kLit : kNone;
    const ShadowViewModel& view = views()[which];
    for (const ReceiverPlane& plane : receiver.planes) {
        const Comparison comparison = {view, input.atlases[view.atlas], plane};
        switch (light.filter) {
            case Filter::Hard:
                result = merge(result, hardAt(comparison, plane.xPx, plane.yPx));
                break;
            case Filter::Pcf:
                result = merge(result, pcfAt(comparison, input.pcfRadius, plane.xPx, plane.yPx));
                break;
            case Filter::Pcss:
            case Filter::PcssShared:
                result = merge(result, soft(which, plane));
                break;
            case Filter::Host:
                return kAny;
        }
    }
    return result;
}

Visibility Sampler::sampleLight(bool faces) const {
    const auto sample = [&](std::size_t which) { return sampleView(which, faces); };
    if (light.type == LightType::Directional) return throughCascades(views(), pixel, sample);
    Visibility result = kNone;
    for (const std::size_t face : facesOf(light, pixel)) result = merge(result, sample(face));
    return result;
}

/// Of a pixel that asks the light's shadowmaps.
Visibility asked(const Sampler& sampler, bool faces) {
    const QuadFinding* quad = sampler.quad;
    if (quad == nullptr) return sampler.sampleLight(faces);
    if (quad->unknown) return kAny;
    Visibility result = kNone;
    // The last cascade blends even what is dark into light.
    const bool cascades = sampler.light.type == LightType::Directional;
    const auto dark = [](std::size_t) { return kDark; };
    if (quad->mayBeDark)
        result = merge(result, cascades ? throughCascades(sampler.views(), sampler.pixel, dark) : kDark);
    if (quad->mayBeLit) result = merge(result, kLit);
    if (quad->mayBeOwn || !quad->radii.empty()) result = merge(result, sampler.sampleLight(faces));
    return result;
}

}  // namespace

Visibility visibility(const LightModel& light, const Pixel& pixel, const ShadowInput& input, const QuadFinding* quad) {
    if (!light.casts || light.firstShadowView == kNoShadowViews || input.shadowsOff) return kLit;
    if (!pixel.hasFaceNormal && !ignoresFaceNormals(input)) return kAny;
    const Facing facing = facingOf(light, pixel);
    const bool sampleAway = !input.facedAwayIsDark && !pixel.subsurface;
    if (!pixel.subsurface && !facing.mayFace && !sampleAway) return kDark;
    Sampler sampler = {light, pixel, input, nullptr, {}};
    QuadFinding alone;
    if (light.filter == Filter::PcssShared) {
        if (quad == nullptr) alone = findQuad(light, {&pixel}, input);
        sampler.quad = quad == nullptr ? &alone : quad;
    }
    if (isSoft(light.filter)) {
        const PcssTapCounts taps = input.pcssPresets[light.pcssPreset];
        sampler.directions = diskDirections(pixel.x, pixel.y, input.patternTurn, std::max(taps.search, taps.filter));
    }
    Visibility result = kNone;
    if (facing.mayFace || pixel.subsurface) result = asked(sampler, true);
    if (!facing.mayFaceAway || pixel.subsurface) return result;
    return merge(result, sampleAway ? asked(sampler, false) : kDark);
}

Interval shadowFadeAt(const LightModel& light, const Pixel& pixel) {
    if (light.type != LightType::Directional) {
        const bool exact = light.shadowFade == 0.0 || light.shadowFade == 1.0;
        return within(light.shadowFade, exact ? 0.0 : 1e-5);
    }
    if (!light.shadowFades) return 1.0;
    const Interval distance = within(pixel.eyeDistance, pixel.eyeDistanceError);
    return clamp(rounded(light.shadowFadeScale) * distance + rounded(light.shadowFadeOffset), 0.0, 1.0);
}

StoredVisibility quantised(Visibility range, Interval shadowFade, int levels) {
    // Sums of weights in floats: up to 64 terms. Nothing is left to err where all texels agree.
    const auto stored = [&](double v, double fade, double direction) {
        const bool exact = v == 0.0 || v == 1.0;
        const double error = exact && (fade == 0.0 || fade == 1.0) ? 0.0 : 64 * kFloatRoundoff;
        const double faded = 1.0 - fade * (1.0 - v) + direction * error;
        const double root = levels * std::sqrt(std::clamp(faded, 0.0, 1.0)) + direction * 4e-6 * levels;
        return std::clamp(static_cast<int>(std::floor(root + 0.5)), 0, levels);
    };
    return {stored(range.min, shadowFade.hi, -1.0), stored(range.max, shadowFade.lo, 1.0)};
}

StoredVisibility storedVisibility(const LightModel& light, const Pixel& pixel, const ShadowInput& input,
                                  const QuadFinding* quad) {
    if (!light.casts) return {input.levels(), input.levels()};
    return quantised(visibility(light, pixel, input, quad), shadowFadeAt(light, pixel), input.levels());
}

}  // namespace gnomon::reference
