#version 460
// Phase 2, Find Lights Approximate: which lights may reach a pixel of a shadow tile, and where its lists will lie.
//
// Problem: with up to 1024 lights and 129,600 tiles at 4K, per-pixel tests of every pair are out of reach. Fixed lists
// per tile waste memory on the many tiles that see few lights.
// Source: the paper, section 2.2, listings 1 and 2.
// Plain way: one lane per tile, all lights, a fixed list per tile.
// Here: one work group per tile group, one lane per shadow tile.
// - Candidates come from the 32x32 light masks and the zBins. Each is tested against the tile's froxel.
// - The group's mask is the OR over its 64 tiles.
// - List space for the whole group is reserved with one atomic, from light counts rounded up to whole early-list words.
//   (Listing 1 sums them before rounding, which lets neighbours overlap.)
// - The early lists are written right here, and phase 3 is left out (kListsByFroxel). Its tests per pixel would leave
//   out one light of seven, and cost more than they save: pixels are tested again where they are evaluated. The paper's
//   way, in which phase 3 writes the lists, is a setting (kListsByPixel).
// Uniformity: the walk goes over the OR of a subgroup's candidates. So subgroup operations are never in divergent flow,
// and light data are loaded once per subgroup. Subgroups meet in shared memory.
#extension GL_GOOGLE_include_directive : require
#define GNOMON_LISTS_ACCESS
#include "vulkan/work_group.glsl"
#include "gpu_interface/working_set.glsl"
#include "find_lights_approximate/froxel.glsl"
#include "find_lights_approximate/tile_lists.glsl"
#include "shading/candidates.glsl"
#include "visibility/filters.glsl"
#include "visibility/light_views.glsl"

layout(constant_id = kSpecLightLists) const uint kLightLists = kListsByFroxel;
layout(constant_id = kSpecListReservation) const uint kListReservation = kReserveApproximate;

shared uint groupWords[kLightGroupCount];
shared uint subgroupEntries[kSubgroupCount];
shared uint groupSlotId;
// What each lane has found, by light group: laneWords[group * kWorkGroupSize + lane].
shared uint laneWords[kLightLists == kListsByFroxel ? kWorkGroupSize * kLightGroupCount : 1u];
shared uint queuedPairCounts[kPairQueueCount];

struct Found {
    uint groups;   // light groups of which the tile has lights
    uint count;
    uint casting;
};

// Counts the pairs of a light that is the same for the whole subgroup.
void countPairs(GpuLight light, bool found) {
    uint tiles = subgroupAdd(found ? 1u : 0u);
    if (tiles == 0u || !subgroupElect()) return;
    atomicAdd(queuedPairCounts[pairQueueOf(filterOf(light), shadowViewsOf(light))], tiles);
}

// Walks the candidates of this lane's tile.
Found testLights(uint lane, bool hasGeometry, Candidates candidates, Froxel froxel) {
    Found all = Found(0u, 0u, 0u);
    uint groups = subgroupOr(hasGeometry ? candidates.groupBits : 0u);
    while (groups != 0u) {
        uint group = findLSB(groups);
        groups &= groups - 1u;
        bool mine = hasGeometry && (candidates.groupBits >> group & 1u) != 0u;
        uint wanted = mine ? candidateWord(candidates, group) : 0u;
        uint found = 0u;
        uint bits = subgroupOr(wanted);
        while (bits != 0u) {
            uint bit = findLSB(bits);
            bits &= bits - 1u;
            GpuLight light = lights[group * kLightGroupSize + bit];
            bool reached = (wanted >> bit & 1u) != 0u && lightMayReachFroxel(light, froxel);
            if (reached) found |= 1u << bit;
            if (kLightLists == kListsByFroxel && lightCasts(light)) {
                all.casting += reached ? 1u : 0u;
                countPairs(light, reached);
            }
        }
        all.count += bitCount(found);
        if (kLightLists == kListsByFroxel && found != 0u) {
            laneWords[group * kWorkGroupSize + lane] = found;
            all.groups |= 1u << group;
        }
        uint any = subgroupOr(found);
        if (any != 0u && subgroupElect()) atomicOr(groupWords[group], any);
    }
    return all;
}

