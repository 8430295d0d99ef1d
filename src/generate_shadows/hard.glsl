// Visibility provider "hard": one texel, one comparison.
float hardVisibility(GpuLight light, Receiver receiver, vec3 toLight) {
    ShadowPoint s = shadowPointOf(light, receiver, toLight, 0.0);
    return s.inFront ? litBy(s, fetchShadowTexel(s, ivec2(floor(s.px)))) : 1.0;
}
