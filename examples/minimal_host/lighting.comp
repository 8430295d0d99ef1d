#version 460
// The host's lighting, one work group per shadow tile. Two pipelines from one file:
//
//   all tiles      Reads lists and stored visibility. It has no set of shadowmaps: that is where the technique saves
//                  its registers.
//   with EVALUATE  The few tiles in which a pool ran out. It evaluates shadows itself, and makes the very picture that
//                  larger pools would have given.
#extension GL_GOOGLE_include_directive : require

// Sets 0 and 1 are the library's lists and receivers. The host's own set is 2, in both pipelines; the shadowmaps, which
// the second pipeline alone has, come last, so that one binding of the first three serves both.
#define GNOMON_SHADOWMAPS_SET 3

#include "shading/receiver.glsl"
#include "shading/tile_lights.glsl"
#ifdef EVALUATE
#include "shading/evaluate_lights.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 2, binding = 0, rgba8) uniform restrict writeonly image2D picture;
// What else the host knows of its lights, in the order in which it gives them to the library: candela, or lux of
// directional lights.
layout(set = 2, binding = 1, std430) restrict readonly buffer HostLights { vec4 intensities[]; };

// Light that a white surface sends to the eye, unshadowed. The falloff is the host's own business, as long as it is
// nothing beyond GpuLight::rangeMetres and outside of the cone: the lists end there.
vec3 lightFrom(GpuLight light, Receiver receiver, vec3 toLight) {
    // The library's own fade with distance; that of the shadow is in the visibility already.
    vec3 intensity = intensities[light.hostIndex].rgb * light.lightFade;
    float facing = max(dot(receiver.faceNormalWs, toLight), 0.0);
    if (lightType(light) == kLightDirectional) return intensity * facing;
    float metres = distance(light.positionWs, receiver.positionWs);
    float window = 1.0 - pow(metres / light.rangeMetres, 4.0);
    // A point light has direction 0 and cosOuter -2: its cone is 1 everywhere.
    float cone = clamp((dot(-toLight, light.directionWs) - light.cosOuter) / (1.0 - light.cosOuter) * 3.0, 0.0, 1.0);
    return intensity * (facing * cone * window * window / max(metres * metres, 1e-4));
}

// Both ways ask lightReaches(), and no test of their own: where it says no, no visibility was stored.
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
    TileLights tile = tileLightsOf(gl_WorkGroupID.xy);
    for (uint i = 0u; i < tile.count; ++i) {
        uint entry = tileLightEntry(tile, i);
        if (isAllUnlit(entry)) continue;  // its light is dark all over the tile, or reaches no pixel of it
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
#else
    if (tileLightsOf(tile).evaluate) return;  // the second pipeline shades this tile
#endif
    uvec2 pixel = tile * kShadowTileSizePx + gl_LocalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frame.extentPx))) return;
    // Depth, position, face normal and flags, as the library sees them. Read your own G-buffer instead if it has a
    // position that is equal to the last bit; then the pipeline for all tiles needs the lists alone.
    Receiver receiver = receiverAt(pixel);
    vec3 colour = receiver.valid ? illuminate(pixel, receiver) : vec3(0.005, 0.008, 0.02);
    colour = pow(clamp(colour, 0.0, 1.0), vec3(1.0 / 2.2));
    imageStore(picture, ivec2(pixel), vec4(colour, 1.0));
}
