#version 460
// The host's lighting, one work group per shadow tile. Compiled twice: for all tiles, and with EVALUATE for the few in
// which the library ran out of space and which are given the same picture by evaluating shadows here.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
// An engine reads positions and normals from its G-buffer, and then the pipeline for all tiles needs set 0, the lists,
// alone. This one has a depth buffer and nothing else, and lets the library derive both.
#include "shading/receiver.glsl"
#include "shading/tile_lights.glsl"
#ifdef EVALUATE
#include "shading/evaluate_lights.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;
// The host's own picture, by address, since sets 0 to 2 are the library's.
layout(buffer_reference, std430) writeonly buffer Picture { uint rgba8[]; };
layout(push_constant) uniform Push { Picture picture; };
// What else the host knows of its lights, in the order in which it gives them to the library: candela.
const vec3 kCandela[] = vec3[](vec3(19, 14, 8), vec3(5, 9, 17), vec3(1.5, 1.3, 1.1), vec3(0.1, 0.4, 0.15));

// Light that a white surface sends to the eye, unshadowed; the host's own falloff.
vec3 lightFrom(GpuLight light, Receiver receiver, vec3 toLight) {
    float d = distance(light.positionWs, receiver.positionWs);
    float window = 1.0 - pow(d / light.rangeMetres, 4.0);
    // A point light has direction 0 and cosOuter -2: its cone is 1 everywhere.
    float cone = clamp((dot(-toLight, light.directionWs) - light.cosOuter) / (1.0 - light.cosOuter) * 3.0, 0.0, 1.0);
    float facing = max(dot(receiver.faceNormalWs, toLight), 0.0);
    vec3 candela = kCandela[light.hostIndex] * light.lightFade;
    return candela * facing * cone * window * window / max(d * d, 1e-4);
}

vec3 illuminate(uvec2 pixel, Receiver receiver) {
    vec3 sum = vec3(0.02);  // ambient
    vec3 toLight;
#ifdef EVALUATE
    LightWalk walk = beginLightWalk(pixel);
    uint lightIndex, entry;
    while (nextLight(walk, lightIndex, entry)) {
        GpuLight light = lights[lightIndex];
        if (!lightReaches(light, receiver.positionWs, receiver.mask, toLight)) continue;
        sum += lightFrom(light, receiver, toLight) * walkVisibility(entry, pixel, light, receiver, toLight);
    }
#else
    TileLights tile = tileLightsAt(pixel);
    for (uint i = 0u; i < tile.count; ++i) {
        uint entry = tileLightEntry(tile, i);
        GpuLight light = lights[finalLightIndex(entry)];
        if (!lightReaches(light, receiver.positionWs, receiver.mask, toLight)) continue;
        sum += lightFrom(light, receiver, toLight) * storedVisibility(entry, pixel);
    }
#endif
    return sum;
}

void main() {
    uvec2 tile = gl_WorkGroupID.xy;
#ifdef EVALUATE
    if (!evaluateTileOf(gl_WorkGroupID.xy, tile)) return;
#endif
    uvec2 pixel = tile * kShadowTileSizePx + gl_LocalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frame.extentPx))) return;
#ifndef EVALUATE
    if (tileLightsAt(pixel).evaluate) return;  // the second pipeline shades this tile
#endif
    Receiver receiver = receiverAt(pixel);
    vec3 colour = receiver.valid ? illuminate(pixel, receiver) : vec3(0.005, 0.008, 0.02);
    colour = pow(clamp(colour, 0.0, 1.0), vec3(1.0 / 2.2));
    picture.rgba8[pixel.y * frame.extentPx.x + pixel.x] = packUnorm4x8(vec4(colour, 1.0));
}
