#version 460
// Phase 4, for the filter "pcss_shared": one blocker search for every 2x2 pixels of a pair's tile.
//
// Problem: most pairs are dark or lit all over their tile, and a lane per pixel finds that out 64 times.
// Here: a lane per quad, 16 for a pair, four pairs at a time. Each lane searches for its quad (visibility/pcss_quad.glsl).
// Pairs whose quads agree end here. The others take a visibility slot, leave in it what their quads have found, 16 bits
// each, and go on to filter_pairs. A pair without a slot is evaluated while lighting.
// Quads that do not share count as mixed. Their pixels search in filter_pairs. (Searching them here, compacted over the
// work group, told more of the pairs that agree, but took longer in all on an NVIDIA H100: 2.15 ms for 2.05.)
// A work group takes kSearchRounds times four pairs, so that it needs one atomic for slots and one for the queue.
#extension GL_GOOGLE_include_directive : require
#define GNOMON_LISTS_ACCESS
#include "vulkan/work_group.glsl"
#include "generate_shadows/evaluate_entry.glsl"
#include "generate_shadows/pair_queues.glsl"
#include "visibility/visibility.glsl"

const uint kPairs = kPairsPerSearchGroup;
const uint kCodeWords = kQuadsPerTile / 2u;

shared uint votes[kPairs];
shared uint slots[kPairs];
shared uint codes[kPairs * kQuadsPerTile];
shared uint mixedCount;
shared uint firstSlot;
shared uint firstQueued;

uint voteOf(GpuLight light, QuadSearch quad) {
    if (quad.reached == 0u) return kNoVote;
    // A faded shadow lets some light through, more or less of it.
    if ((light.typeAndFlags & kLightShadowFadesBit) != 0u) return kMixed;
    uint vote = quad.asking < quad.reached ? kNotLit : kNoVote;
    if (quad.asking == 0u || quad.code == kQuadDark) return vote | kNotLit;
    return vote | (quad.code == kQuadLit || quad.code == kQuadLitIfAsked ? kNotDark : kMixed);
}

// Room for the group's mixed pairs. Called by one lane.
void makeRoom(uint queue) {
    if (mixedCount == 0u) return;
    firstSlot = atomicAdd(counters.visibilitySlots, mixedCount);
    uint withSlot = firstSlot < frame.slotCapacity ? min(mixedCount, frame.slotCapacity - firstSlot) : 0u;
    if (withSlot == 0u) return;
    uint first = atomicAdd(pairs.queues[queue].filterCount, withSlot);
    uint groups = divideRoundingUp(first + withSlot, kPairsPerFilterGroup);
    atomicMax(pairs.queues[queue].filterGroupCountX, min(groups, kPairRowGroups));
    atomicMax(pairs.queues[queue].filterGroupCountY, divideRoundingUp(groups, kPairRowGroups));
    firstQueued = frame.listCapacity + pairs.queues[queue].first + first;
}

void main() {
    uint lane = laneIndex();
    uint queue = pairQueueOf(findLSB(kFilters), kShadowViews);
    uint segment = pairs.queues[queue].first;
    uint first = pairGroup() * kPairs;
    uint count = min(pairs.queues[queue].searchCount, max(frame.listCapacity, segment) - segment);
    if (first >= count) return;
    if (lane < kPairs) votes[lane] = kNoVote;
    if (lane == 0u) mixedCount = 0u;
    barrier();
    for (uint round = 0u; round < kSearchRounds; ++round) {
        uint local = round * (kWorkGroupSize / kQuadsPerTile) + lane / kQuadsPerTile;
        if (first + local >= count) continue;
        Pair pair = pairAt(queuedPairs[segment + first + local]);
        GpuLight light = lights[pair.lightIndex];
        QuadSearch quad = searchQuad(light, pair.tile * kShadowTileSizePx + 2u * laneCoordinates(lane % kQuadsPerTile));
        codes[local * kQuadsPerTile + lane % kQuadsPerTile] = quad.code;
        atomicOr(votes[local], voteOf(light, quad));
    }
    barrier();
    uint rank = 0u;
    if (lane < kPairs && votes[lane] == kMixed) rank = atomicAdd(mixedCount, 1u);
    barrier();
    if (lane == 0u) makeRoom(queue);
    barrier();
    if (lane < kPairs) {
        slots[lane] = kSlotEvaluate;
        if (first + lane < count) {
            Pair pair = pairAt(queuedPairs[segment + first + lane]);
            uint entry = votes[lane] == kNotDark ? kSlotAllLit : kSlotAllUnlit;
            if (votes[lane] == kMixed) {
                entry = firstSlot + rank;
                if (entry < frame.slotCapacity) {
                    slots[lane] = entry;
                    queuedPairs[firstQueued + rank] = pair.place;
                } else {
                    evaluateEntry(pair.place, pair.lightIndex, pair.tile);
                }
            }
            if (votes[lane] != kMixed || entry < frame.slotCapacity) {
                finalList[pair.place] = packFinalEntry(pair.lightIndex, entry);
            }
        }
    }
    barrier();
    for (uint i = lane; i < kPairs * kCodeWords; i += kWorkGroupSize) {
        uint slot = slots[i / kCodeWords];
        if (slot == kSlotEvaluate) continue;
        visibilityWords[slot * kVisibilitySlotWords + i % kCodeWords] = codes[2u * i] | codes[2u * i + 1u] << 16u;
    }
}
