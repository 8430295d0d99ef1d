// G-buffer, vertices. Each invocation knows its whole triangle, so the face normal and the triangle id are exact and
// need neither derivatives nor a geometry shader (SwiftShader has none, so no gl_PrimitiveID in fragment shaders).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "renderer/gpu/scene_pull.glsl"

layout(push_constant) uniform Push {
    mat4 clipFromView;
    vec4 viewFromWorldRows[3];
    vec4 eye;  // w 1: the camera's position; w 0: the direction towards an orthographic camera
};

layout(location = 0) out vec3 positionWs;
layout(location = 1) out vec3 normalWs;
layout(location = 2) out vec4 tangentWs;  // w: handedness, 0: none
layout(location = 3) out vec4 texcoords;
layout(location = 4) out vec4 colour;
layout(location = 5) flat out vec3 faceNormalWs;  // towards the camera; 0 for a degenerate triangle
layout(location = 6) flat out uint triangleId;
layout(location = 7) flat out uint seesBack;

void main() {
    const uint triangle = uint(gl_VertexIndex) / 3u;
    const uint corner = uint(gl_VertexIndex) % 3u;
    const GpuDrawItem item = drawItems[gl_InstanceIndex];
    const uint vertex = indices[3u * triangle + corner];
    const vec3 p0 = pullPosition(indices[3u * triangle]);
    // Edges are formed before the transform: nothing of the object's size is lost to its place.
    const vec3 e1 = transformVector(item, pullPosition(indices[3u * triangle + 1u]) - p0);
    const vec3 e2 = transformVector(item, pullPosition(indices[3u * triangle + 2u]) - p0);
    const float size = max(max(max(abs(e1.x), abs(e1.y)), abs(e1.z)), max(max(abs(e2.x), abs(e2.y)), abs(e2.z)));
    vec3 face = size > 0.0 ? cross(e1 / size, e2 / size) : vec3(0.0);
    if ((item.flags & kItemMirroredBit) != 0u) face = -face;
    const float area = length(face);
    face = area > 1e-12 ? face / area : vec3(0.0);
    seesBack = dot(face, eye.xyz - transformPoint(item, p0) * eye.w) < 0.0 ? 1u : 0u;
    faceNormalWs = seesBack != 0u ? -face : face;
    triangleId = triangle + item.triangleIdOffset;

    positionWs = transformPoint(item, pullPosition(vertex));
    // In two steps. Far from the origin, rounding moves the place in the view, and clip z and w then move alike. In one
    // step each would be rounded by itself. With standard Z their quotient turns 0.1 mm of the view into centimetres.
    const vec4 p = vec4(positionWs, 1.0);
    gl_Position =
        clipFromView *
        vec4(dot(viewFromWorldRows[0], p), dot(viewFromWorldRows[1], p), dot(viewFromWorldRows[2], p), 1.0);
    texcoords = vec4(pullTexcoord(item, vertex, 0u), pullTexcoord(item, vertex, 1u));
    colour = pullColour(item, vertex);
    normalWs = face;
    if ((item.flags & kItemNormalsBit) != 0u) {
        const vec3 n = transformNormal(item, unpackOctahedral(attributes[vertex * kAttributeWords]));
        const float squared = dot(n, n);
        if (squared > 0.0) normalWs = n * inversesqrt(squared);
    }
    tangentWs = vec4(0.0);
    if ((item.flags & kItemTangentsBit) != 0u) {
        const uint word = attributes[vertex * kAttributeWords + 1u];
        float handedness = (word & 0x10000u) != 0u ? -1.0 : 1.0;
        if ((item.flags & kItemMirroredBit) != 0u) handedness = -handedness;
        tangentWs = vec4(normalize(transformVector(item, unpackOctahedral(word))), handedness);
    }
}
