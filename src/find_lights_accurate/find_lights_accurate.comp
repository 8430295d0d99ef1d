#version 460
// Phase 3, Find Lights Accurate: which lights reach at least one pixel of a shadow tile.
//
// Problem: phase 2 leaves lights that reach no pixel of the tile, because froxel tests are coarse and 64 tiles share
// one mask. Each such light would cost a full shadow evaluation in phase 4.
// Source: the paper, section 2.3, listing 3, corrected (the packed word of entry e is e / 3).
// Plain way: one lane per pixel, a vote and a list append per light.
// Here, in three steps:
// - First the work group tests 64 lights at a time, one per lane, against the tile's own froxel, as phase 2 did. Most
//   lights of the group's mask belong to its other tiles, and end here.
// - The few that are left are tested per pixel. Every lane collects a word of 32 answers, and a subgroup ORs them. So
//   subgroups meet in shared memory once per word instead of once per light.
// - At the end all lanes write the list from the 32 words, by ascending light index. So its order never depends on the
//   order of execution.
// Memory safety: with the paper's reservation, the space of a tile is its approximate count. Three things keep within
// it:
// - Lights that the tile's own mask, zBins and froxel reject are skipped.
// - The froxel tests are conservative against lightReaches().
// - A tile that still exceeded its space would be marked as one without list space, so that no light is lost. A counter
//   records it, and must stay 0.
#extension GL_GOOGLE_include_directive : require
#define GNOMON_LISTS_ACCESS
#include "vulkan/work_group.glsl"
#include "gpu_interface/working_set.glsl"
#include "find_lights_approximate/froxel.glsl"
#include "find_lights_approximate/tile_lists.glsl"
#include "shading/candidates.glsl"
#include "shading/receiver.glsl"
#include "visibility/filters.glsl"
#include "visibility/light_views.glsl"

layout(constant_id = kSpecListReservation) const uint kListReservation = kReserveApproximate;

shared uint candidateWords[kLightGroupCount];
shared uint tileWords[kLightGroupCount];
shared uint castingWords[kLightGroupCount];
shared uint tileSlotId;
shared uint queuedPairCounts[kPairQueueCount];

// Lights of the group's mask that may reach the tile, one per lane, two light groups at a time.
void testFroxel(uint lane, uint groups, Candidates candidates, Froxel froxel, uint groupMaskBase) {
    while (groups != 0u) {
        uint group = findLSB(groups);
        groups &= groups - 1u;
        if (groups != 0u) {
            if (lane >= kLightGroupSize) group = findLSB(groups);
            groups &= groups - 1u;
        } else if (lane >= kLightGroupSize) {
            break;
        }
        uint bit = lane % kLightGroupSize;
        uint wanted = tileGroupLightMasks[groupMaskBase + 1u + group] & candidateWord(candidates, group);
        if ((wanted >> bit & 1u) != 0u && lightMayReachFroxel(lights[group * kLightGroupSize + bit], froxel)) {
            atomicOr(candidateWords[group], 1u << bit);
        }
    }
}

void testPixels(Receiver receiver, uint groups) {
    bool cullFacing = (frame.flags & kFrameFacingCullBit) != 0u && !receiver.subsurface;
    while (groups != 0u) {
        uint group = findLSB(groups);
        groups &= groups - 1u;
        uint bits = candidateWords[group];
        uint found = 0u;
        uint casting = 0u;
        while (bits != 0u) {
            uint bit = findLSB(bits);
            bits &= bits - 1u;
            GpuLight light = lights[group * kLightGroupSize + bit];
            bool casts = lightCasts(light);
            vec3 toLight;
            bool reached = receiver.valid && lightReaches(light, receiver.positionWs, receiver.mask, toLight);
            // A faded shadow lets some light through even where the face looks away.
            bool dark = casts && (light.typeAndFlags & kLightShadowFadesBit) == 0u;
            if (reached && dark && cullFacing) reached = facesLight(receiver.faceNormalWs, toLight);
            found |= (reached ? 1u : 0u) << bit;
            casting |= (casts ? 1u : 0u) << bit;
        }
        uint any = subgroupOr(found);
        if (any != 0u && subgroupElect()) {
            atomicOr(tileWords[group], any);
            atomicOr(castingWords[group], any & casting);
        }
    }
}

