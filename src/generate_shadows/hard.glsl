// Visibility provider "hard": one texel, one comparison, at that texel's centre.
float hardVisibility(ShadowPoint s) {
    vec2 texel = clamp(floor(s.px), s.rectMin, s.rectMax - 1.0);
    return litBy(s, planeDepthAt(s, texel + 0.5), fetchAtlas(s.atlas, s.layer, ivec2(texel)));
}
