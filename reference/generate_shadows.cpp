// See generate_shadows.h.
#include "reference/generate_shadows.h"

#include "gpu_interface/numbers.h"

namespace gnomon::reference {
namespace {

constexpr double kRoundings = 8;
constexpr double kMaxPositionErrorPx = 2.0;
constexpr double kNearestLinearDepth = 1e-4;
constexpr Visibility kLit = {1, 1}, kDark = {0, 0}, kAny = {0, 1};

Visibility merge(Visibility a, Visibility b) {
    return {std::min(a.min, b.min), std::max(a.max, b.max)};
}

Visibility compareTexel(const ShadowViewModel& view, const AtlasCopy& atlas, int x, int y, double deviceDepth,
                        double depthError) {
    const double stored = atlas.at(view.layer, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
    // How much farther from the light the stored surface is.
    const double behind = view.reversed ? deviceDepth - stored : stored - deviceDepth;
    switch (atLeastZero(behind, depthError)) {
        case Verdict::Must:
            return kLit;
        case Verdict::Never:
            return kDark;
        case Verdict::May:
            return kAny;
    }
    return kAny;
}

Visibility hardAt(const ShadowViewModel& view, const AtlasCopy& atlas, double xPx, double yPx, double errorPx,
                  double deviceDepth, double depthError) {
    const auto texel = [](double px, int first, int size) {
        return std::clamp(static_cast<int>(std::floor(px)), first, first + size - 1);
    };
    Visibility result = {1, 0};
    for (int y = texel(yPx - errorPx, view.yPx, view.heightPx); y <= texel(yPx + errorPx, view.yPx, view.heightPx); ++y)
        for (int x = texel(xPx - errorPx, view.xPx, view.widthPx); x <= texel(xPx + errorPx, view.xPx, view.widthPx);
             ++x)
            result = merge(result, compareTexel(view, atlas, x, y, deviceDepth, depthError));
    return result;
}

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

Visibility pcfExactlyAt(const ShadowViewModel& view, const AtlasCopy& atlas, int radius, double xPx, double yPx,
                        double deviceDepth, double depthError) {
    const AxisWeights across = axisWeights(xPx, radius), down = axisWeights(yPx, radius);
    Visibility sum = {0, 0};
    for (std::size_t j = 0; j < down.weights.size(); ++j) {
        for (std::size_t i = 0; i < across.weights.size(); ++i) {
            const double weight = across.weights[i] * down.weights[j];
            if (weight == 0.0) continue;
            const Visibility texel = compareTexel(view, atlas, across.first + static_cast<int>(i),
                                                  down.first + static_cast<int>(j), deviceDepth, depthError);
            sum.min += weight * texel.min;
            sum.max += weight * texel.max;
        }
    }
    const double all = (2.0 * radius + 1.0) * (2.0 * radius + 1.0);
    return {sum.min / all, sum.max / all};
}

/// The ends of [px - error, px + error], clamped to where the kernel's support (radius + 1 to each side) fits, and the
/// texel centres between them: the filter is bilinear between texel centres, so it takes its extremes there.
std::vector<double> extremePositions(double px, double error, int radius, int first, int size) {
    const double lowest = first + radius + 1.0, highest = first + size - radius - 1.0;
    const double from = std::clamp(px - error, lowest, highest), to = std::clamp(px + error, lowest, highest);
    std::vector<double> result = {from, to};
    for (double centre = std::floor(from) + 0.5; centre < to; centre += 1.0)
        if (centre > from) result.push_back(centre);
    return result;
}

Visibility pcfAt(const ShadowViewModel& view, const AtlasCopy& atlas, int radius, double xPx, double yPx,
                 double errorPx, double deviceDepth, double depthError) {
    Visibility result = {1, 0};
    for (const double y : extremePositions(yPx, errorPx, radius, view.yPx, view.heightPx))
        for (const double x : extremePositions(xPx, errorPx, radius, view.xPx, view.widthPx))
            result = merge(result, pcfExactlyAt(view, atlas, radius, x, y, deviceDepth, depthError));
    return result;
}

/// What the pixel's direction to the light is, and how sure.
struct Facing {
    Vec3 normal;
    double cosine = 0, cosineError = 0;
};
Facing facingOf(const LightModel& light, const Pixel& pixel) {
    Facing facing;
    facing.normal = pixel.faceNormal;
    if (light.type == LightType::Directional) {
        facing.cosine = dot(pixel.faceNormal, -light.direction);
        facing.cosineError = kRoundings * kFloatRoundoff;
        return facing;
    }
    const Vec3 toLight = light.position - pixel.position;
    const double distance = std::max(length(toLight), 1e-12);
    facing.cosine = dot(pixel.faceNormal, toLight) / distance;
    facing.cosineError = 2 * kRoundings * kFloatRoundoff + 2 * pixel.positionError / distance;
    return facing;
}

/// |n.X| + |n.Y| for the view's lateral axes X and Y: how steeply a plane with normal n rises across the view's texels.
double slantOf(const ShadowViewModel& view, Vec3 normal) {
    const Vec3 x = rowOf(view.clipFromWorld, 0), y = rowOf(view.clipFromWorld, 1);
    return std::abs(dot(normal, x)) / length(x) + std::abs(dot(normal, y)) / length(y);
}

Visibility sampleView(const ShadowViewModel& view, const LightModel& light, const Pixel& pixel, const Facing& facing,
                      double sign, const ShadowInput& input) {
    const ShadowPosition first = project(view, pixel.position, pixel.positionError);
    if (first.clipW < -first.clipWError) return kLit;
    const int radius = input.filter == ShadowFilter::Pcf ? input.pcfRadius : 0;
    const double texel = view.orthographic ? view.texelMetres : view.texelMetres * std::max(first.linearDepth, 0.0);
    const double texelError = (view.orthographic ? 0.0 : view.texelMetres * first.linearDepthError) + 1e-6 * texel;
    const double slant = std::max(slantOf(view, facing.normal), 0.1);
    const double offset = texel * (radius + 1.0) * slant;
    const double offsetError = (radius + 1.0) * (texel * kRoundings * kFloatRoundoff + texelError * slant);
    const Vec3 moved = pixel.position + facing.normal * (sign * offset);
    const double movedError =
        pixel.positionError + offsetError + kRoundings * kFloatRoundoff * (offset + sumOfMagnitudes(moved));

    const ShadowPosition at = project(view, moved, movedError);
    if (at.clipW < -at.clipWError) return kLit;
    const double errorPx = std::max(at.xErrorPx, at.yErrorPx);
    if (at.clipW <= at.clipWError || !(errorPx <= kMaxPositionErrorPx)) return kAny;
    double bias = light.biasMetres;
    if (pixel.subsurface) bias = std::max(bias, input.subsurfaceBiasMetres);
    double linear = at.linearDepth - bias;
    double device = view.depth.a + view.depth.b * linear;
    double slope = std::abs(view.depth.b);
    const double linearError = at.linearDepthError + kRoundings * kFloatRoundoff * (std::abs(at.linearDepth) + bias);
    if (!view.orthographic) {
        linear = std::max(linear, kNearestLinearDepth);
        device = view.depth.a + view.depth.b / linear;
        slope /= linear * linear;
    }
    device += (view.reversed ? 1e-6 : -1e-6) * (std::abs(view.depth.a) + std::abs(device - view.depth.a));
    const double depthError =
        slope * linearError + kRoundings * kFloatRoundoff * (std::abs(view.depth.a) + std::abs(device - view.depth.a));
    return filterAt(view, input.atlases[view.atlas], input.filter, radius, at.xPx, at.yPx, errorPx, device, depthError);
}

/// Faces of a point light that may be taken: the largest component, and those that float errors could put before it.
std::vector<std::uint32_t> faces(const LightModel& light, const Pixel& pixel) {
    if (light.type != LightType::Point) return {0};
    const Vec3 v = pixel.position - light.position;
    const double error =
        2 * pixel.positionError + kRoundings * kFloatRoundoff * (sumOfMagnitudes(light.position) + sumOfMagnitudes(v));
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    std::vector<std::uint32_t> result;
    for (int axis = 0; axis < 3; ++axis) {
        const double value = component(v, axis);
        if (std::abs(value) < largest - error) continue;
        if (value >= -error) result.push_back(2 * axis);
        if (value <= error) result.push_back(2 * axis + 1);
    }
    return result;
}

}  // namespace

Visibility filterAt(const ShadowViewModel& view, const AtlasCopy& atlas, ShadowFilter filter, int radius, double xPx,
                    double yPx, double positionErrorPx, double deviceDepth, double depthError) {
    if (filter == ShadowFilter::Off) return kLit;
    if (filter == ShadowFilter::Hard) return hardAt(view, atlas, xPx, yPx, positionErrorPx, deviceDepth, depthError);
    return pcfAt(view, atlas, radius, xPx, yPx, positionErrorPx, deviceDepth, depthError);
}

Visibility visibility(const LightModel& light, const Pixel& pixel, const ShadowInput& input) {
    if (!light.casts || light.firstShadowView == kNoShadowViews || input.filter == ShadowFilter::Off) return kLit;
    if (!pixel.hasFaceNormal) return kAny;
    const Facing facing = facingOf(light, pixel);
    if (!pixel.subsurface && facing.cosine < -facing.cosineError) return kDark;
    const bool mayFace = facing.cosine >= -facing.cosineError;
    const bool mayFaceAway = facing.cosine <= facing.cosineError;
    Visibility result = {1, 0};
    for (const std::uint32_t face : faces(light, pixel)) {
        const ShadowViewModel& view = input.views[light.firstShadowView + face];
        if (mayFace) result = merge(result, sampleView(view, light, pixel, facing, 1.0, input));
        if (mayFaceAway && pixel.subsurface)
            result = merge(result, sampleView(view, light, pixel, facing, -1.0, input));
    }
    if (mayFaceAway && !pixel.subsurface) result = merge(result, kDark);
    return result;
}

StoredVisibility quantised(Visibility range, double shadowFade) {
    const bool exactFade = shadowFade == 0.0 || shadowFade == 1.0;
    const double fadeError = exactFade ? 0.0 : 1e-5;
    // Sums of weights in floats: up to 64 terms. Nothing is left to err where all texels agree.
    const auto stored = [&](double v, double direction) {
        const double sumError = v == 0.0 || v == 1.0 ? 0.0 : 64 * kFloatRoundoff;
        const double faded = 1.0 - shadowFade * (1.0 - v) + direction * (sumError + fadeError);
        const double root = 255.0 * std::sqrt(std::clamp(faded, 0.0, 1.0)) + direction * 1e-3;
        return std::clamp(static_cast<int>(std::floor(root + 0.5)), 0, 255);
    };
    return {stored(range.min, -1.0), stored(range.max, 1.0)};
}

StoredVisibility storedVisibility(const LightModel& light, const Pixel& pixel, const ShadowInput& input) {
    if (!light.casts) return {255, 255};
    return quantised(visibility(light, pixel, input), light.shadowFade);
}

}  // namespace gnomon::reference
