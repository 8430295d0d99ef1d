// Visibility as a slot stores it: 8 bits or 4, perceptual.
#ifndef GNOMON_SHADING_STORED_VISIBILITY_GLSL
#define GNOMON_SHADING_STORED_VISIBILITY_GLSL

#include "gpu_interface/packing.h"

layout(constant_id = kSpecVisibilityBits) const uint kVisibilityBits = kMaxVisibilityBits;
// visibilityLevels() and visibilitySlotWords() of packing.h, as constants.
const uint kVisibilityLevels = (1u << kVisibilityBits) - 1u;
const uint kVisibilitySlotWords = kWorkGroupSize * kVisibilityBits / 32u;

float dequantiseVisibility(uint q) {
    precise float root = float(q) / float(kVisibilityLevels);
    precise float visibility = root * root;
    return visibility;
}

#endif
