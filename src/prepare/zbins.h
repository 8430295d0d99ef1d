#pragma once
// zBins: per slice of view depth, the lowest and highest index of the lights that reach into it.

#include <array>
#include <cstdint>
#include <span>

#include "gpu_interface/numbers.h"
#include "prepare/light_volume.h"

namespace gnomon::prepare {

struct ZBinLayout {
    float nearDepth = 0;
    float binsPerMetre = 0;  // 0 where no light is: every depth falls into bin 0, which is empty
    float farthestReach = 0;
};

/// `depths` of the lights with a range, nearest first.
ZBinLayout layOutZBins(std::span<const DepthRange> depths, double nearMetres, double farMetres) noexcept;

/// Standard entries, then ranged ones. Light i of `depths` has index firstIndex + i.
std::array<std::uint32_t, gpu::kZBinWords> buildZBins(std::span<const DepthRange> depths, std::uint32_t firstIndex,
                                                      const ZBinLayout& layout) noexcept;

}  // namespace gnomon::prepare
