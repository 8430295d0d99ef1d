#pragma once
// Numbers and curves that builders of scenes use.

#include <algorithm>
#include <numbers>

namespace gnomon::renderer {

inline constexpr float kPi = std::numbers::pi_v<float>;
inline constexpr float kTau = 2.0f * kPi;

/// From 0 at `low` to 1 at `high`, level at both.
inline float smooth(float low, float high, float v) {
    const float t = std::clamp((v - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

}  // namespace gnomon::renderer
