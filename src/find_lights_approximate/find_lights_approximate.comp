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
// Uniformity: the walk goes over the OR of a subgroup's candidates. So subgroup operations are never in divergent flow,
// and light data are loaded once per subgroup. Subgroups meet in shared memory, with two barriers in all.
#extension GL_GOOGLE_include_directive : require
#define GNOMON_LISTS_ACCESS
#include "vulkan/work_group.glsl"
#include "gpu_interface/working_set.glsl"
#include "find_lights_approximate/froxel.glsl"
#include "shading/candidates.glsl"

layout(constant_id = kSpecListReservation) const uint kListReservation = kReserveApproximate;

shared uint groupWords[kLightGroupCount];
shared uint subgroupEntries[kSubgroupCount];
shared uint groupSlotId;

// Walks the candidates of this lane's tile; returns how many lights the tile may see.
uint testLights(bool hasGeometry, Candidates candidates, Froxel froxel) {
    uint count = 0u;
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
            if ((wanted >> bit & 1u) != 0u && lightMayReachFroxel(light, froxel)) found |= 1u << bit;
        }
        count += bitCount(found);
        uint any = subgroupOr(found);
        if (any != 0u && subgroupElect()) atomicOr(groupWords[group], any);
    }
    return count;
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

void main() {
    uint lane = laneIndex();
    if (lane < kLightGroupCount) groupWords[lane] = 0u;
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
        froxel = froxelOf(tile, depths.x, depths.y);
    }
    uint count = testLights(hasGeometry, candidates, froxel);

    uint wanted = roundUpToEarlyWord(count);
    uint before = subgroupExclusiveAdd(wanted);
    uint total = subgroupAdd(wanted);
    if (subgroupElect()) subgroupEntries[gl_SubgroupID] = total;
    barrier();
    writeGroupMask(lane);
    if (inside) approximateCounts[tileIndex] = count;
    if (kListReservation == kReserveAccurate) return;  // phase 3 reserves

    uint slotId;
    if (kListReservation == kReserveFixed) {
        wanted = roundUpToEarlyWord(frame.fixedListEntries);
        slotId = tileIndex * wanted;
    } else {
        total = 0u;
        for (uint i = 0u; i < kSubgroupCount; ++i) {
            if (i < gl_SubgroupID) before += subgroupEntries[i];
            total += subgroupEntries[i];
        }
        if (lane == 0u) groupSlotId = total == 0u ? 0u : atomicAdd(counters.listEntries, total);
        barrier();
        slotId = groupSlotId + before;
    }
    if (!inside) return;
    bool fits = slotId <= frame.listCapacity && wanted <= frame.listCapacity - slotId;
    tileLightSlotIds[tileIndex] = fits || count == 0u ? (fits ? slotId : 0u) : kNoListSpace;
    if (!fits && count != 0u) atomicAdd(counters.listOverflowTiles, 1u);
}
