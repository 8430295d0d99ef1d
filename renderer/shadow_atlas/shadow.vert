// Shadow view, vertices. Drawn with the scene's index buffer; GNOMON_MASKED adds what the alpha test needs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "renderer/gpu/scene_pull.glsl"

layout(push_constant) uniform Push { mat4 clipFromWorld; };

#ifdef GNOMON_MASKED
layout(location = 0) out vec4 texcoords;
layout(location = 1) out float alpha;
#endif

void main() {
    const GpuDrawItem item = drawItems[gl_InstanceIndex];
    const uint vertex = uint(gl_VertexIndex);
    gl_Position = clipFromWorld * vec4(transformPoint(item, pullPosition(vertex)), 1.0);
#ifdef GNOMON_MASKED
    texcoords = vec4(pullTexcoord(item, vertex, 0u), pullTexcoord(item, vertex, 1u));
    alpha = pullColour(item, vertex).a;
#endif
}
