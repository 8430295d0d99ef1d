// Which parts of a tile's depth range hold geometry: one bit each of kDepthSlices equal slices.
//
// Problem: at a silhouette a tile's range reaches from the object to what lies behind it. Lights in between reach its
// froxel, but none of its pixels.
// Source: Harada 2012, "A 2.5D Culling for Forward+".
#ifndef GNOMON_HIERARCHICAL_DEPTH_DEPTH_SLICES_GLSL
#define GNOMON_HIERARCHICAL_DEPTH_DEPTH_SLICES_GLSL

#include "gpu_interface/numbers.h"

// The slice of a depth. What lies before the range is in the first slice, what lies beyond it in the last one. Passes may
// divide differently, to within a few float steps of the depth. So who asks for the slices between two depths takes a
// little more (Froxel::margin).
uint depthSlice(vec2 range, float depth) {
    precise float share = (depth - range.x) / max(range.y - range.x, 1e-30);
    precise float slice = clamp(share, 0.0, 1.0) * float(kDepthSlices);
    return min(uint(slice), kDepthSlices - 1u);
}

#endif
