#version 460
// Phase 4, last step: the visibility of a pair's light from every pixel of its tile. One pipeline per filter and kind of
// shadow views, one work group per pair.
//
// Problem: a lighting shader that evaluates shadows keeps its own registers and the filter's alive together.
// Source: the paper, section 2.4, listing 4. Wholly dark and wholly lit: a flag in the list. Else a slot.
// Here: the light, its filter and the kind of its shadow views are the same for all lanes.
// - Dark and lit are decided on the quantised values, by a vote of the pixels that the light reaches. (With
//   "pcss_shared" of all pixels; those that it does not reach count as dark.)
// - Lanes leave their values in shared memory, and one lane per word of the slot packs them.
// - With "pcss_shared" the search has been made (search_pairs), and what the quads have found lies in the slot. Quads
//   that need a filter are moved to the front lanes. So a warp ends at once if there are few of them.
// Overflow: without a slot the entry says EVALUATE, and nothing is lost.
#extension GL_GOOGLE_include_directive : require
#define GNOMON_LISTS_ACCESS
#include "vulkan/work_group.glsl"
#include "generate_shadows/evaluate_entry.glsl"
#include "generate_shadows/pair_queues.glsl"
#include "visibility/visibility.glsl"

const uint kPixelsPerWord = 32u / kVisibilityBits;

shared uint stored[kWorkGroupSize];  // by lane, which is the pixel's place in the tile
shared uint subgroupVotes[kSubgroupCount];
shared uint pairSlot;
shared uint searchingQuads;  // one bit per quad, in both
shared uint filteredQuads;

uint wordOf(uint word) {
    uint packed = 0u;
    for (uint i = 0u; i < kPixelsPerWord; ++i) packed |= stored[word * kPixelsPerWord + i] << (kVisibilityBits * i);
    return packed;
}

// `votes` of this lane: kNotLit and kNotDark. Returns those of the work group.
uint combineVotes(uint votes) {
    votes = subgroupOr(votes);
    if (kSubgroupCount > 1u && subgroupElect()) subgroupVotes[gl_SubgroupID] = votes;
    barrier();
    if (kSubgroupCount > 1u) {
        for (uint i = 0u; i < kSubgroupCount; ++i) votes |= subgroupVotes[i];
    }
    return votes;
}

void filterAllPixels(Pair pair, GpuLight light, uint lane) {
    Receiver receiver = receiverAt(pair.tile * kShadowTileSizePx + laneCoordinates(lane));
    vec3 toLight;
    uint level = 0u;
    uint votes = kNoVote;
    if (receiver.valid && lightReaches(light, receiver.positionWs, receiver.mask, toLight)) {
        level = quantiseVisibility(visibilityWithQuad(light, receiver, toLight, kQuadOwn));
        votes = (level != kVisibilityLevels ? kNotLit : kNoVote) | (level != 0u ? kNotDark : kNoVote);
    }
    stored[lane] = level;
    votes = combineVotes(votes);
    uint slot = (votes & kNotDark) == 0u ? kSlotAllUnlit : kSlotAllLit;
    if (votes == kMixed) {
        if (lane == 0u) pairSlot = atomicAdd(counters.visibilitySlots, 1u);
        barrier();
        slot = pairSlot;
        if (slot >= frame.slotCapacity) {
            if (lane == 0u) evaluateEntry(pair.place, pair.lightIndex, pair.tile);
            return;
        }
        if (lane < kVisibilitySlotWords) visibilityWords[slot * kVisibilitySlotWords + lane] = wordOf(lane);
    }
    if (lane == 0u) finalList[pair.place] = packFinalEntry(pair.lightIndex, slot);
}

uint codeOf(uint slot, uint quad) {
    return visibilityWords[slot * kVisibilitySlotWords + quad / 2u] >> (16u * (quad & 1u)) & 0xFFFFu;
}

// The n-th of a set.
uint nthOf(uint set, uint n) {
    for (; n > 0u; --n) set &= set - 1u;
    return findLSB(set);
}

// The lane's quad. Those whose pixels search by themselves come first, so that they share a warp; the other ones that
// need a filter follow. kQuadsPerTile: none is left.
uint quadOfLane(uint lane) {
    uint n = lane / 4u;
    uint searching = bitCount(searchingQuads);
    if (n < searching) return nthOf(searchingQuads, n);
    n -= searching;
    return n < bitCount(filteredQuads) ? nthOf(filteredQuads, n) : kQuadsPerTile;
}

void filterQuads(Pair pair, GpuLight light, uint lane) {
    uint slot = finalSlotOrFlag(finalList[pair.place]);
    bool fades = (light.typeAndFlags & kLightShadowFadesBit) != 0u;
    uint ownCode = codeOf(slot, lane / 4u);
    stored[lane] = ownCode == kQuadLit ? kVisibilityLevels : 0u;
    if (lane == 0u) {
        searchingQuads = 0u;
        filteredQuads = 0u;
    }
    barrier();
    bool known = ownCode == kQuadDark || ownCode == kQuadLit;
    if (lane % 4u == 0u && ownCode == kQuadOwn) {
        atomicOr(searchingQuads, 1u << lane / 4u);
    } else if (lane % 4u == 0u && (fades || !known)) {
        atomicOr(filteredQuads, 1u << lane / 4u);
    }
    barrier();
    uint quad = quadOfLane(lane);
    if (quad < kQuadsPerTile) {
        uint code = codeOf(slot, quad);
        uint place = 4u * quad + lane % 4u;
        Receiver receiver = receiverAt(pair.tile * kShadowTileSizePx + laneCoordinates(place));
        vec3 toLight;
        uint level = 0u;
        if (receiver.valid && lightReaches(light, receiver.positionWs, receiver.mask, toLight)) {
            level = quantiseVisibility(visibilityWithQuad(light, receiver, toLight, code));
        }
        stored[place] = level;
    }
    barrier();
    // The search may have taken for mixed what is not. The slot is spent, but lighting need not read it.
    uint level = stored[lane];
    uint votes = combineVotes((level != kVisibilityLevels ? kNotLit : kNoVote) | (level != 0u ? kNotDark : kNoVote));
    if (votes != kMixed) {
        if (lane == 0u) {
            uint flag = votes == kNotDark ? kSlotAllLit : kSlotAllUnlit;
            finalList[pair.place] = packFinalEntry(pair.lightIndex, flag);
        }
    } else if (lane < kVisibilitySlotWords) {
        visibilityWords[slot * kVisibilitySlotWords + lane] = wordOf(lane);
    }
}

void main() {
    uint queue = pairQueueOf(findLSB(kFilters), kShadowViews);
    uint i = pairGroup();
    uint at = pairs.queues[queue].first + i;
    if (i >= pairs.queues[queue].filterCount || at >= frame.listCapacity) return;
    Pair pair = pairAt(queuedPairs[frame.listCapacity + at]);
    GpuLight light = lights[pair.lightIndex];
    if (kFilters == 1u << kFilterPcssShared) {
        filterQuads(pair, light, laneIndex());
    } else {
        filterAllPixels(pair, light, laneIndex());
    }
}
