#version 460
// Phase 4, first step: every pair of a tile and a light of its early list goes to the queue of its filter and of its
// light's shadow views.
//
// Problem: a shader that holds the code of all filters and light types keeps registers for the greediest of them, and
// neighbouring lanes do different work.
// Source: the paper, section 2.4, evaluates tile by tile. Queues of one kind of work each: Laine, Karras, Aila 2013,
// "Megakernels Considered Harmful: Wavefront Path Tracing on GPUs".
// Here: one lane per place of list space. Lights that cast no shadow are lit, and end here. All others are appended to
// their queue, with one atomic per subgroup and queue.
// Queues share an array as long as list space, segmented by how many pairs the lists hold of each (GpuPairQueue::listed).
// Where lists have overflowed, segments may end beyond the array. Such pairs are evaluated while lighting.
#extension GL_GOOGLE_include_directive : require
#define GNOMON_LISTS_ACCESS
#include "vulkan/work_group.glsl"
#include "generate_shadows/evaluate_entry.glsl"
#include "generate_shadows/pair_queues.glsl"
#include "visibility/filters.glsl"
#include "visibility/light_views.glsl"

// Which queue the pair at a place goes to, or none: kPairQueueCount. Words that no tile owns in this frame hold what an
// earlier one left.
uint classify(uint place, out Pair pair) {
    pair = Pair(place, 0u, uvec2(0u));
    if (place >= frame.listCapacity) return kPairQueueCount;
    pair = pairAt(place);
    if (any(greaterThanEqual(pair.tile, frame.tileCounts))) return kPairQueueCount;
    uint tileIndex = tileIndexOf(pair.tile);
    uint slotId = tileLightSlotIds[tileIndex];
    uint count = earlyCounts[tileIndex] & kEarlyCountMask;
    if (slotId == kNoListSpace || place < slotId || place - slotId >= count) return kPairQueueCount;
    GpuLight light = lights[pair.lightIndex];
    if (!lightCasts(light) || kFilters == 0u) {
        finalList[place] = packFinalEntry(pair.lightIndex, kSlotAllLit);
        return kPairQueueCount;
    }
    return pairQueueOf(filterOf(light), shadowViewsOf(light));
}

bool isSearched(uint queue) { return queue / kShadowViewsKinds == kFilterPcssShared; }

// Appends the subgroup's pairs of one queue; returns the first one's place in it. Called by all lanes.
uint append(uint queue, uint count) {
    uint first = 0u;
    if (subgroupElect()) {
        if (isSearched(queue)) {
            first = atomicAdd(pairs.queues[queue].searchCount, count);
            uint groups = divideRoundingUp(first + count, kPairsPerSearchGroup);
            atomicMax(pairs.queues[queue].searchGroupCountY, divideRoundingUp(groups, kPairRowGroups));
        } else {
            first = atomicAdd(pairs.queues[queue].filterCount, count);
            atomicMax(pairs.queues[queue].filterGroupCountY, divideRoundingUp(first + count, kPairRowGroups));
        }
    }
    return subgroupAdd(first);  // the others' are 0
}

void main() {
    Pair pair;
    uint queue = classify(pairGroup() * kWorkGroupSize + laneIndex(), pair);
    uint waiting = subgroupOr(queue < kPairQueueCount ? 1u << queue : 0u);
    while (waiting != 0u) {
        uint next = findLSB(waiting);
        waiting &= waiting - 1u;
        uint mine = queue == next ? 1u : 0u;
        uint before = subgroupExclusiveAdd(mine);
        uint first = append(next, subgroupAdd(mine));
        uint at = segmentOf(next) + first + before;
        if (mine != 0u && at < frame.listCapacity) {
            queuedPairs[at + (isSearched(next) ? 0u : frame.listCapacity)] = pair.place;
        } else if (mine != 0u) {
            evaluateEntry(pair.place, pair.lightIndex, pair.tile);
        }
    }
}
