// Which texels the measurement of texture rates reads, and how many. Compiled as C++ and as GLSL.
#ifndef GNOMON_RENDERER_RATES_SAMPLE_PATTERN_H
#define GNOMON_RENDERER_RATES_SAMPLE_PATTERN_H

#include "gpu_interface/numbers.h"
#ifdef __cplusplus
#define GNOMON_CONSTANT inline constexpr
#define GNOMON_UINT std::uint32_t
namespace gnomon::renderer {
using namespace gnomon::gpu;
#else
#define GNOMON_CONSTANT const
#define GNOMON_UINT uint
#endif

GNOMON_CONSTANT GNOMON_UINT kRateAtlasSizePx = 1024u;  // 4 MiB of D32
// Samples lie in a square of this width, whose first texel is the lane's own: about the reach of a soft shadow's taps.
GNOMON_CONSTANT GNOMON_UINT kRateReachBits = 5u;
GNOMON_CONSTANT GNOMON_UINT kRateReachPx = 1u << kRateReachBits;
// A work group has a tile of 8x8 texels, a lane per texel. The next group has the next tile, as shadow tiles lie side
// by side. Tiles begin again where a sample, or the 2x2 texels of a gather, would leave the atlas.
GNOMON_CONSTANT GNOMON_UINT kRateTilesPerRow = (kRateAtlasSizePx - kRateReachPx) / kShadowTileSizePx;
// A lane's place in its square is two parts of one number. From sample to sample this is added to the number: 2^32 over
// the golden ratio, which spreads places evenly. The number comes back only after 2^32 samples, so no compiler finds
// two samples alike.
GNOMON_CONSTANT GNOMON_UINT kRateStep = 0x9E3779B9u;
GNOMON_CONSTANT GNOMON_UINT kRateXShift = 32u - kRateReachBits;
GNOMON_CONSTANT GNOMON_UINT kRateYShift = 11u;
// Samples of a lane that do not wait for each other.
GNOMON_CONSTANT GNOMON_UINT kRateSamplesPerRound = 4u;

// Specialization constants beside that of the subgroup's size.
GNOMON_CONSTANT GNOMON_UINT kSpecRateGathers = kSpecFirstFree;  // 1: 2x2 texels by textureGather; 0: one by texelFetch
// 1: every lane has its own place in its square; 0: the lanes of a group have the same.
GNOMON_CONSTANT GNOMON_UINT kSpecRateScattered = kSpecFirstFree + 1u;

#ifdef __cplusplus
}  // namespace gnomon::renderer
#endif
#undef GNOMON_CONSTANT
#undef GNOMON_UINT
#endif
