// For the host's forward shaders (hair, glass).
//
// A forward surface is not at the depth that the tile lists were built for. So it finds its lights through the tile
// light masks and the zBin of its own depth. It samples the standard shadowmaps with the same filters:
// visibility/visibility.glsl, with a Receiver that the shader fills itself.
//
//     ForwardWalk walk = beginForwardWalk(uvec2(gl_FragCoord.xy) - frame.viewportPx, viewDepth);
//     uint lightIndex;
//     while (nextForwardLight(walk, lightIndex)) { ... }
#ifndef GNOMON_SHADING_FORWARD_LIGHTS_GLSL
#define GNOMON_SHADING_FORWARD_LIGHTS_GLSL

#include "shading/candidates.glsl"

struct ForwardWalk {
    Candidates candidates;
    uint groups;
    uint word;
    uint group;
};

ForwardWalk beginForwardWalk(uvec2 pixel, float viewDepth) {
    ForwardWalk walk;
    walk.candidates = candidatesOf(pixel, viewDepth, viewDepth);
    walk.groups = walk.candidates.groupBits;
    walk.word = 0u;
    walk.group = 0u;
    return walk;
}

bool nextForwardLight(inout ForwardWalk walk, out uint lightIndex) {
    lightIndex = 0u;
    while (walk.word == 0u) {
        if (walk.groups == 0u) return false;
        walk.group = findLSB(walk.groups);
        walk.groups &= walk.groups - 1u;
        walk.word = candidateWord(walk.candidates, walk.group);
    }
    lightIndex = walk.group * kLightGroupSize + findLSB(walk.word);
    walk.word &= walk.word - 1u;
    return true;
}

#endif
