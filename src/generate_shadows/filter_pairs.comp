#version 460
// Phase 4, last step: the visibility of a pair's light from every pixel of its tile. One pipeline per filter and kind of
// shadow views.
//
// Problem: a lighting shader that evaluates shadows keeps its own registers and the filter's alive together.
// Source: the paper, section 2.4, listing 4. Wholly dark and wholly lit: a flag in the list. Else a slot.
// Here: a work group takes a pair after another, a lane per pixel. The filter and the kind of shadow views are the same
// for all lanes.
// - Dark and lit are decided on the quantised values, by a vote of the pixels that the light reaches. (With
//   "pcss_shared" of all pixels; those that it does not reach count as dark.)
// - Lanes leave their values in shared memory, and one lane per word of the slot packs them.
// - With "pcss_shared" the search has been made (search_pairs), and what the quads have found lies in the slot. Few
//   quads of a pair need a filter. So those of all the group's pairs are listed, and fill the front lanes. On an NVIDIA
//   H100 that takes 0.61 ms, pair by pair 0.85 ms.
// - Where a subgroup is as wide as the tile, a group takes one pair: its light then lies in scalar registers.
// Overflow: without a slot the entry says EVALUATE, and nothing is lost.
#extension GL_GOOGLE_include_directive : require
#define GNOMON_LISTS_ACCESS
#include "vulkan/work_group.glsl"
#include "generate_shadows/evaluate_entry.glsl"
#include "generate_shadows/pair_queues.glsl"
#include "visibility/visibility.glsl"

const bool kSearched = kFilters == 1u << kFilterPcssShared;
const uint kPairs = kPairsPerFilterGroup;
const uint kPixelsPerWord = 32u / kVisibilityBits;

shared uint stored[kPairs * kWorkGroupSize];  // by pair and lane, which is the pixel's place in the tile
shared uint places[kPairs];                   // in list space
shared uint votesOf[kPairs];
shared uint slots[kPairs];
shared uint listedQuads[kPairs * kQuadsPerTile];  // packQuad()
shared uint searchingQuads;  // how many of them
shared uint filteredQuads;

struct Queued {
    uint first;  // the group's first pair: where it stands in queuedPairs
    uint count;  // of the group's pairs
};

Queued queued() {
    uint queue = pairQueueOf(findLSB(kFilters), kShadowViews);
    uint segment = pairs.queues[queue].first;
    uint length = min(pairs.queues[queue].filterCount, max(frame.listCapacity, segment) - segment);
    uint first = pairGroup() * kPairs;
    return Queued(frame.listCapacity + segment + first, first < length ? min(length - first, kPairs) : 0u);
}

// Of a lone pair the place comes from the queue, where the compiler sees that it is the same for all lanes.
Pair pairOf(Queued queue, uint i) { return pairAt(kPairs == 1u ? queuedPairs[queue.first] : places[i]); }

uint wordOf(uint word) {
    uint packed = 0u;
    for (uint i = 0u; i < kPixelsPerWord; ++i) packed |= stored[word * kPixelsPerWord + i] << (kVisibilityBits * i);
    return packed;
}

// For a pixel that the light does not reach `reached` is false, and the level 0.
uint levelOf(Pair pair, uint place, uint quad, out bool reached) {
    GpuLight light = lights[pair.lightIndex];
    Receiver receiver = receiverAt(pair.tile * kShadowTileSizePx + laneCoordinates(place));
    vec3 toLight;
    reached = receiver.valid && lightReaches(light, receiver.positionWs, receiver.mask, toLight);
    return reached ? quantiseVisibility(visibilityWithQuad(light, receiver, toLight, quad)) : 0u;
}

uint votesOfLevel(uint level) {
    return (level != kVisibilityLevels ? kNotLit : kNoVote) | (level != 0u ? kNotDark : kNoVote);
}

void vote(uint pair, uint votes) {
    votes = subgroupOr(votes);
    if (votes != kNoVote && subgroupElect()) atomicOr(votesOf[pair], votes);
}

// Slots of mixed pairs that have one.
void writeSlots(Queued queue, uint lane) {
    for (uint i = lane; i < queue.count * kVisibilitySlotWords; i += kWorkGroupSize) {
        uint pair = i / kVisibilitySlotWords;
        if (votesOf[pair] != kMixed || slots[pair] == kSlotEvaluate) continue;
        visibilityWords[slots[pair] * kVisibilitySlotWords + i % kVisibilitySlotWords] = wordOf(i);
    }
}

