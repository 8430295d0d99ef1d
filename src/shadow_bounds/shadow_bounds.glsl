// The least and the greatest depth that a shadowmap holds around a place.
#ifndef GNOMON_SHADOW_BOUNDS_SHADOW_BOUNDS_GLSL
#define GNOMON_SHADOW_BOUNDS_SHADOW_BOUNDS_GLSL

#include "gpu_interface/shadowmaps_set.glsl"

// The bounds of a shadow view, over all texels that a box in atlas pixels touches. The box lies in the view's
// rectangle. Four blocks as wide as the box cover it. `known` is false where the view has no bounds, or the box is too
// large.
vec2 shadowBoundsOver(uint view, vec2 low, vec2 high, out bool known) {
    uint blocks = shadowViews[view].boundsBlocks;
    uint size = uint(ceil(max(high.x - low.x, high.y - low.y)));
    uint level = size <= kShadowBoundsBlockPx ? 0u : uint(findMSB(size - 1u)) - 3u;
    known = blocks != 0u && level < kShadowBoundsLevels;
    if (!known) return vec2(0.0, 1.0);
    uint base = shadowViews[view].boundsFirst;
    uint row = shadowViews[view].boundsRow;
    uint shift = uint(findMSB(kShadowBoundsBlockPx)) + level;
    uvec2 first = uvec2(low) >> shift;
    uvec2 last = uvec2(high) >> shift;
    vec2 a = shadowBounds[shadowBoundsIndex(base, row, blocks, level, first)];
    vec2 b = shadowBounds[shadowBoundsIndex(base, row, blocks, level, uvec2(last.x, first.y))];
    vec2 c = shadowBounds[shadowBoundsIndex(base, row, blocks, level, uvec2(first.x, last.y))];
    vec2 d = shadowBounds[shadowBoundsIndex(base, row, blocks, level, last)];
    return vec2(min(min(a.x, b.x), min(c.x, d.x)), max(max(a.y, b.y), max(c.y, d.y)));
}

#endif
