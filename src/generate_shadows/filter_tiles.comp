#version 460
// Phase 4, tile by tile: the visibility of every light with a cheap filter (kFiltersByTile) from every pixel of a tile.
//
// Problem: a hard shadow takes one texel. Then reading pair and receiver for every light costs more than its shadow. On
// an NVIDIA H100 at 3840x2160 hard shadows took 0.78 ms as queues of pairs, and 0.50 ms by tile.
// Source: the paper, section 2.4, listing 4. Wholly dark and wholly lit: a flag. Else a slot.
// Plain way: light after light, two votes, one slot allocation and a byte store each.
// Here: a batch of four lights at a time (eight with slots of 4 bits), with two barriers.
// - A lane's visibilities of the batch form one word.
// - AND and OR of those words over the tile are the votes. They are made on the quantised values.
// - One atomic takes all slots of the batch. These slots are 64 words, so each lane gathers and stores exactly one.
// Lights of the other filters are left to their queues.
#extension GL_GOOGLE_include_directive : require
#define GNOMON_LISTS_ACCESS
#include "vulkan/work_group.glsl"
#include "generate_shadows/evaluate_entry.glsl"
#include "visibility/visibility.glsl"

// The lights that are evaluated together: four, or eight with slots of 4 bits; one field of a word each.
const uint kBits = kVisibilityBits;
const uint kBatch = 32u / kBits;  // lights, and pixels in a word of a slot
const uint kLevels = kVisibilityLevels;
const uint kSlotWords = kVisibilitySlotWords;

shared uint packedVisibility[kWorkGroupSize];  // per lane, a field per light
shared uint subgroupLit[kSubgroupCount];
shared uint subgroupDark[kSubgroupCount];
shared uint batchPlaces[kBatch];  // in list space
shared uint batchLights[kBatch];
shared uint batchSlot;

// Evaluates the next lights that are for tiles, up to a batch; `next` is the entry to begin with. Returns how many.
// `voting`: fields of the lights that reach this lane's pixel. Others do not vote on all lit or all dark.
uint evaluateBatch(Receiver receiver, uint slotId, uint count, inout uint next, out uint stored, out uint voting) {
    stored = 0u;
    voting = 0u;
    uint taken = 0u;
    for (; next < count && taken < kBatch; ++next) {
        uint place = slotId + next;
        uint lightIndex = unpackEarlyIndex(earlyList[place / kEarlyIndicesPerWord], place);
        GpuLight light = lights[lightIndex];
        if (!isForTiles(light)) continue;
        vec3 toLight;
        if (receiver.valid && lightReaches(light, receiver.positionWs, receiver.mask, toLight)) {
            stored |= quantiseVisibility(evaluateVisibility(light, receiver, toLight)) << (kBits * taken);
            voting |= kLevels << (kBits * taken);
        }
        if (laneIndex() == 0u) {
            batchPlaces[taken] = place;
            batchLights[taken] = lightIndex;
        }
        ++taken;
    }
    return taken;
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

// The flag of light i of the batch, or 0 if it needs a slot.
uint flagOf(uint i, uint lit, uint dark) {
    if ((dark >> (kBits * i) & kLevels) == 0u) return kSlotAllUnlit;
    return (lit >> (kBits * i) & kLevels) == kLevels ? kSlotAllLit : 0u;
}

uint rankOf(uint bits, uint i) { return bitCount(bits & ((1u << i) - 1u)); }

void main() {
    uint lane = laneIndex();
    uvec2 tile = gl_WorkGroupID.xy;
    uint tileIndex = tileIndexOf(tile);
    uint slotId = tileLightSlotIds[tileIndex];
    if (slotId == kNoListSpace) return;
    uint count = earlyCounts[tileIndex] & kEarlyCountMask;
    Receiver receiver = receiverAt(tile * kShadowTileSizePx + laneCoordinates(lane));
    for (uint next = 0u; next < count;) {
        uint stored, voting;
        uint taken = evaluateBatch(receiver, slotId, count, next, stored, voting);
        packedVisibility[lane] = stored;
        uint lit = subgroupAnd(stored | ~voting);
        uint dark = subgroupOr(stored & voting);
        if (kSubgroupCount > 1u && subgroupElect()) {
            subgroupLit[gl_SubgroupID] = lit;
            subgroupDark[gl_SubgroupID] = dark;
        }
        barrier();
        if (kSubgroupCount > 1u) combineVotes(lit, dark);
        uint slotBits = 0u;
        for (uint i = 0u; i < taken; ++i) slotBits |= (flagOf(i, lit, dark) == 0u ? 1u : 0u) << i;
        uint word = gatherWord(lane);
        uint place = lane < taken ? batchPlaces[lane] : 0u;
        uint lightIndex = lane < taken ? batchLights[lane] : 0u;
        if (lane == 0u && slotBits != 0u) batchSlot = atomicAdd(counters.visibilitySlots, bitCount(slotBits));
        barrier();

        uint mine = lane / kSlotWords;
        if ((slotBits >> mine & 1u) != 0u) {
            uint slot = batchSlot + rankOf(slotBits, mine);
            if (slot < frame.slotCapacity) visibilityWords[slot * kSlotWords + lane % kSlotWords] = word;
        }
        if (lane < taken) {
            uint slot = flagOf(lane, lit, dark);
            if (slot == 0u) slot = batchSlot + rankOf(slotBits, lane);
            if ((slotBits >> lane & 1u) != 0u && slot >= frame.slotCapacity) {
                evaluateEntry(place, lightIndex, tile);
            } else {
                finalList[place] = packFinalEntry(lightIndex, slot);
            }
        }
    }
}
