#pragma once
// Seeded numbers that do not depend on the order in which they are asked for.

#include <cstdint>

namespace gnomon::renderer {

/// Steele, Lea and Flood 2014, "Fast Splittable Pseudorandom Number Generators" (the mixing function of SplitMix64).
[[nodiscard]] inline std::uint64_t mixedBits(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15ull;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
    return x ^ (x >> 31);
}

/// 0 to below 1.
[[nodiscard]] inline double unitOf(std::uint64_t bits) {
    return static_cast<double>(bits >> 11) * 0x1.0p-53;
}

}  // namespace gnomon::renderer
