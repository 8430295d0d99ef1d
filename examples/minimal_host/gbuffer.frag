#version 460
// The G-buffer: here face normals alone, since everything is white.
#extension GL_GOOGLE_include_directive : require
#include "shading/octahedral.glsl"

layout(location = 0) flat in vec3 faceNormalWs;
layout(location = 0) out uvec2 faceNormal;  // R16G16_UINT

void main() {
    // The geometry's normal, of the side that the camera sees; never one from a normal map. A mesh with smooth normals
    // takes the cross product of dFdx and dFdy of its position instead.
    faceNormal = encodeOctahedral(faceNormalWs);
}
