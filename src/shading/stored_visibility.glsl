// Visibility as a slot stores it: 8 bits, perceptual.
#ifndef GNOMON_SHADING_STORED_VISIBILITY_GLSL
#define GNOMON_SHADING_STORED_VISIBILITY_GLSL

float dequantiseVisibility(uint q) {
    precise float root = float(q) * (1.0 / 255.0);
    precise float visibility = root * root;
    return visibility;
}

#endif
