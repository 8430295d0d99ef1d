#version 460
// Sums over all shadow tiles for the frame's statistics: one lane per tile, one atomic per subgroup and figure.
// Not part of the technique; runs after phase 4 where a view was made with statistics.
#extension GL_GOOGLE_include_directive : require
#define GNOMON_LISTS_ACCESS
#include "vulkan/work_group.glsl"
#include "gpu_interface/working_set.glsl"
#include "shading/frame.glsl"

void main() {
    uint tile = gl_WorkGroupID.x * kWorkGroupSize + laneIndex();
    bool inside = tile < frame.tileCounts.x * frame.tileCounts.y;
    uint geometry = 0u, approximate = 0u, early = 0u, casting = 0u, entries = 0u, slots = 0u;
    if (inside) {
        vec2 depths = tileDepthRanges[tile];
        geometry = depths.x <= depths.y ? 1u : 0u;
        approximate = approximateCounts[tile];
        uint word = earlyCounts[tile];
        early = word & kEarlyCountMask;
        casting = word >> kEarlyCastingShift;
        uint count = finalCounts[tile] & kFinalCountMask;
        uint first = tileLightSlotIds[tile];
        for (uint i = 0u; i < count; ++i) {
            uint slot = finalSlotOrFlag(finalList[first + i]);
            entries += slot != kSlotAllUnlit ? 1u : 0u;
            slots += slot < kSlotEvaluate ? 1u : 0u;
        }
    }
    geometry = subgroupAdd(geometry);
    approximate = subgroupAdd(approximate);
    uint most = subgroupMax(early);
    early = subgroupAdd(early);
    casting = subgroupAdd(casting);
    entries = subgroupAdd(entries);
    slots = subgroupAdd(slots);
    if (!subgroupElect()) return;
    if (geometry != 0u) atomicAdd(counters.tilesWithGeometry, geometry);
    if (approximate != 0u) atomicAdd(counters.approximateEntries, approximate);
    if (early != 0u) atomicAdd(counters.earlyEntries, early);
    if (casting != 0u) atomicAdd(counters.earlyCastingEntries, casting);
    if (entries != 0u) atomicAdd(counters.finalEntries, entries);
    if (slots != 0u) atomicAdd(counters.finalSlotEntries, slots);
    atomicMax(counters.maxLightsInTile, most);
}
