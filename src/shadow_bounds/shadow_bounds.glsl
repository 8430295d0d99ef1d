// What a shadowmap holds around a place: the least and the greatest depth, and how far its depths lie off a plane.
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

// A plane over texels, in depths that have a sign: at texel t it has depth + slope (t - corner).
struct DepthPlane {
    vec2 corner;
    vec2 slope;
    float depth;
    float sign;  // times a stored depth
};

// How far what is stored lies before the plane, least and greatest, over the part of a block that a box in atlas pixels
// touches. It is rounded outward.
vec2 heightOverBlock(uint view, DepthPlane plane, vec2 low, vec2 high, uvec2 block) {
    uint first = shadowViews[view].planesFirst;
    vec4 fitted = shadowPlanes[shadowPlaneIndex(first, shadowViews[view].boundsRow, block)];
    vec2 slope = fitted.xy * plane.sign;
    vec2 left = plane.sign > 0.0 ? fitted.zw : -fitted.wz;
    vec2 origin = vec2(block * kShadowBoundsBlockPx);
    vec2 from = max(low - 1.0, origin);
    vec2 to = max(min(high, origin + float(kShadowBoundsBlockPx - 1u)), from);
    vec2 middle = 0.5 * (from + to);
    float height = dot(slope, middle - origin) - (plane.depth + dot(plane.slope, middle - plane.corner));
    float turn = dot(abs(slope - plane.slope), 0.5 * (to - from));
    float steepest = float(kShadowBoundsBlockPx) * (abs(slope.x) + abs(slope.y));
    float slack = 4e-6 * (abs(plane.depth) + max(abs(left.x), abs(left.y)) + steepest) +
                  1e-5 * dot(abs(plane.slope), abs(middle - plane.corner) + 1.0);
    return vec2(height + left.x - (turn + slack), height + left.y + (turn + slack));
}

// The same over a box that four blocks cover. `known` is false where they do not, or where the view has no bounds.
vec2 heightOver(uint view, DepthPlane plane, vec2 low, vec2 high, out bool known) {
    float size = max(high.x - low.x, high.y - low.y);
    known = shadowViews[view].boundsBlocks != 0u && size <= float(kShadowBoundsBlockPx);
    vec2 height = vec2(0.0);
    if (!known) return height;
    uvec2 first = uvec2(low) / kShadowBoundsBlockPx;
    uvec2 last = uvec2(high) / kShadowBoundsBlockPx;
    height = heightOverBlock(view, plane, low, high, first);
    for (uint i = 1u; i < 4u; ++i) {
        uvec2 block = uvec2((i & 1u) != 0u ? last.x : first.x, (i & 2u) != 0u ? last.y : first.y);
        if (i == 3u || block != first) {
            vec2 h = heightOverBlock(view, plane, low, high, block);
            height = vec2(min(height.x, h.x), max(height.y, h.y));
        }
    }
    return height;
}

#endif
