// How vertex shaders pull the scene's geometry: descriptor set 0 (gpu_scene.h).
#ifndef GNOMON_RENDERER_SCENE_PULL_GLSL
#define GNOMON_RENDERER_SCENE_PULL_GLSL
#include "renderer/gpu/scene_data.h"

layout(set = 0, binding = 0, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 1, std430) readonly buffer Attributes { uint attributes[]; };
layout(set = 0, binding = 2, std430) readonly buffer Extras { uint extras[]; };
layout(set = 0, binding = 3, std430) readonly buffer Indices { uint indices[]; };
layout(set = 0, binding = 4, std430) readonly buffer DrawItems { GpuDrawItem drawItems[]; };

vec3 pullPosition(uint vertex) {
    const uint at = 3u * vertex;
    return vec3(positions[at], positions[at + 1u], positions[at + 2u]);
}

vec3 transformPoint(GpuDrawItem item, vec3 p) {
    const vec4 h = vec4(p, 1.0);
    return vec3(dot(item.row0, h), dot(item.row1, h), dot(item.row2, h));
}
vec3 transformVector(GpuDrawItem item, vec3 v) {
    return vec3(dot(item.row0.xyz, v), dot(item.row1.xyz, v), dot(item.row2.xyz, v));
}
// By the cofactor matrix: the inverse transposed up to a positive factor, also for mirrored items, and for flat ones,
// which have no inverse. Zero for a normal in the plane of a flat item. Not of unit length.
vec3 transformNormal(GpuDrawItem item, vec3 n) {
    // Near 1 first: products of small numbers leave a float's range.
    const vec3 most = max(max(abs(item.row0.xyz), abs(item.row1.xyz)), abs(item.row2.xyz));
    const float scale = 1.0 / max(max(most.x, most.y), max(most.z, 1e-30));
    const vec3 a = vec3(item.row0.x, item.row1.x, item.row2.x) * scale;
    const vec3 b = vec3(item.row0.y, item.row1.y, item.row2.y) * scale;
    const vec3 c = vec3(item.row0.z, item.row1.z, item.row2.z) * scale;
    const vec3 t = cross(b, c) * n.x + cross(c, a) * n.y + cross(a, b) * n.z;
    return (item.flags & kItemMirroredBit) != 0u ? -t : t;
}

vec3 unpackOctahedral(uint word) {
    const vec2 e = unpackSnorm2x16(word);
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    const float fold = max(-n.z, 0.0);
    n.x += n.x >= 0.0 ? -fold : fold;
    n.y += n.y >= 0.0 ? -fold : fold;
    return normalize(n);
}

vec2 pullTexcoord(GpuDrawItem item, uint vertex, uint set) {
    if (set == 1u && (item.flags & kItemExtrasBit) != 0u) {
        const uint at = (vertex + item.extraOffset) * kExtraWords;
        return vec2(uintBitsToFloat(extras[at]), uintBitsToFloat(extras[at + 1u]));
    }
    const uint at = vertex * kAttributeWords;
    return vec2(uintBitsToFloat(attributes[at + 2u]), uintBitsToFloat(attributes[at + 3u]));
}
vec4 pullColour(GpuDrawItem item, uint vertex) {
    if ((item.flags & kItemExtrasBit) == 0u) return vec4(1.0);
    const uint at = (vertex + item.extraOffset) * kExtraWords;
    return vec4(unpackHalf2x16(extras[at + 2u]), unpackHalf2x16(extras[at + 3u]));
}
#endif
