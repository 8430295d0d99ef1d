// See receiver_views.h.
#include "reference/receiver_views.h"

namespace gnomon::reference {
namespace {

constexpr double kFacingRoundings = 8;

}  // namespace

Facing facingOf(const LightModel& light, const Pixel& pixel) {
    double cosine = 0, error = kFacingRoundings * kFloatRoundoff;
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

bool ignoresFaceNormals(const ShadowInput& input) {
    return input.bias == BiasMode::Unbiased && !input.facedAwayIsDark;
}

std::vector<std::size_t> facesOf(const LightModel& light, const Pixel& pixel) {
    if (!light.sixFaces) return {0};
    const Vec3 v = pixel.position - light.position;
    const double error = 2 * pixel.positionError +
                         kFacingRoundings * kFloatRoundoff * (sumOfMagnitudes(light.position) + sumOfMagnitudes(v));
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

ReceiverInView receiverInView(const LightModel& light, std::size_t which, const Pixel& pixel, const ShadowInput& input,
                              bool toward) {
    const Bias bias = {.metres = light.biasMetres,
                       .leastMetres = pixel.subsurface ? input.subsurfaceBiasMetres : 0.0,
                       .none = input.bias == BiasMode::Unbiased};
    const DepthMode mode = input.bias == BiasMode::Oriented ? DepthMode::Plane : DepthMode::Constant;
    return receiverIn(input.views[light.firstShadowView + which], pixel, mode, bias, toward);
}

}  // namespace gnomon::reference