// The tile's list, by ascending light index.
void writeList(uint lane, uvec2 tile, uint slotId, uint groups) {
    uint at = slotId / kEarlyIndicesPerWord;
    uint packed = 0u;
    uint n = 0u;
    while (groups != 0u) {
        uint group = findLSB(groups);
        groups &= groups - 1u;
        uint word = laneWords[group * kWorkGroupSize + lane];
        while (word != 0u) {
            uint bit = findLSB(word);
            word &= word - 1u;
            packed |= (group * kLightGroupSize + bit) << (kLightIndexBits * n);
            n += 1u;
            if (n == kEarlyIndicesPerWord) {
                earlyList[at] = packed;
                listTiles[at] = packTile(tile.x, tile.y);
                at += 1u;
                packed = 0u;
                n = 0u;
            }
        }
    }
    if (n == 0u) return;
    earlyList[at] = packed;
    listTiles[at] = packTile(tile.x, tile.y);
}

void writeGroupMask(uint lane) {
    uint base = tileGroupIndexOf(gl_WorkGroupID.xy * kTileGroupSizeTiles) * kLightMaskEntryWords;
    if (lane < kLightGroupCount && groupWords[lane] != 0u) tileGroupLightMasks[base + 1u + lane] = groupWords[lane];
    if (lane == 0u) {
        uint bits = 0u;
        for (uint group = 0u; group < kLightGroupCount; ++group) bits |= (groupWords[group] != 0u ? 1u : 0u) << group;
        tileGroupLightMasks[base] = bits;
    }
}

// Space for the group's lists: the first entry of this lane's. `wanted` entries are this lane's own.
uint reserve(uint lane, uint tileIndex, uint wanted) {
    if (kListReservation == kReserveFixed) {
        uint slotId = tileIndex * wanted;
        if (kLightLists == kListsByFroxel && wanted != 0u) {
            uint end = subgroupMax(slotId + wanted);
            if (subgroupElect()) walkListSpace(min(end, frame.listCapacity));
        }
        return slotId;
    }
    uint before = subgroupExclusiveAdd(wanted);
    uint total = subgroupAdd(wanted);
    if (subgroupElect()) subgroupEntries[gl_SubgroupID] = total;
    barrier();
    total = 0u;
    for (uint i = 0u; i < kSubgroupCount; ++i) {
        if (i < gl_SubgroupID) before += subgroupEntries[i];
        total += subgroupEntries[i];
    }
    if (lane == 0u) {
        uint first = total == 0u ? 0u : atomicAdd(counters.listEntries, total);
        groupSlotId = first;
        uint end = first > frame.listCapacity ? 0u : min(first + total, frame.listCapacity);
        if (kLightLists == kListsByFroxel) walkListSpace(end);
    }
    barrier();
    return groupSlotId + before;
}

void main() {
    uint lane = laneIndex();
    if (lane < kLightGroupCount) groupWords[lane] = 0u;
    if (lane < kPairQueueCount) queuedPairCounts[lane] = 0u;
    barrier();

    uvec2 tile = gl_WorkGroupID.xy * kTileGroupSizeTiles + laneCoordinates(lane);
    bool inside = all(lessThan(tile, frame.tileCounts));
    uint tileIndex = inside ? tileIndexOf(tile) : 0u;
    vec2 depths = inside ? tileDepthRanges[tileIndex] : vec2(1.0, -1.0);
    bool hasGeometry = depths.x <= depths.y;
    Candidates candidates;
    Froxel froxel;
    if (hasGeometry) {
        candidates = candidatesOf(tile * kShadowTileSizePx, depths.x, depths.y);
        froxel = froxelOf(tile, depths, tileDepthSlices[tileIndex]);
    }
    Found found = testLights(lane, hasGeometry, candidates, froxel);
    barrier();
    writeGroupMask(lane);
    if (kLightLists == kListsByFroxel && lane < kPairQueueCount && queuedPairCounts[lane] != 0u) {
        atomicAdd(pairs.queues[lane].listed, queuedPairCounts[lane]);
    }
    if (inside) approximateCounts[tileIndex] = found.count;
    if (kLightLists == kListsByPixel && kListReservation == kReserveAccurate) return;  // phase 3 reserves

    uint wanted = roundUpToEarlyWord(kListReservation == kReserveFixed ? frame.fixedListEntries : found.count);
    uint slotId = reserve(lane, tileIndex, wanted);
    if (!inside) return;
    bool fits = fitsListSpace(slotId, wanted) && (kLightLists == kListsByPixel || found.count <= wanted);
    if (!fits) slotId = found.count == 0u ? 0u : kNoListSpace;
    if (kLightLists == kListsByPixel) {
        tileLightSlotIds[tileIndex] = slotId;
        return;
    }
    writeTileLists(tile, slotId, found.count, found.casting);
    if (slotId != kNoListSpace) writeList(lane, tile, slotId, found.groups);
}
