// The set of the lists. It is all that lighting, EVALUATE and forward shaders read: frame constants, lights, and what
// phases 1 to 4 leave for them. A host defines GNOMON_LISTS_SET before the first include if set 0 is taken. The
// library's own passes write to it; they define GNOMON_LISTS_ACCESS as nothing.
#ifndef GNOMON_GPU_INTERFACE_LISTS_SET_GLSL
#define GNOMON_GPU_INTERFACE_LISTS_SET_GLSL

#include "gpu_interface/numbers.h"
#include "gpu_interface/packing.h"
#include "gpu_interface/structs.h"

#ifndef GNOMON_LISTS_SET
#define GNOMON_LISTS_SET kSetLists
#endif
#ifndef GNOMON_LISTS_ACCESS
#define GNOMON_LISTS_ACCESS readonly
#endif
#define GNOMON_LISTS_BUFFER(number, access) \
    layout(set = GNOMON_LISTS_SET, binding = number, std430) restrict access buffer

layout(set = GNOMON_LISTS_SET, binding = kBindFrame, std140) uniform FrameBlock { GpuFrame frame; };
GNOMON_LISTS_BUFFER(kBindLights, readonly) LightsBlock { GpuLight lights[]; };
GNOMON_LISTS_BUFFER(kBindZBins, readonly) ZBinsBlock { uint zBins[]; };
GNOMON_LISTS_BUFFER(kBindTileLightMasks, readonly) TileLightMasksBlock { uint tileLightMasks[]; };
GNOMON_LISTS_BUFFER(kBindTileGroupLightMasks, GNOMON_LISTS_ACCESS) TileGroupLightMasksBlock {
    uint tileGroupLightMasks[];
};
GNOMON_LISTS_BUFFER(kBindTileDepthRanges, GNOMON_LISTS_ACCESS) TileDepthRangesBlock { vec2 tileDepthRanges[]; };
GNOMON_LISTS_BUFFER(kBindTileLightSlotIds, GNOMON_LISTS_ACCESS) TileLightSlotIdsBlock { uint tileLightSlotIds[]; };
GNOMON_LISTS_BUFFER(kBindEarlyList, GNOMON_LISTS_ACCESS) EarlyListBlock { uint earlyList[]; };
GNOMON_LISTS_BUFFER(kBindEarlyCounts, GNOMON_LISTS_ACCESS) EarlyCountsBlock { uint earlyCounts[]; };
GNOMON_LISTS_BUFFER(kBindFinalList, GNOMON_LISTS_ACCESS) FinalListBlock { uint finalList[]; };
GNOMON_LISTS_BUFFER(kBindFinalCounts, GNOMON_LISTS_ACCESS) FinalCountsBlock { uint finalCounts[]; };
GNOMON_LISTS_BUFFER(kBindVisibility, GNOMON_LISTS_ACCESS) VisibilityBlock { uint visibilityWords[]; };
GNOMON_LISTS_BUFFER(kBindEvaluateTiles, GNOMON_LISTS_ACCESS) EvaluateTilesBlock {
    GpuEvaluateHead evaluateHead;
    uint evaluateTiles[];
};

uint tileIndexOf(uvec2 tile) { return tile.y * frame.tileCounts.x + tile.x; }
uint tileGroupIndexOf(uvec2 tile) {
    uvec2 group = tile / kTileGroupSizeTiles;
    return group.y * frame.tileGroupCounts.x + group.x;
}
uint maskEntryOf(uvec2 pixel) {
    uvec2 maskTile = pixel / kMaskTileSizePx;
    return (maskTile.y * frame.maskTileColumns + maskTile.x) * kLightMaskEntryWords;
}

#endif
