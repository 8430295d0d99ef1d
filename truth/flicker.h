#pragma once
// How much a light's visibility changes from frame to frame where it should not.

#include <cstdint>
#include <span>
#include <vector>

#include "truth/light_truth.h"

namespace gnomon::renderer {

struct FlickerFigures {
    double change = 0.0;      ///< summed
    std::uint64_t pairs = 0;  ///< of a pixel's neighbouring frames
    FlickerFigures& operator+=(const FlickerFigures& o) {
        change += o.change, pairs += o.pairs;
        return *this;
    }
    [[nodiscard]] double mean() const { return pairs == 0 ? 0.0 : change / static_cast<double>(pairs); }
};

/// Follows one light. Keeps three bytes per pixel.
class FlickerMeter {
public:
    /// The next frame of the same extent. Counts pixels that are no edge, and lit or dark in both frames.
    void add(const LightTruth& truth, std::span<const float> result);
    [[nodiscard]] const FlickerFigures& figures() const { return figures_; }

private:
    std::vector<HardTruth> before_;  // NotCounted: edges too; Away stands for dark
    std::vector<std::uint16_t> visibility_;
    FlickerFigures figures_;
};

}  // namespace gnomon::renderer
