#include "app/verify/maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace gnomon::app {
namespace {

using renderer::HardTruth;
using renderer::PairError;
using renderer::Picture;
using renderer::PixelTruth;
using Colour = std::array<float, 3>;  // sRGB, 0 to 1

constexpr std::size_t kMostNameLetters = 40;
constexpr std::uint32_t kGapPx = 4;
constexpr Colour kGap = {1.0f, 1.0f, 1.0f};
constexpr Colour kNotCounted = {0.16f, 0.18f, 0.28f};
constexpr Colour kAway = {0.22f, 0.15f, 0.05f};
constexpr Colour kPenumbra = {0.25f, 0.95f, 0.35f};

// What a pixel shows: the higher, the worse. Errors of the resolution, and what is hardly seen, let the frame shine
// through. From kDots on, single pixels are drawn as dots.
enum Kind : std::uint8_t { kRight, kFaintLeak, kFaintAcne, kEdge, kContact, kDots, kLeak = kDots, kAcne, kKinds };
constexpr float kOpacities[kKinds] = {0.0f, 0.6f, 0.6f, 0.5f, 1.0f, 1.0f, 1.0f};
constexpr Colour kColours[kKinds] = {{0, 0, 0},           {0.55f, 0.80f, 1.0f}, {1.0f, 0.62f, 0.55f}, {0.95f, 0.80f, 0},
                                     {1.0f, 0.20f, 1.0f}, {0.10f, 0.50f, 1.0f}, {1.0f, 0.12f, 0.08f}};

Kind kindOf(const PixelTruth& truth, float result, bool soft) {
    switch (renderer::errorOf(truth, result, soft)) {
        case PairError::Acne:
            return kAcne;
        case PairError::Leak:
            return kLeak;
        case PairError::ContactLeak:
            return kContact;
        case PairError::EdgeError:
        case PairError::PenumbraError:
            return kEdge;
        case PairError::None:
        case PairError::NotCounted:
            break;
    }
    if (renderer::isFaintAcne(truth, result, soft)) return kFaintAcne;
    return renderer::isFaintLeak(truth, result, soft) ? kFaintLeak : kRight;
}

Colour grey(float value) {
    return {value, value, value};
}
Colour mixed(const Colour& a, const Colour& b, float share) {
    Colour out;
    for (std::size_t i = 0; i < 3; ++i) out[i] = a[i] + share * (b[i] - a[i]);
    return out;
}

Colour truthColour(const PixelTruth& truth) {
    if (truth.hard == HardTruth::Away) return kAway;
    const float hard = truth.hard == HardTruth::Lit ? 1.0f : 0.0f;
    return grey(truth.subset && truth.soft >= 0.0f ? truth.soft : hard);
}

Colour colourAt(const Picture& picture, std::size_t pixel) {
    Colour out;
    for (std::size_t c = 0; c < 3; ++c) out[c] = static_cast<float>(picture.rgb[3 * pixel + c]) / 255.0f;
    return out;
}
float brightnessAt(const Picture& picture, std::size_t pixel) {
    const Colour c = colourAt(picture, pixel);
    return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
}

// Pictures of the frame's size, side by side.
class Panels {
public:
    Panels(const Picture& frame, std::uint32_t count) : width_(frame.width), height_(frame.height) {
        picture_.width = count * width_ + (count - 1) * kGapPx;
        picture_.height = height_;
        picture_.rgb.resize(std::size_t{picture_.width} * height_ * 3);
        for (std::size_t i = 0; i < std::size_t{picture_.width} * height_; ++i) set(i, kGap);
    }
    void put(std::uint32_t panel, std::size_t pixel, const Colour& colour) { set(placeOf(panel, pixel), colour); }
    // `kinds` over what is there; the bad ones last and, in large pictures, larger than a pixel.
    void putErrors(std::uint32_t panel, std::span<const std::uint8_t> kinds) {
        const std::int64_t reach = std::min(height_ / 540u, 2u);
        for (std::uint8_t kind = kRight + 1; kind < kKinds; ++kind)
            for (std::size_t i = 0; i < kinds.size(); ++i)
                if (kinds[i] == kind) putDot(panel, i, kind >= kDots ? reach : 0, kind);
    }
    [[nodiscard]] const Picture& picture() const { return picture_; }

private:
    [[nodiscard]] std::size_t placeOf(std::uint32_t panel, std::size_t pixel) const {
        return pixel / width_ * picture_.width + panel * (width_ + kGapPx) + pixel % width_;
    }
    void set(std::size_t at, const Colour& colour) {
        for (std::size_t c = 0; c < 3; ++c)
            picture_.rgb[3 * at + c] =
                static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(colour[c], 0.0f, 1.0f)));
    }
    void cover(std::uint32_t panel, std::size_t pixel, std::uint8_t kind) {
        put(panel, pixel, mixed(colourAt(picture_, placeOf(panel, pixel)), kColours[kind], kOpacities[kind]));
    }
    void putDot(std::uint32_t panel, std::size_t pixel, std::int64_t reach, std::uint8_t kind) {
        const auto x = static_cast<std::int64_t>(pixel % width_), y = static_cast<std::int64_t>(pixel / width_);
        for (std::int64_t v = std::max<std::int64_t>(y - reach, 0); v <= std::min<std::int64_t>(y + reach, height_ - 1);
             ++v)
            for (std::int64_t u = std::max<std::int64_t>(x - reach, 0);
                 u <= std::min<std::int64_t>(x + reach, width_ - 1); ++u)
                cover(panel, static_cast<std::size_t>(v * width_ + u), kind);
    }

    std::uint32_t width_, height_;
    Picture picture_;
};

}  // namespace

