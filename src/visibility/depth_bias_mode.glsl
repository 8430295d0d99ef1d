// How depths are compared: fixed when a pipeline is made.
#ifndef GNOMON_VISIBILITY_MODE_GLSL
#define GNOMON_VISIBILITY_MODE_GLSL

#include "gpu_interface/numbers.h"

layout(constant_id = kSpecDepthBias) const uint kDepthBias = kDepthBiasOriented;
// 0: pixels that look away from a light ask its shadowmap.
layout(constant_id = kSpecFacedAwayIsDark) const uint kFacedAwayIsDark = 1;

const bool kNeedsFaceNormals = kDepthBias != kDepthBiasUnbiased || kFacedAwayIsDark != 0u;

const bool kComparesPlanes = kDepthBias == kDepthBiasOriented;  // else one depth for all texels

#endif
