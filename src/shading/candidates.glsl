// Candidate lights of a screen position and depth range: tile light mask and zBins of phase 1, word by word.
// Source: the paper, section 2.1. Words whose group bit is clear are never read.
#ifndef GNOMON_SHADING_CANDIDATES_GLSL
#define GNOMON_SHADING_CANDIDATES_GLSL

#include "gpu_interface/lists_set.glsl"

struct Candidates {
    uint maskEntry;   // first word of the 32x32 tile's mask
    uint groupBits;   // light groups worth looking at
    uint maskGroups;  // of them, those that the tile's mask has
    uint first;       // light indices from the zBins, inclusive
    uint last;
};

// An endless depth counts as the farthest reach of a light. So infinity never meets a zero: a frame without lights has
// 0 bins per metre.
uint zBinOf(float viewDepth) {
    float depth = min(viewDepth, frame.farthestReach);
    return uint(clamp(floor((depth - frame.zBinNearDepth) * frame.zBinsPerMetre), 0.0, float(kZBinCount - 1u)));
}

// Light indices that may matter between two depths; first above last where there is none.
void zBinRange(float nearDepth, float farDepth, out uint first, out uint last) {
    uint nearBin = zBinOf(nearDepth);
    uint farBin = zBinOf(farDepth);
    uint a, b;
    if (farBin - nearBin <= 1u) {
        a = zBins[nearBin];
        b = zBins[farBin];
        first = min(zBinMin(a), zBinMin(b));
        last = max(zBinMax(a), zBinMax(b));
    } else {
        first = zBinMin(zBins[kZBinCount + nearBin]);
        last = zBinMax(zBins[kZBinCount + farBin]);
    }
}

// Bits `from` to `to` of a word that begins at light 32 * group.
uint rangeBits(uint group, uint first, uint last) {
    uint base = group * kLightGroupSize;
    if (first > last || last < base || first >= base + kLightGroupSize) return 0u;
    uint from = first > base ? first - base : 0u;
    uint to = min(last - base, kLightGroupSize - 1u);
    return (0xFFFFFFFFu >> (31u - to)) & (0xFFFFFFFFu << from);
}

// Directional lights stand outside masks and zBins and are always candidates.
uint directionalBits(uint group) {
    uint count = frame.directionalLightCount;
    return count == 0u ? 0u : rangeBits(group, 0u, count - 1u);
}

Candidates candidatesOf(uvec2 pixel, float nearDepth, float farDepth) {
    Candidates c;
    c.maskEntry = maskEntryOf(pixel);
    zBinRange(nearDepth, farDepth, c.first, c.last);
    c.maskGroups = 0u;
    if (c.first <= c.last) {
        c.maskGroups = tileLightMasks[c.maskEntry] & rangeBits(0u, c.first / kLightGroupSize, c.last / kLightGroupSize);
    }
    uint directionalGroups = (frame.directionalLightCount + kLightGroupSize - 1u) / kLightGroupSize;
    c.groupBits = c.maskGroups | (directionalGroups == 0u ? 0u : rangeBits(0u, 0u, directionalGroups - 1u));
    return c;
}

uint candidateWord(Candidates c, uint group) {
    uint word = 0u;
    if ((c.maskGroups >> group & 1u) != 0u) {
        word = tileLightMasks[c.maskEntry + 1u + group] & rangeBits(group, c.first, c.last);
    }
    return word | directionalBits(group);
}

#endif
