// How values are packed into words, once. Compiled as C++ and as GLSL.
#ifndef GNOMON_GPU_INTERFACE_PACKING_H
#define GNOMON_GPU_INTERFACE_PACKING_H

#include "gpu_interface/numbers.h"
#ifdef __cplusplus
#include "gpu_interface/structs.h"
#define GNOMON_FN constexpr
namespace gnomon::gpu {
#else
#define GNOMON_FN
#endif

GNOMON_FN uint divideRoundingUp(uint value, uint divisor) { return (value + divisor - 1u) / divisor; }

// List space is given out in whole early-list words (paper, listing 1).
GNOMON_FN uint roundUpToEarlyWord(uint count) {
    return divideRoundingUp(count, kEarlyIndicesPerWord) * kEarlyIndicesPerWord;
}

// A zBin: lowest and highest light index, u16 each.
GNOMON_FN uint packZBin(uint minIndex, uint maxIndex) { return minIndex | (maxIndex << 16u); }
GNOMON_FN uint zBinMin(uint packed) { return packed & 0xFFFFu; }
GNOMON_FN uint zBinMax(uint packed) { return packed >> 16u; }

// Early list: three 10-bit indices per word.
GNOMON_FN uint earlyWordIndex(uint slotId, uint entry) { return (slotId + entry) / kEarlyIndicesPerWord; }
GNOMON_FN uint unpackEarlyIndex(uint word, uint entry) {
    return (word >> (kLightIndexBits * (entry % kEarlyIndicesPerWord))) & (kMaxLightsPerView - 1u);
}

// Final list: light index and VisibilitySlotID or flag.
GNOMON_FN uint packFinalEntry(uint lightIndex, uint slotOrFlag) { return lightIndex | (slotOrFlag << kLightIndexBits); }
GNOMON_FN uint finalLightIndex(uint entry) { return entry & (kMaxLightsPerView - 1u); }
GNOMON_FN uint finalSlotOrFlag(uint entry) { return entry >> kLightIndexBits; }

// Which queue a pair belongs to. `kind`: kShadowViewsOne ...
GNOMON_FN uint pairQueueOf(uint filterOfLight, uint kind) { return filterOfLight * kShadowViewsKinds + kind - 1u; }

// Tile coordinates in a word.
GNOMON_FN uint packTile(uint x, uint y) { return y << 16u | x; }

// Where a level of the shadow bounds begins. Levels lie behind each other, each a quarter of the one before, and the
// finest has `blocks` blocks. So level l begins at blocks (1 + 1/4 + ...) = 4 (blocks - blocks / 4^l) / 3.
GNOMON_FN uint shadowBoundsLevelOffset(uint blocks, uint level) {
    return (blocks - (blocks >> (2u * level))) / 3u * 4u;
}

// A slot of 64 pixels with 8 or 4 bits each: 16 or 8 words.
GNOMON_FN uint visibilitySlotWords(uint bits) { return kWorkGroupSize * bits / 32u; }
// Largest value that `bits` bits store: fully lit.
GNOMON_FN uint visibilityLevels(uint bits) { return (1u << bits) - 1u; }

// Lane of a pixel in its tile (or of a shadow tile in its group) in Morton order; x and y in 0..7.
GNOMON_FN uint mortonLane(uint x, uint y) {
    return (x & 1u) | ((y & 1u) << 1u) | ((x & 2u) << 1u) | ((y & 2u) << 2u) | ((x & 4u) << 2u) | ((y & 4u) << 3u);
}
GNOMON_FN uint mortonX(uint lane) { return (lane & 1u) | ((lane >> 1u) & 2u) | ((lane >> 2u) & 4u); }
GNOMON_FN uint mortonY(uint lane) { return ((lane >> 1u) & 1u) | ((lane >> 2u) & 2u) | ((lane >> 3u) & 4u); }

#ifdef __cplusplus
}  // namespace gnomon::gpu
#endif
#undef GNOMON_FN
#endif  // GNOMON_GPU_INTERFACE_PACKING_H