VerifyMaps::VerifyMaps(std::filesystem::path folder, Picture frame, bool soft)
    : folder_(std::move(folder)),
      frame_(std::move(frame)),
      soft_(soft),
      worst_(std::size_t{frame_.width} * frame_.height, kRight) {}

void VerifyMaps::add(const VerifiedLight& light, const renderer::LightTruth& truth, std::span<const float> result) {
    Panels panels(frame_, 3);
    std::vector<std::uint8_t> kinds(worst_.size(), kRight);
    for (std::size_t i = 0; i < worst_.size(); ++i) {
        const Colour dim = mixed(grey(0.5f * brightnessAt(frame_, i)), kNotCounted, 0.75f);
        for (std::uint32_t panel = 0; panel < 3; ++panel) panels.put(panel, i, dim);
    }
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
        const PixelTruth& pixel = truth.pixels[i];
        const std::size_t at = truth.indices[i];
        if (!(result[at] >= 0.0f)) continue;
        panels.put(0, at, truthColour(pixel));
        panels.put(1, at, grey(result[at]));
        const bool penumbra = soft_ && pixel.subset && pixel.soft > 0.0f && pixel.soft < 1.0f;
        const Colour base = grey(0.12f + 0.2f * brightnessAt(frame_, at) + 0.3f * result[at]);
        panels.put(2, at, penumbra ? mixed(base, kPenumbra, std::abs(result[at] - pixel.soft)) : base);
        kinds[at] = kindOf(pixel, result[at], soft_);
        worst_[at] = std::max(worst_[at], kinds[at]);
    }
    panels.putErrors(2, kinds);
    writePng(panels.picture(), folder_ / mapFileName(light));
}

void VerifyMaps::writeTotal() const {
    Panels panels(frame_, 2);
    for (std::size_t i = 0; i < worst_.size(); ++i) {
        panels.put(0, i, colourAt(frame_, i));
        panels.put(1, i, grey(0.08f + 0.5f * brightnessAt(frame_, i)));
    }
    panels.putErrors(1, worst_);
    writePng(panels.picture(), folder_ / totalFileName());
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
