#version 460
// Copies a buffer, 64 bytes a lane, neighbouring lanes neighbouring words: as fast as memory goes.
layout(local_size_x = 256) in;
layout(set = 0, binding = 0, std430) restrict readonly buffer Source { uvec4 source[]; };
layout(set = 0, binding = 1, std430) restrict writeonly buffer Target { uvec4 target[]; };

void main() {
    uint lanes = gl_NumWorkGroups.x * 256u;
    for (uint i = 0u; i < 4u; ++i) {
        uint at = i * lanes + gl_GlobalInvocationID.x;
        target[at] = source[at];
    }
}
