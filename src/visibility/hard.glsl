// Visibility provider "hard": one texel, one comparison, at that texel's centre.
#ifndef GNOMON_VISIBILITY_HARD_GLSL
#define GNOMON_VISIBILITY_HARD_GLSL

#include "visibility/shadowmap.glsl"

float hardVisibility(ShadowPoint s) {
    vec2 texel = clamp(floor(s.corner + 0.5), s.rectMin, s.rectMax - 1.0);
    return fetchAtlas(s.atlas, s.layer, ivec2(texel)) * s.sign <= planeDepthAt(s, texel) ? 1.0 : 0.0;
}

#endif
