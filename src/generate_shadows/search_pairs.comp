#version 460
// Phase 4, second step, for the filter "pcss_shared": one blocker search for every 2x2 pixels of a pair's tile.
//
// Problem: most pairs are dark or lit all over their tile, and a lane per pixel finds that out 64 times.
// Here: a lane per quad, 16 for a pair, four pairs to a work group. Each lane searches for its quad
// (visibility/pcss_quad.glsl). Pairs whose quads agree end here. The others take a visibility slot, leave in it what
// their quads have found, 16 bits each, and go on to filter_pairs.
// A pair without a slot is evaluated while lighting.
#extension GL_GOOGLE_include_directive : require
#define GNOMON_LISTS_ACCESS
#include "vulkan/work_group.glsl"
#include "generate_shadows/evaluate_entry.glsl"
#include "generate_shadows/pair_queues.glsl"
#include "visibility/visibility.glsl"

const uint kNotLit = 1u;   // some pixel is not wholly lit
const uint kNotDark = 2u;  // some pixel is not wholly dark

shared uint votes[kPairsPerSearchGroup];
shared uint slots[kPairsPerSearchGroup];
shared uint codes[kWorkGroupSize];

uint voteOf(GpuLight light, QuadSearch quad) {
    if (quad.reached == 0u) return 0u;
    // A faded shadow lets some light through, more or less of it.
    if ((light.typeAndFlags & kLightShadowFadesBit) != 0u) return kNotLit | kNotDark;
    uint vote = quad.asking < quad.reached ? kNotLit : 0u;
    if (quad.asking == 0u || quad.code == kQuadDark) return vote | kNotLit;
    return vote | (quad.code == kQuadLit ? kNotDark : kNotLit | kNotDark);
}

// The pair's slot for its quads, or kSlotEvaluate. `queue` is the one that it goes on to.
uint takeSlot(uint queue, uint segment, Pair pair) {
    uint slot = atomicAdd(counters.visibilitySlots, 1u);
    if (slot >= frame.slotCapacity) {
        evaluateEntry(pair.place, pair.lightIndex, pair.tile);
        return kSlotEvaluate;
    }
    uint at = atomicAdd(pairs.queues[queue].filterCount, 1u);
    atomicMax(pairs.queues[queue].filterGroupCountY, at / kPairRowGroups + 1u);
    queuedPairs[frame.listCapacity + segment + at] = pair.place;
    finalList[pair.place] = packFinalEntry(pair.lightIndex, slot);
    return slot;
}

void main() {
    uint lane = laneIndex();
    uint local = lane / kQuadsPerTile;
    uint queue = pairQueueOf(findLSB(kFilters), kShadowViews);
    uint segment = segmentOf(queue);
    uint i = pairGroup() * kPairsPerSearchGroup + local;
    bool valid = i < pairs.queues[queue].searchCount && segment + i < frame.listCapacity;
    if (lane < kPairsPerSearchGroup) votes[lane] = 0u;
    barrier();
    Pair pair;
    uint code = kQuadDark;
    if (valid) {
        pair = pairAt(queuedPairs[segment + i]);
        GpuLight light = lights[pair.lightIndex];
        uvec2 first = pair.tile * kShadowTileSizePx + 2u * laneCoordinates(lane % kQuadsPerTile);
        QuadSearch quad = searchQuad(light, first);
        code = quad.code;
        atomicOr(votes[local], voteOf(light, quad));
    }
    codes[lane] = code;
    barrier();
    if (lane % kQuadsPerTile == 0u) {
        slots[local] = kSlotEvaluate;
        if (valid && votes[local] == (kNotLit | kNotDark)) {
            slots[local] = takeSlot(queue, segment, pair);
        } else if (valid) {
            uint flag = votes[local] == kNotDark ? kSlotAllLit : kSlotAllUnlit;
            finalList[pair.place] = packFinalEntry(pair.lightIndex, flag);
        }
    }
    barrier();
    uint word = lane % kQuadsPerTile;
    if (word < kQuadsPerTile / 2u && slots[local] != kSlotEvaluate) {
        uint at = local * kQuadsPerTile + 2u * word;
        visibilityWords[slots[local] * kVisibilitySlotWords + word] = codes[at] | codes[at + 1u] << 16u;
    }
}
