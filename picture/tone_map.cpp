#include <algorithm>
#include <array>
#include <cmath>

#include "picture/picture.h"

namespace gnomon::renderer {
namespace {

constexpr float kMiddleGrey = 0.18f;
constexpr float kSaturation = 1.2f;  // a saturation-based meter clips at 1.2 * 2^EV100 (Frostbite, section 5.1)
constexpr float kWhite = 4.0f;       // exposed luminance that becomes 1
constexpr float kLargest = 1.0e30f;  // stands for infinity, so that products stay finite

float luminance(const float* rgba) {
    return 0.2126f * rgba[0] + 0.7152f * rgba[1] + 0.0722f * rgba[2];
}

// Not a number is black, infinity very bright, a negative component none.
float sane(float value) {
    return std::isnan(value) ? 0.0f : std::clamp(value, 0.0f, kLargest);
}

// Extended Reinhard on luminance, divided by the luminance itself.
float compressed(float exposed) {
    return (1.0f + exposed / (kWhite * kWhite)) / (1.0f + exposed);
}

std::uint8_t encodeSrgb(float linear) {
    const float v = std::min(linear, 1.0f);
    const float encoded = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
    return static_cast<std::uint8_t>(std::lround(255.0f * encoded));
}

}  // namespace

std::uint64_t clippedPixels(const HdrPicture& picture) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i + 4 <= picture.rgba.size(); i += 4)
        count += std::max({picture.rgba[i], picture.rgba[i + 1], picture.rgba[i + 2]}) >= picture.brightest ? 1 : 0;
    return count;
}

float automaticExposure(const HdrPicture& picture) {
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i + 4 <= picture.rgba.size(); i += 4) {
        if (picture.rgba[i + 3] == 0.0f) continue;
        const float value = luminance(&picture.rgba[i]);
        if (!std::isfinite(value) || value <= 0.0f) continue;
        sum += std::log2(static_cast<double>(value));
        ++count;
    }
    if (count == 0) return 0.0f;
    return static_cast<float>(sum / static_cast<double>(count)) - std::log2(kMiddleGrey * kSaturation);
}

Picture toneMap(const HdrPicture& picture, float exposureEv100) {
    const float exposure = 1.0f / (kSaturation * std::exp2(exposureEv100));
    Picture out{picture.width, picture.height, {}};
    out.rgb.resize(std::size_t{3} * picture.width * picture.height);
    for (std::size_t p = 0; p < out.rgb.size() / 3; ++p) {
        std::array<float, 3> exposed{};
        for (std::size_t c = 0; c < 3; ++c) exposed[c] = std::min(sane(picture.rgba[4 * p + c]) * exposure, kLargest);
        const float scale = compressed(luminance(exposed.data()));
        for (std::size_t c = 0; c < 3; ++c) out.rgb[3 * p + c] = encodeSrgb(exposed[c] * scale);
    }
    return out;
}

}  // namespace gnomon::renderer
