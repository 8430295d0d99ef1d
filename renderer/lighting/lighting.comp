#version 460
// Lighting of the reference renderer, one work group per shadow tile. Three pipelines from one file:
//
//   GNOMON_DEFERRED  the technique: reads the final lists and visibility slots. It has no set of shadowmaps.
//   GNOMON_EVALUATE  its second pipeline, for tiles in which a slot or list space was missing; dispatched indirectly.
//   GNOMON_INLINE    the paper's "before": the same early lists, the same filters, shadows evaluated right here.
//
// Each once more with GNOMON_FLOAT_PICTURE, for pictures of 32-bit floats.
//
// Source: the paper, section 2, and table 1 for the comparison.
#extension GL_GOOGLE_include_directive : require
#include "renderer/lighting/shade.glsl"
#include "vulkan/work_group.glsl"
#include "shading/receiver.glsl"
#ifdef GNOMON_DEFERRED
#include "shading/tile_lights.glsl"
#else
#include "shading/evaluate_lights.glsl"
#endif

layout(constant_id = kSpecFirstFree) const uint kQuantise = 1;
layout(constant_id = kSpecFirstFree + 1) const uint kWalksMasks = 1;  // inline: tiles without list space are shaded too

vec3 eyeDirection(Receiver receiver) {
    return isOrthographic() ? -frame.axisZWs : normalize(frame.eyeWs - receiver.positionWs);
}

// Alpha 0 says that no geometry is there.
void writeBackground(uvec2 pixel) {
    vec2 xy = (vec2(pixel) + 0.5) * frame.viewXyPerPixel + frame.viewXyAtPixel0;
    vec3 direction = frame.axisZWs;
    if (!isOrthographic()) direction = normalize(frame.axisXWs * xy.x + frame.axisYWs * xy.y + direction);
    imageStore(picture, ivec2(pixel), vec4(backgroundRadiance(direction), 0.0));
}

#ifdef GNOMON_DEFERRED
vec3 shadeLights(Surface surface, Receiver receiver, uvec2 pixel, TileLights tile) {
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < tile.count; ++i) {
        uint entry = tileLightEntry(tile, i);
        if (isAllUnlit(entry)) continue;
        GpuLight light = lights[finalLightIndex(entry)];
        vec3 toLight;
        if (!lightReaches(light, receiver.positionWs, receiver.mask, toLight)) continue;
        float visibility = storedVisibility(entry, pixel);
        if (visibility > 0.0) sum += visibility * shadeLight(surface, light, receiver.positionWs, toLight);
    }
    return sum;
}
#endif

#ifdef GNOMON_EVALUATE
vec3 shadeLights(Surface surface, Receiver receiver, uvec2 pixel) {
    vec3 sum = vec3(0.0);
    LightWalk walk = beginLightWalk(pixel);
    uint lightIndex, entry;
    while (nextLight(walk, lightIndex, entry)) {
        GpuLight light = lights[lightIndex];
        vec3 toLight;
        if (!lightReaches(light, receiver.positionWs, receiver.mask, toLight)) continue;
        float visibility = walkVisibility(entry, pixel, light, receiver, toLight);
        if (visibility > 0.0) sum += visibility * shadeLight(surface, light, receiver.positionWs, toLight);
    }
    return sum;
}
#endif

#ifdef GNOMON_INLINE
// Every skip that the deferred way has: facing away, out of range or cone, and shading only where something is lit.
void addLight(GpuLight light, Surface surface, Receiver receiver, inout vec3 sum) {
    vec3 toLight;
    if (!lightReaches(light, receiver.positionWs, receiver.mask, toLight)) return;
    float visibility = evaluateVisibility(light, receiver, toLight);
    if (kQuantise != 0u) visibility = dequantiseVisibility(quantiseVisibility(visibility));
    if (visibility > 0.0) sum += visibility * shadeLight(surface, light, receiver.positionWs, toLight);
}

vec3 shadeLights(Surface surface, Receiver receiver, uvec2 pixel) {
    vec3 sum = vec3(0.0);
    uint tile = tileIndexOf(gl_WorkGroupID.xy);
    uint slotId = tileLightSlotIds[tile];
    if (slotId == kNoListSpace) {
        if (kWalksMasks == 0u) return sum;
        LightWalk walk = beginMaskWalk(pixel);
        uint lightIndex;
        while (nextMaskLight(walk, lightIndex)) addLight(lights[lightIndex], surface, receiver, sum);
        return sum;
    }
    uint count = earlyCounts[tile] & kEarlyCountMask;
    for (uint i = 0u; i < count; ++i) {
        uint lightIndex = unpackEarlyIndex(earlyList[earlyWordIndex(slotId, i)], i);
        addLight(lights[lightIndex], surface, receiver, sum);
    }
    return sum;
}
#endif

void main() {
#ifdef GNOMON_EVALUATE
    uvec2 tile;
    if (!evaluateTileOf(gl_WorkGroupID.xy, tile)) return;
#else
    uvec2 tile = gl_WorkGroupID.xy;
#endif
    uvec2 pixel = tile * kShadowTileSizePx + laneCoordinates(laneIndex());
#ifdef GNOMON_DEFERRED
    TileLights tileLights = tileLightsOf(gl_WorkGroupID.xy);
    if (tileLights.evaluate) return;
#endif
    if (any(greaterThanEqual(pixel, frame.extentPx))) return;
    Receiver receiver = receiverAt(pixel);
    if (!receiver.valid) {
        writeBackground(pixel);
        return;
    }
    Surface surface = surfaceAt(ivec2(pixel), eyeDirection(receiver), receiver.subsurface);
#ifdef GNOMON_DEFERRED
    vec3 radiance = shadeLights(surface, receiver, pixel, tileLights);
#else
    vec3 radiance = shadeLights(surface, receiver, pixel);
#endif
    radiance += ambient(surface);
    imageStore(picture, ivec2(pixel), vec4(min(radiance, vec3(kBrightest)), 1.0));
}
