// For the host's second lighting pipeline: tiles in which a visibility slot or list space was missing.
//
// It is dispatched indirectly from View::evaluateTilesBuffer(), has all three sets, and gives exactly the picture that
// larger pools would have given:
//
//     uvec2 tile;
//     if (!evaluateTileOf(gl_WorkGroupID.xy, tile)) return;
//     Receiver receiver = receiverAt(pixel);
//     LightWalk walk = beginLightWalk(pixel);
//     uint lightIndex, entry;
//     while (nextLight(walk, lightIndex, entry)) {
//         ... as in shading/tile_lights.glsl, with
//         float visibility = walkVisibility(entry, pixel, light, receiver, toLight);
//     }
//
// The walk yields light indices in ascending order, from the final list or, without list space, from the tile group's
// mask. Lights of a mask may be dark all over the tile; walkVisibility() says so.
#ifndef GNOMON_SHADING_EVALUATE_LIGHTS_GLSL
#define GNOMON_SHADING_EVALUATE_LIGHTS_GLSL

#include "visibility/visibility.glsl"
#include "shading/candidates.glsl"
#include "shading/tile_lights.glsl"

bool evaluateTileOf(uvec2 workGroup, out uvec2 tile) {
    uint i = workGroup.y * kEvaluateRowTiles + workGroup.x;
    tile = uvec2(0u);
    if (i >= evaluateHead.tileCount) return false;
    uint packed = evaluateTiles[i];
    tile = uvec2(packed & 0xFFFFu, packed >> 16u);
    return true;
}

struct LightWalk {
    bool fromMask;
    uint next;   // list: next entry, mask: group bits left
    uint end;    // list: one past the last entry, mask: first word of the group's mask
    uint word;   // mask: light bits left
    uint group;
    Candidates candidates;
};

LightWalk beginMaskWalk(uvec2 pixel) {
    uvec2 tile = pixel / kShadowTileSizePx;
    vec2 depths = tileDepthRanges[tileIndexOf(tile)];
    LightWalk walk;
    walk.fromMask = true;
    walk.end = tileGroupIndexOf(tile) * kLightMaskEntryWords;
    walk.candidates = candidatesOf(pixel, depths.x, depths.y);
    walk.next = depths.x <= depths.y ? walk.candidates.groupBits & tileGroupLightMasks[walk.end] : 0u;
    walk.word = 0u;
    walk.group = 0u;
    return walk;
}

LightWalk beginListWalk(uint first, uint count) {
    LightWalk walk;
    walk.fromMask = false;
    walk.next = first;
    walk.end = first + count;
    walk.word = 0u;
    walk.group = 0u;
    return walk;
}

LightWalk beginLightWalk(uvec2 pixel) {
    TileLights tile = tileLightsAt(pixel);
    if (tile.first == kNoListSpace) return beginMaskWalk(pixel);
    return beginListWalk(tile.first, tile.count);
}

bool nextMaskLight(inout LightWalk walk, out uint lightIndex) {
    lightIndex = 0u;
    while (walk.word == 0u) {
        if (walk.next == 0u) return false;
        walk.group = findLSB(walk.next);
        walk.next &= walk.next - 1u;
        walk.word = tileGroupLightMasks[walk.end + 1u + walk.group] & candidateWord(walk.candidates, walk.group);
    }
    lightIndex = walk.group * kLightGroupSize + findLSB(walk.word);
    walk.word &= walk.word - 1u;
    return true;
}

bool nextLight(inout LightWalk walk, out uint lightIndex, out uint entry) {
    if (walk.fromMask) {
        bool found = nextMaskLight(walk, lightIndex);
        entry = packFinalEntry(lightIndex, kSlotEvaluate);
        return found;
    }
    entry = 0u;
    lightIndex = 0u;
    if (walk.next >= walk.end) return false;
    entry = finalList[walk.next++];
    lightIndex = finalLightIndex(entry);
    return true;
}

float walkVisibility(uint entry, uvec2 pixel, GpuLight light, Receiver receiver, vec3 toLight) {
    if (finalSlotOrFlag(entry) != kSlotEvaluate) return storedVisibility(entry, pixel);
    return dequantiseVisibility(quantiseVisibility(evaluateVisibility(light, receiver, toLight)));
}

#endif