// What becomes of a pair by its votes: a flag, a slot, or neither.
void endPair(Pair pair, uint i) {
    uint slot = (votesOf[i] & kNotDark) == 0u ? kSlotAllUnlit : kSlotAllLit;
    if (votesOf[i] == kMixed) {
        slot = atomicAdd(counters.visibilitySlots, 1u);
        if (slot >= frame.slotCapacity) slot = kSlotEvaluate;
    }
    if (slot == kSlotEvaluate) {
        evaluateEntry(pair.place, pair.lightIndex, pair.tile);
    } else {
        finalList[pair.place] = packFinalEntry(pair.lightIndex, slot);
    }
    slots[i] = slot;
}

void filterPair(Queued queue, uint i, uint lane) {
    bool reached;
    uint level = levelOf(pairOf(queue, i), lane, kQuadOwn, reached);
    stored[i * kWorkGroupSize + lane] = level;
    vote(i, reached ? votesOfLevel(level) : kNoVote);
}

// A lone pair needs no loop, which would cost registers.
void filterAllPixels(Queued queue, uint lane) {
    if (kPairs == 1u) {
        filterPair(queue, 0u, lane);
    } else {
        for (uint i = 0u; i < queue.count; ++i) filterPair(queue, i, lane);
    }
    barrier();
    if (lane < queue.count) endPair(pairOf(queue, lane), lane);
    barrier();
    writeSlots(queue, lane);
}

uint packQuad(uint pair, uint quad, uint code) { return pair << 24u | quad << 16u | code; }

// Quads that need a filter. Those whose pixels search by themselves come first, so that they share warps. Others are
// appended from the end.
void listQuad(uint pair, uint quad, uint code, bool fades) {
    bool known = code == kQuadDark || code == kQuadLit;
    if (code == kQuadOwn) {
        listedQuads[atomicAdd(searchingQuads, 1u)] = packQuad(pair, quad, code);
    } else if (fades || !known) {
        listedQuads[kPairs * kQuadsPerTile - 1u - atomicAdd(filteredQuads, 1u)] = packQuad(pair, quad, code);
    }
}

// What the search has found for a quad, a lane for each. Its pixels are taken for dark or lit, until they are filtered.
void readQuads(Queued queue, uint lane) {
    uint pair = lane / kQuadsPerTile, quad = lane % kQuadsPerTile;
    if (pair >= queue.count) return;
    uint code = visibilityWords[slots[pair] * kVisibilitySlotWords + quad / 2u] >> (16u * (quad & 1u)) & 0xFFFFu;
    for (uint i = 0u; i < 4u; ++i) {
        stored[pair * kWorkGroupSize + 4u * quad + i] = code == kQuadLit ? kVisibilityLevels : 0u;
    }
    bool fades = (lights[pairOf(queue, pair).lightIndex].typeAndFlags & kLightShadowFadesBit) != 0u;
    listQuad(pair, quad, code, fades);
}

// A pixel of the i-th of the listed quads.
void filterListed(Queued queue, uint i, uint pixel) {
    uint quad = listedQuads[i < searchingQuads ? i : kPairs * kQuadsPerTile - 1u - (i - searchingQuads)];
    uint pair = kPairs == 1u ? 0u : quad >> 24u;
    uint place = 4u * (quad >> 16u & 0xFFu) + pixel;
    bool reached;
    stored[pair * kWorkGroupSize + place] = levelOf(pairOf(queue, pair), place, quad & 0xFFFFu, reached);
}

void filterQuads(Queued queue, uint lane) {
    if (lane == 0u) {
        searchingQuads = 0u;
        filteredQuads = 0u;
    }
    if (lane < queue.count) slots[lane] = finalSlotOrFlag(finalList[places[lane]]);
    barrier();
    readQuads(queue, lane);
    barrier();
    uint listed = searchingQuads + filteredQuads;
    if (kPairs == 1u) {
        if (lane / 4u < listed) filterListed(queue, lane / 4u, lane % 4u);
    } else {
        for (uint i = lane / 4u; i < listed; i += kWorkGroupSize / 4u) filterListed(queue, i, lane % 4u);
    }
    barrier();
    for (uint i = 0u; i < queue.count; ++i) vote(i, votesOfLevel(stored[i * kWorkGroupSize + lane]));
    barrier();
    // The search may have taken for mixed what is not. The slot is spent, but lighting need not read it.
    if (lane < queue.count && votesOf[lane] != kMixed) {
        uint flag = votesOf[lane] == kNotDark ? kSlotAllLit : kSlotAllUnlit;
        finalList[places[lane]] = packFinalEntry(pairOf(queue, lane).lightIndex, flag);
    }
    writeSlots(queue, lane);
}

void main() {
    uint lane = laneIndex();
    Queued queue = queued();
    if (queue.count == 0u) return;
    if (lane < queue.count) {
        places[lane] = queuedPairs[queue.first + lane];
        votesOf[lane] = kNoVote;
    }
    barrier();
    if (kSearched) {
        filterQuads(queue, lane);
    } else {
        filterAllPixels(queue, lane);
    }
}
