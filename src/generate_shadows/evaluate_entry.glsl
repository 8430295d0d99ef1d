// What becomes of a pair for which a slot or a place in a queue was missing: its entry says EVALUATE, and its tile goes
// to the indirect list of the second lighting pipeline, once. So nothing is lost.
#ifndef GNOMON_GENERATE_SHADOWS_EVALUATE_ENTRY_GLSL
#define GNOMON_GENERATE_SHADOWS_EVALUATE_ENTRY_GLSL

#include "find_lights_approximate/tile_lists.glsl"

void evaluateEntry(uint place, uint lightIndex, uvec2 tile) {
    finalList[place] = packFinalEntry(lightIndex, kSlotEvaluate);
    atomicAdd(counters.slotOverflowEntries, 1u);
    uint before = atomicOr(finalCounts[tileIndexOf(tile)], kFinalEvaluateBit);
    if ((before & kFinalEvaluateBit) == 0u) appendEvaluateTile(tile);
}

#endif
