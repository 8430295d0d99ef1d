// The filters that a pipeline holds the code of.
#ifndef GNOMON_VISIBILITY_FILTERS_GLSL
#define GNOMON_VISIBILITY_FILTERS_GLSL

#include "gpu_interface/numbers.h"
#include "gpu_interface/structs.h"

// A set; with one there is nothing to choose. None: everything is lit.
layout(constant_id = kSpecFilters) const uint kFilters = 1u << kFilterPcss;

uint filterOf(GpuLight light) { return light.typeAndFlags >> kLightFilterShift & kLightFilterMask; }

bool hasFilter(GpuLight light, uint filterOfLight) {
    uint bit = 1u << filterOfLight;
    if ((kFilters & bit) == 0u) return false;
    return kFilters == bit || filterOf(light) == filterOfLight;
}

// Whether the frame has filters that are evaluated tile by tile, or nothing to evaluate at all. Then lights without
// shadows are left to the tiles, too.
bool hasTileFilters() { return kFilters == 0u || (kFilters & kFiltersByTile) != 0u; }

bool isForTiles(GpuLight light) {
    if (!hasTileFilters()) return false;
    bool casts = (light.typeAndFlags & kLightCastsBit) != 0u;
    return kFilters == 0u || !casts || (kFiltersByTile >> filterOf(light) & 1u) != 0u;
}

#endif
