#version 460
// Phase 4, Generate Deferred Shadows: the visibility of every light of the early list from every pixel of a tile.
//
// Problem: a lighting shader that evaluates shadows keeps its own registers and the filter's alive together.
// Source: the paper, section 2.4, listing 4. Wholly dark: nothing is written. Wholly lit: a flag. Else a slot.
// Plain way: light after light, two votes, one slot allocation and a byte store each.
// Here: a batch of four lights at a time (eight with slots of 4 bits), with two barriers.
// - A lane's visibilities of the batch form one word.
// - AND and OR of those words over the tile are the votes. They are made on the quantised values.
// - One atomic takes all slots of the batch. These slots are 64 words, so each lane gathers and stores exactly one.
// Overflow: without a slot the entry says EVALUATE. Without list space the tile has no entries. Such tiles go to the
// indirect list of the second lighting pipeline, and nothing is lost.
#extension GL_GOOGLE_include_directive : require
#define GNOMON_LISTS_ACCESS
#include "vulkan/work_group.glsl"
#include "gpu_interface/working_set.glsl"
#include "visibility/visibility.glsl"

// The lights that are evaluated together: four, or eight with slots of 4 bits; one field of a word each.
const uint kBits = kVisibilityBits;
const uint kBatch = 32u / kBits;  // lights, and pixels in a word of a slot
const uint kLevels = kVisibilityLevels;
const uint kSlotWords = kVisibilitySlotWords;

shared uint packedVisibility[kWorkGroupSize];  // per lane, a field per light
shared uint subgroupLit[kSubgroupCount];
shared uint subgroupDark[kSubgroupCount];
shared uint batchSlot;

void appendEvaluateTile(uvec2 tile) {
    uint i = atomicAdd(evaluateHead.tileCount, 1u);
    if (i >= frame.tileCounts.x * frame.tileCounts.y) return;
    evaluateTiles[i] = tile.y << 16u | tile.x;
    atomicMax(evaluateHead.groupCountY, i / kEvaluateRowTiles + 1u);
}

uint earlyLight(uint slotId, uint entry) {
    return unpackEarlyIndex(earlyList[earlyWordIndex(slotId, entry)], entry);
}

// `voting`: fields of the lights that reach this lane's pixel. Others do not vote on all lit or all dark.
void evaluateBatch(Receiver receiver, uint slotId, uint first, uint count, out uint stored, out uint voting) {
    stored = 0u;
    voting = 0u;
    for (uint i = 0u; i < count; ++i) {
        GpuLight light = lights[earlyLight(slotId, first + i)];
        vec3 toLight;
        if (receiver.valid && lightReaches(light, receiver.positionWs, receiver.mask, toLight)) {
            stored |= quantiseVisibility(evaluateVisibility(light, receiver, toLight)) << (kBits * i);
            voting |= kLevels << (kBits * i);
        }
    }
}

void combineVotes(inout uint lit, inout uint dark) {
    for (uint i = 0u; i < kSubgroupCount; ++i) {
        lit &= subgroupLit[i];
        dark |= subgroupDark[i];
    }
}

// The word of its slot that this lane stores: several lanes' fields of light lane / kSlotWords.
uint gatherWord(uint lane) {
    uint shift = kBits * (lane / kSlotWords);
    uint pixel = (lane % kSlotWords) * kBatch;
    uint word = 0u;
    for (uint i = 0u; i < kBatch; ++i) word |= (packedVisibility[pixel + i] >> shift & kLevels) << (kBits * i);
    return word;
}

// Which lights of the batch need a slot, and which are written at all, as bits.
void classifyBatch(uint count, uint lit, uint dark, out uint slotBits, out uint writtenBits) {
    slotBits = 0u;
    writtenBits = 0u;
    for (uint i = 0u; i < count; ++i) {
        bool allDark = (dark >> (kBits * i) & kLevels) == 0u;
        bool allLit = (lit >> (kBits * i) & kLevels) == kLevels;
        writtenBits |= (allDark ? 0u : 1u) << i;
        slotBits |= (allDark || allLit ? 0u : 1u) << i;
    }
}

uint rankOf(uint bits, uint i) { return bitCount(bits & ((1u << i) - 1u)); }

void main() {
    uint lane = laneIndex();
    uvec2 tile = gl_WorkGroupID.xy;
    uint tileIndex = tileIndexOf(tile);
    uint slotId = tileLightSlotIds[tileIndex];
    if (slotId == kNoListSpace) {
        if (lane == 0u) {
            finalCounts[tileIndex] = kFinalEvaluateBit;
            appendEvaluateTile(tile);
        }
        return;
    }
    uint earlyCount = earlyCounts[tileIndex] & kEarlyCountMask;
    Receiver receiver = receiverAt(tile * kShadowTileSizePx + laneCoordinates(lane));
    uint finalCount = 0u;
    uint missing = 0u;
    for (uint first = 0u; first < earlyCount; first += kBatch) {
        uint count = min(kBatch, earlyCount - first);
        uint stored, voting;
        evaluateBatch(receiver, slotId, first, count, stored, voting);
        packedVisibility[lane] = stored;
        uint lit = subgroupAnd(stored | ~voting);
        uint dark = subgroupOr(stored & voting);
        if (kSubgroupCount > 1u && subgroupElect()) {
            subgroupLit[gl_SubgroupID] = lit;
            subgroupDark[gl_SubgroupID] = dark;
        }
        barrier();
        if (kSubgroupCount > 1u) combineVotes(lit, dark);
        uint slotBits, writtenBits;
        classifyBatch(count, lit, dark, slotBits, writtenBits);
        uint word = gatherWord(lane);
        if (lane == 0u && slotBits != 0u) batchSlot = atomicAdd(counters.visibilitySlots, bitCount(slotBits));
        barrier();

        uint mine = lane / kSlotWords;
        if ((slotBits >> mine & 1u) != 0u) {
            uint slot = batchSlot + rankOf(slotBits, mine);
            if (slot < frame.slotCapacity) visibilityWords[slot * kSlotWords + lane % kSlotWords] = word;
        }
        if (lane < count && (writtenBits >> lane & 1u) != 0u) {
            uint slot = kSlotAllLit;
            if ((slotBits >> lane & 1u) != 0u) {
                slot = batchSlot + rankOf(slotBits, lane);
                if (slot >= frame.slotCapacity) slot = kSlotEvaluate;
            }
            finalList[slotId + finalCount + rankOf(writtenBits, lane)] =
                packFinalEntry(earlyLight(slotId, first + lane), slot);
        }
        if (slotBits != 0u) {
            uint end = batchSlot + bitCount(slotBits);
            missing += end > frame.slotCapacity ? min(end - frame.slotCapacity, bitCount(slotBits)) : 0u;
        }
        finalCount += bitCount(writtenBits);
    }
    if (lane != 0u) return;
    finalCounts[tileIndex] = finalCount | (missing != 0u ? kFinalEvaluateBit : 0u);
    if (missing != 0u) {
        atomicAdd(counters.slotOverflowEntries, missing);
        appendEvaluateTile(tile);
    }
}
