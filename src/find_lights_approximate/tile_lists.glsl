// What the phase that writes the early lists leaves for the later ones: where a tile's lists lie, how long they are, and
// which tiles have none.
#ifndef GNOMON_FIND_LIGHTS_APPROXIMATE_TILE_LISTS_GLSL
#define GNOMON_FIND_LIGHTS_APPROXIMATE_TILE_LISTS_GLSL

#include "gpu_interface/lists_set.glsl"
#include "gpu_interface/working_set.glsl"

// The second lighting pipeline shades the tile.
void appendEvaluateTile(uvec2 tile) {
    uint i = atomicAdd(evaluateHead.tileCount, 1u);
    if (i >= frame.tileCounts.x * frame.tileCounts.y) return;
    evaluateTiles[i] = packTile(tile.x, tile.y);
    atomicMax(evaluateHead.groupCountX, min(i + 1u, kEvaluateRowTiles));
    atomicMax(evaluateHead.groupCountY, i / kEvaluateRowTiles + 1u);
}

bool fitsListSpace(uint slotId, uint entries) {
    return slotId <= frame.listCapacity && entries <= frame.listCapacity - slotId;
}

// `slotId`: kNoListSpace where there was none for the tile's `count` lights. Such a tile is evaluated while lighting.
// Called by one lane of the tile.
void writeTileLists(uvec2 tile, uint slotId, uint count, uint casting) {
    uint tileIndex = tileIndexOf(tile);
    tileLightSlotIds[tileIndex] = slotId;
    earlyCounts[tileIndex] = count | casting << kEarlyCastingShift;
    finalCounts[tileIndex] = slotId == kNoListSpace ? kFinalEvaluateBit : count;
    if (slotId == kNoListSpace) {
        atomicAdd(counters.listOverflowTiles, 1u);
        appendEvaluateTile(tile);
    }
}

// Phase 4 walks list space up to here.
void walkListSpace(uint entries) {
    uint groups = divideRoundingUp(entries, kPlacesPerClassifyGroup);
    atomicMax(pairs.classifyGroupCountX, min(groups, kPairRowGroups));
    atomicMax(pairs.classifyGroupCountY, divideRoundingUp(groups, kPairRowGroups));
}

#endif
