#include "truth/flicker.h"

#include <cmath>

namespace gnomon::renderer {
namespace {

constexpr double kLevels = 65535.0;

HardTruth comparable(const PixelTruth& truth, float result) {
    if (truth.edge || !(result >= 0.0f)) return HardTruth::NotCounted;
    return truth.hard == HardTruth::Dark ? HardTruth::Away : truth.hard;
}

}  // namespace

void FlickerMeter::add(const LightTruth& truth, std::span<const float> result) {
    std::vector<HardTruth> now(result.size(), HardTruth::NotCounted);
    for (std::size_t i = 0; i < truth.pixels.size(); ++i)
        now[truth.indices[i]] = comparable(truth.pixels[i], result[truth.indices[i]]);
    const bool first = before_.size() != now.size();
    visibility_.resize(now.size(), 0);
    for (std::size_t i = 0; i < now.size(); ++i) {
        if (now[i] == HardTruth::NotCounted) continue;
        const auto level = static_cast<std::uint16_t>(std::lround(kLevels * static_cast<double>(result[i])));
        if (!first && now[i] == before_[i]) {
            figures_.change += std::abs(level - visibility_[i]) / kLevels;
            ++figures_.pairs;
        }
        visibility_[i] = level;
    }
    before_ = std::move(now);
}

}  // namespace gnomon::renderer
