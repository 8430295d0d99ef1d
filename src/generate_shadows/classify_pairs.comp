#version 460
// Phase 4: every pair of a tile and a light of its early list goes to the queue of its filter and of its light's shadow
// views.
//
// Problem: a shader that holds the code of all filters and light types keeps registers for the greediest of them, and
// neighbouring lanes do different work.
// Source: the paper, section 2.4, evaluates tile by tile. Queues of one kind of work each: Laine, Karras, Aila 2013,
// "Megakernels Considered Harmful: Wavefront Path Tracing on GPUs".
// Plain way: one lane per place of list space, and one atomic each.
// Here: a work group takes kPlacesPerClassifyGroup places, and one atomic per queue. With one per subgroup and queue the
// pass took 0.13 ms on an NVIDIA H100 at 3840x2160, all of it waiting for the counters.
// Queues share an array as long as list space, segmented by how many pairs the lists hold of each (GpuPairQueue::listed).
// Where lists have overflowed, segments may end beyond the array. Such pairs are evaluated while lighting.
// Filters so cheap that a queue costs more than it saves are left to filter_tiles.
#extension GL_GOOGLE_include_directive : require
#define GNOMON_LISTS_ACCESS
#include "vulkan/work_group.glsl"
#include "generate_shadows/evaluate_entry.glsl"
#include "generate_shadows/pair_queues.glsl"
#include "visibility/filters.glsl"
#include "visibility/light_views.glsl"

const uint kPlacesPerLane = kPlacesPerClassifyGroup / kWorkGroupSize;

shared uint counts[kPairQueueCount];  // the group's pairs
shared uint firsts[kPairQueueCount];  // where they go in their half of queuedPairs

// Which queue the pair at a place goes to, or none: kPairQueueCount. Words that no tile owns in this frame hold what an
// earlier one left.
uint classify(uint place) {
    if (place >= frame.listCapacity) return kPairQueueCount;
    Pair pair = pairAt(place);
    if (any(greaterThanEqual(pair.tile, frame.tileCounts))) return kPairQueueCount;
    uint tileIndex = tileIndexOf(pair.tile);
    uint slotId = tileLightSlotIds[tileIndex];
    uint count = earlyCounts[tileIndex] & kEarlyCountMask;
    if (slotId == kNoListSpace || place < slotId || place - slotId >= count) return kPairQueueCount;
    GpuLight light = lights[pair.lightIndex];
    if (isForTiles(light)) return kPairQueueCount;
    if (lightCasts(light)) return pairQueueOf(filterOf(light), shadowViewsOf(light));
    finalList[place] = packFinalEntry(pair.lightIndex, kSlotAllLit);
    return kPairQueueCount;
}

uint segmentOf(uint queue) {
    uint first = 0u;
    for (uint i = 0u; i < queue; ++i) first += pairs.queues[i].listed;
    return first;
}

// Makes room for the group's pairs of one queue. Called by one lane.
void makeRoom(uint queue) {
    uint segment = segmentOf(queue);
    if (pairGroup() == 0u) pairs.queues[queue].first = segment;  // for the later passes
    uint count = counts[queue];
    if (count == 0u) return;
    uint first = 0u;
    if (isSearched(queue)) {
        first = atomicAdd(pairs.queues[queue].searchCount, count);
        uint groups = divideRoundingUp(first + count, kPairsPerSearchGroup);
        atomicMax(pairs.queues[queue].searchGroupCountX, min(groups, kPairRowGroups));
        atomicMax(pairs.queues[queue].searchGroupCountY, divideRoundingUp(groups, kPairRowGroups));
    } else {
        first = atomicAdd(pairs.queues[queue].filterCount, count);
        uint groups = divideRoundingUp(first + count, kPairsPerFilterGroup);
        atomicMax(pairs.queues[queue].filterGroupCountX, min(groups, kPairRowGroups));
        atomicMax(pairs.queues[queue].filterGroupCountY, divideRoundingUp(groups, kPairRowGroups));
    }
    firsts[queue] = segment + first;
}

void main() {
    uint lane = laneIndex();
    if (lane < kPairQueueCount) counts[lane] = 0u;
    barrier();
    uint base = pairGroup() * kPlacesPerClassifyGroup + lane;
    uint queues[kPlacesPerLane];
    uint ranks[kPlacesPerLane];
    for (uint i = 0u; i < kPlacesPerLane; ++i) {
        queues[i] = classify(base + i * kWorkGroupSize);
        if (queues[i] < kPairQueueCount) ranks[i] = atomicAdd(counts[queues[i]], 1u);
    }
    barrier();
    if (lane < kPairQueueCount) makeRoom(lane);
    barrier();
    for (uint i = 0u; i < kPlacesPerLane; ++i) {
        if (queues[i] == kPairQueueCount) continue;
        uint place = base + i * kWorkGroupSize;
        uint at = firsts[queues[i]] + ranks[i];
        if (at < frame.listCapacity) {
            queuedPairs[at + (isSearched(queues[i]) ? 0u : frame.listCapacity)] = place;
        } else {
            Pair pair = pairAt(place);
            evaluateEntry(place, pair.lightIndex, pair.tile);
        }
    }
}
