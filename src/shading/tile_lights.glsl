// For the host's deferred lighting shader: walk the final light list of a pixel's shadow tile.
//
// The main lighting pipeline, one work group of 64 lanes per shadow tile (or any other shape):
//
//     TileLights tile = tileLightsOf(gl_WorkGroupID.xy);  // or tileLightsAt(pixel)
//     if (tile.evaluate) return;                        // the second pipeline shades this tile
//     for (uint i = 0u; i < tile.count; ++i) {
//         uint entry = tileLightEntry(tile, i);
//         if (isAllUnlit(entry)) continue;              // dark all over the tile
//         GpuLight light = lights[finalLightIndex(entry)];
//         vec3 toLight;
//         if (!lightReaches(light, positionWs, receiverMask, toLight)) continue;
//         float visibility = storedVisibility(entry, pixel);
//         ... light.lightFade, the host's own light data at light.hostIndex, its own factor (cookie, cloud) ...
//     }
//
// Needs the set of the lists alone. The second pipeline: shading/evaluate_lights.glsl.
// Source: the paper, sections 2.4.1 and 2.4.2.
#ifndef GNOMON_SHADING_TILE_LIGHTS_GLSL
#define GNOMON_SHADING_TILE_LIGHTS_GLSL

#include "shading/frame.glsl"
#include "shading/light_tests.glsl"
#include "shading/stored_visibility.glsl"

struct TileLights {
    uint first;     // in finalList
    uint count;
    bool evaluate;  // some entry says EVALUATE, or the tile has no list
};

// For shaders whose work group is the tile. Give gl_WorkGroupID: a compiler then knows that list and lights are the
// same for all lanes, and keeps them in scalar registers (docs/register-pressure.md).
TileLights tileLightsOf(uvec2 tileCoordinates) {
    uint tile = tileIndexOf(tileCoordinates);
    uint word = finalCounts[tile];
    TileLights t;
    t.first = tileLightSlotIds[tile];
    t.count = word & kFinalCountMask;
    t.evaluate = (word & kFinalEvaluateBit) != 0u;
    return t;
}

TileLights tileLightsAt(uvec2 pixel) { return tileLightsOf(pixel / kShadowTileSizePx); }

uint tileLightEntry(TileLights tile, uint i) { return finalList[tile.first + i]; }

bool isAllUnlit(uint entry) { return finalSlotOrFlag(entry) == kSlotAllUnlit; }

// Stored visibility of a pixel in a slot.
uint slotVisibility(uint slot, uvec2 pixel) {
    uvec2 local = pixel % kShadowTileSizePx;
    uint lane = mortonLane(local.x, local.y);
    const uint perWord = 32u / kVisibilityBits;
    uint word = visibilityWords[slot * kVisibilitySlotWords + lane / perWord];
    return word >> (kVisibilityBits * (lane % perWord)) & kVisibilityLevels;
}

// 0 dark to 1 lit. An entry that says EVALUATE never occurs in a tile without `evaluate`.
float storedVisibility(uint entry, uvec2 pixel) {
    uint slot = finalSlotOrFlag(entry);
    if (slot == kSlotAllLit) return 1.0;
    if (slot >= kSlotEvaluate) return 0.0;
    return dequantiseVisibility(slotVisibility(slot, pixel));
}

#endif