// Light index of list entry `entry`: the entry-th set bit of the words of `groups`.
uint lightOfEntry(uint groups, uint entry) {
    while (groups != 0u) {
        uint group = findLSB(groups);
        groups &= groups - 1u;
        uint word = tileWords[group];
        uint count = bitCount(word);
        if (entry < count) {
            for (; entry > 0u; --entry) word &= word - 1u;
            return group * kLightGroupSize + findLSB(word);
        }
        entry -= count;
    }
    return 0u;
}

// How many lights the tile has, and how many of them cast shadows.
uvec2 countLights(uint groups) {
    uvec2 counts = uvec2(0u);
    while (groups != 0u) {
        uint group = findLSB(groups);
        groups &= groups - 1u;
        counts += uvec2(bitCount(tileWords[group]), bitCount(castingWords[group]));
    }
    return counts;
}

// Space for this tile's `count` lights, or kNoListSpace. Called by one lane.
uint reserve(uint tileIndex, uint count) {
    uint capacity = approximateCounts[tileIndex];
    if (count > capacity) atomicAdd(counters.accurateExceedsApproximate, 1u);
    if (kListReservation == kReserveAccurate) {
        uint wanted = roundUpToEarlyWord(count);
        uint slotId = wanted == 0u ? 0u : atomicAdd(counters.listEntries, wanted);
        return fitsListSpace(slotId, wanted) ? slotId : kNoListSpace;
    }
    // Phase 2 looked for space only where it found lights.
    if (kListReservation == kReserveFixed) capacity = capacity == 0u ? 0u : roundUpToEarlyWord(frame.fixedListEntries);
    return count > capacity ? kNoListSpace : tileLightSlotIds[tileIndex];
}

// One word of the tile's list. Its pairs are counted for their queues.
void writeWord(uvec2 tile, uint groups, uint word, uint count) {
    uint packed = 0u;
    for (uint i = 0u; i < kEarlyIndicesPerWord; ++i) {
        uint entry = word * kEarlyIndicesPerWord + i;
        if (entry >= count) break;
        uint lightIndex = lightOfEntry(groups, entry);
        packed |= lightIndex << (kLightIndexBits * i);
        GpuLight light = lights[lightIndex];
        if (lightCasts(light)) atomicAdd(queuedPairCounts[pairQueueOf(filterOf(light), shadowViewsOf(light))], 1u);
    }
    uint at = tileSlotId / kEarlyIndicesPerWord + word;
    earlyList[at] = packed;
    listTiles[at] = packTile(tile.x, tile.y);
}

void main() {
    uint lane = laneIndex();
    uvec2 tile = gl_WorkGroupID.xy;
    uint tileIndex = tileIndexOf(tile);
    if (lane < kLightGroupCount) {
        candidateWords[lane] = 0u;
        tileWords[lane] = 0u;
        castingWords[lane] = 0u;
    }
    if (lane < kPairQueueCount) queuedPairCounts[lane] = 0u;
    barrier();
    vec2 depths = tileDepthRanges[tileIndex];
    bool hasGeometry = depths.x <= depths.y;
    Receiver receiver = receiverAt(tile * kShadowTileSizePx + laneCoordinates(lane));
    uint groups = 0u;
    if (hasGeometry) {
        uint groupMaskBase = tileGroupIndexOf(tile) * kLightMaskEntryWords;
        Candidates candidates = candidatesOf(tile * kShadowTileSizePx, depths.x, depths.y);
        groups = candidates.groupBits & tileGroupLightMasks[groupMaskBase];
        testFroxel(lane, groups, candidates, froxelOf(tile, depths, tileDepthSlices[tileIndex]), groupMaskBase);
    }
    barrier();
    testPixels(receiver, groups);
    barrier();

    uvec2 counts = countLights(groups);
    uint count = counts.x;
    if (lane == 0u) {
        uint slotId = reserve(tileIndex, count);
        tileSlotId = slotId;
        writeTileLists(tile, slotId, count, counts.y);
        if (slotId != kNoListSpace && count != 0u) walkListSpace(slotId + count);
    }
    barrier();
    if (tileSlotId == kNoListSpace) return;
    for (uint word = lane; word * kEarlyIndicesPerWord < count; word += kWorkGroupSize) {
        writeWord(tile, groups, word, count);
    }
    barrier();
    if (lane < kPairQueueCount && queuedPairCounts[lane] != 0u) {
        atomicAdd(pairs.queues[lane].listed, queuedPairCounts[lane]);
    }
}
