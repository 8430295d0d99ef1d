// See generate_shadows.h.
#include "reference/generate_shadows.h"

#include "gpu_interface/numbers.h"
#include "reference/cascades.h"

namespace gnomon::reference {
namespace {

constexpr double kRoundings = 8;

/// Does the pixel look at the light: c > 0?
struct Facing {
    bool mayFace = false, mayFaceAway = false;
};
Facing facingOf(const LightModel& light, const Pixel& pixel) {
    double cosine = 0, error = kRoundings * kFloatRoundoff;
    if (light.type == LightType::Directional) {
        cosine = dot(pixel.faceNormal, -light.direction);
    } else {
        const Vec3 toLight = light.position - pixel.position;
        const double distance = std::max(length(toLight), 1e-12);
        cosine = dot(pixel.faceNormal, toLight) / distance;
        error = 2 * error + 2 * pixel.positionError / distance;
    }
    return {cosine > -error, cosine <= error};
}

Visibility sampleView(const LightModel& light, std::size_t which, const Pixel& pixel, const ShadowInput& input,
                      bool faces, std::span<const DiskDirection> directions) {
    const auto views = std::span(input.views).subspan(light.firstShadowView, light.viewCount());
    const ShadowViewModel& view = views[which];
    const Bias bias = {.metres = light.biasMetres,
                       .leastMetres = pixel.subsurface ? input.subsurfaceBiasMetres : 0.0,
                       .none = input.bias == BiasMode::Unbiased};
    const DepthMode mode = input.bias == BiasMode::Oriented ? DepthMode::Plane : DepthMode::Constant;
    const ReceiverInView receiver = receiverIn(view, pixel, mode, bias, faces || pixel.subsurface);
    if (receiver.unknown) return kAny;
    Visibility result = receiver.mayBeBehind ? kLit : kNone;
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
                // Perspective: metres; orthographic: a tangent. Both came through one rounding to float.
                result = merge(result, pcssAt({views, input.atlases, which, rounded(light.sourceRadius, 1),
                                               input.pcssPresets[light.pcssPreset], directions},
                                              plane));
                break;
            case Filter::Host:
                return kAny;
        }
    }
    return result;
}

/// Faces that may be taken: the largest component, and those that float errors could put before it.
std::vector<std::size_t> facesOf(const LightModel& light, const Pixel& pixel) {
    if (!light.sixFaces) return {0};
    const Vec3 v = pixel.position - light.position;
    const double error =
        2 * pixel.positionError + kRoundings * kFloatRoundoff * (sumOfMagnitudes(light.position) + sumOfMagnitudes(v));
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    std::vector<std::size_t> result;
    for (int axis = 0; axis < 3; ++axis) {
        const double value = component(v, axis);
        if (std::abs(value) < largest - error) continue;
        if (value >= -error) result.push_back(2 * axis);
        if (value <= error) result.push_back(2 * axis + 1);
    }
    return result;
}

Visibility sampleLight(const LightModel& light, const Pixel& pixel, const ShadowInput& input, bool faces,
                       std::span<const DiskDirection> directions) {
    const auto sample = [&](std::size_t which) { return sampleView(light, which, pixel, input, faces, directions); };
    if (light.type == LightType::Directional) {
        const auto cascades = std::span(input.views).subspan(light.firstShadowView, light.viewCount());
        return throughCascades(cascades, pixel, sample);
    }
    Visibility result = kNone;
    for (const std::size_t face : facesOf(light, pixel)) result = merge(result, sample(face));
    return result;
}

}  // namespace

Visibility visibility(const LightModel& light, const Pixel& pixel, const ShadowInput& input) {
    if (!light.casts || light.firstShadowView == kNoShadowViews || input.shadowsOff) return kLit;
    if (!pixel.hasFaceNormal && (input.bias != BiasMode::Unbiased || input.facedAwayIsDark)) return kAny;
    const Facing facing = facingOf(light, pixel);
    const bool sampleAway = !input.facedAwayIsDark && !pixel.subsurface;
    if (!pixel.subsurface && !facing.mayFace && !sampleAway) return kDark;
    std::vector<DiskDirection> directions;
    if (light.filter == Filter::Pcss) {
        const PcssTapCounts taps = input.pcssPresets[light.pcssPreset];
        directions = diskDirections(pixel.x, pixel.y, input.patternTurn, std::max(taps.search, taps.filter));
    }
    Visibility result = kNone;
    if (facing.mayFace || pixel.subsurface) result = sampleLight(light, pixel, input, true, directions);
    if (!facing.mayFaceAway || pixel.subsurface) return result;
    return merge(result, sampleAway ? sampleLight(light, pixel, input, false, directions) : kDark);
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

StoredVisibility storedVisibility(const LightModel& light, const Pixel& pixel, const ShadowInput& input) {
    if (!light.casts) return {input.levels(), input.levels()};
    return quantised(visibility(light, pixel, input), shadowFadeAt(light, pixel), input.levels());
}

}  // namespace gnomon::reference
