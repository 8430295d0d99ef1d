#include "renderer/truth/flicker.h"

#include <cmath>

namespace gnomon::renderer {
namespace {

constexpr double kLevels = 65535.0;

HardTruth comparable(const PixelTruth& truth) {
    if (truth.edge) return HardTruth::NotCounted;
    return truth.hard == HardTruth::Dark ? HardTruth::Away : truth.hard;
}

}  // namespace

void FlickerMeter::add(std::span<const PixelTruth> truth, std::span<const float> result) {
    const bool first = before_.size() != truth.size();
    before_.resize(truth.size(), HardTruth::NotCounted);
    visibility_.resize(truth.size(), 0);
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const HardTruth now = comparable(truth[i]);
        const auto level =
            static_cast<std::uint16_t>(std::lround(kLevels * std::fmax(static_cast<double>(result[i]), 0.0)));
        if (!first && now != HardTruth::NotCounted && now == before_[i]) {
            figures_.change += std::abs(level - visibility_[i]) / kLevels;
            ++figures_.pairs;
        }
        before_[i] = now;
        visibility_[i] = level;
    }
}

}  // namespace gnomon::renderer
