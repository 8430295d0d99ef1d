#include "app/verify_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace gnomon::app {
namespace {

using renderer::HardTruth;
using renderer::PairError;
using renderer::PixelTruth;
using Colour = std::array<std::uint8_t, 3>;

constexpr std::size_t kMostNameLetters = 40;

Colour grey(float value) {
    const auto v = static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
    return {v, v, v};
}

constexpr Colour kNotCounted = {20, 20, 60};

Colour truthColour(const PixelTruth& truth) {
    switch (truth.hard) {
        case HardTruth::NotCounted:
            return kNotCounted;
        case HardTruth::Away:
            return {40, 30, 0};
        case HardTruth::Lit:
        case HardTruth::Dark:
            break;
    }
    if (truth.subset && truth.soft >= 0.0f) return grey(truth.soft);
    return grey(truth.hard == HardTruth::Lit ? 1.0f : 0.0f);
}

Colour errorColour(const PixelTruth& truth, float result, bool soft) {
    switch (renderer::errorOf(truth, result, soft)) {
        case PairError::NotCounted:
            return kNotCounted;
        case PairError::Acne:
            return {255, 0, 0};
        case PairError::Leak:
            return {0, 120, 255};
        case PairError::ContactLeak:
            return {255, 0, 255};
        case PairError::EdgeError:
            return {230, 200, 0};
        case PairError::None:
            break;
    }
    if (renderer::isFaintAcne(truth, result, soft)) return {255, 140, 120};
    if (renderer::isFaintLeak(truth, result, soft)) return {130, 200, 255};
    if (soft && truth.subset && truth.soft > 0.0f && truth.soft < 1.0f) {
        const auto off = static_cast<std::uint8_t>(std::lround(255.0f * std::min(std::abs(result - truth.soft), 1.0f)));
        return {30, static_cast<std::uint8_t>(std::max<int>(off, 60)), 30};
    }
    return grey(0.15f + 0.35f * result);
}

}  // namespace

renderer::Picture errorMap(std::span<const PixelTruth> truth, std::span<const float> result,
                           renderer::TruthExtent extent, bool soft) {
    renderer::Picture picture;
    picture.width = 3 * extent.widthPx;
    picture.height = extent.heightPx;
    picture.rgb.resize(std::size_t{picture.width} * picture.height * 3);
    for (std::uint32_t y = 0; y < extent.heightPx; ++y)
        for (std::uint32_t x = 0; x < extent.widthPx; ++x) {
            const std::size_t i = std::size_t{y} * extent.widthPx + x;
            const bool counted = truth[i].hard != HardTruth::NotCounted;
            const Colour parts[] = {truthColour(truth[i]), counted ? grey(result[i]) : kNotCounted,
                                    errorColour(truth[i], result[i], soft)};
            for (std::uint32_t part = 0; part < 3; ++part) {
                const std::size_t at = std::size_t{y} * picture.width + part * extent.widthPx + x;
                std::copy_n(parts[part].begin(), 3, picture.rgb.begin() + static_cast<std::ptrdiff_t>(3 * at));
            }
        }
    return picture;
}

std::string mapFileName(const VerifiedLight& light) {
    std::string name = light.name.substr(0, kMostNameLetters);
    const auto plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    };
    std::replace_if(
        name.begin(), name.end(), [&](char c) { return !plain(c); }, '-');
    return fmt::format("light_{:03}{}{}.png", light.index, name.empty() ? "" : "_", name);
}

}  // namespace gnomon::app
