// Visibility provider "pcss": percentage closer soft shadows, the penumbra of a light with a size.
//
// Problem: a shadow is sharp where it touches its blocker and widens with the distance from it.
// Source: Fernando 2005, "Percentage-Closer Soft Shadows". Its penumbra is (z - zb) / zb times the source's size.
// Plain way: average the blockers in a region of fixed width, then average comparisons in a region as wide as the
// penumbra of that average.
// Here: (1) The disk that the source is, seen from the receiver through the map, is a disk whose radius is linear in the
// blocker's *device* depth, with and without perspective: one multiplication per stored depth. So (2) each blocker is
// asked whether it lies in the disk of its own depth, which makes a wide search harmless: what the source cannot see does
// not count. (3) Search taps, four texels each, crowd toward the middle (radius by the square), where near blockers must
// be found; filter taps are spread evenly, each a bilinear comparison. (4) A pixel in which no texel of the search is a
// blocker is lit, one in which all occlude is dark.
// Shadow bounds, where the host has them made, tell that of most pixels before any tap.
// (5) The pattern is a spiral of golden angles, turned per pixel by a sequence of low discrepancy in whole numbers: every
// pipeline and device sees the same one. (6) A blocker is nearer to the light than the receiver: a tap's plane depth
// grows beyond the receiver's by one texel's slope at most, else walls behind the receiver would shadow it.
// Limits: one depth per texel stands for all blockers behind each other; radii beyond kMaxPcssRadiusPx texels are cut.
#ifndef GNOMON_GENERATE_SHADOWS_PCSS_GLSL
#define GNOMON_GENERATE_SHADOWS_PCSS_GLSL

#include "generate_shadows/shadowmap.glsl"
#include "shadow_bounds/shadow_bounds.glsl"

layout(constant_id = 5) const uint kPcssSearchTaps = 16;
layout(constant_id = 6) const uint kPcssFilterTaps = 24;

// Nearer blockers are searched for as if they were at this share of the receiver's depth.
const float kNearestBlocker = 0.1;
const float kGoldenCosine = -0.7373688780783197;
const float kGoldenSine = 0.6754902942615238;

struct PcssKernel {
    vec2 first;     // direction of the first tap
    vec2 right;     // texels per tangent (perspective) or per metre, right and down in the disk that the receiver sees
    vec2 down;
    float texel;    // one texel in those units
    float widest;   // radius of the search, without its margin of a texel
    float radius0;  // radius of the source's disk at device depth d: radius0 + radius1 * d
    float radius1;
    float nearest;  // bounds of the depth that a texel is compared with: at most a texel's slope behind the receiver
    float farthest;
    bool cube;      // point light: taps that leave the face look at another
};

// Turned per pixel: 32 bits are a turn. In whole numbers, since every pipeline must have the same.
vec2 firstDirection(uvec2 pixel) {
    uint turn = pixel.x * 3242174889u + pixel.y * 2447445414u + frame.random.y;
    precise float f = float((turn << 2u) >> 8u) * (1.0 / 16777216.0);
    precise float t = (2.0 * f - 1.0) * 0.41421356;  // tangent of half an angle within 45 degrees
    precise float inverse = 1.0 / (1.0 + t * t);
    precise vec2 d = vec2((1.0 - t * t) * inverse, 2.0 * t * inverse);
    uint quadrant = turn >> 30u;
    if ((quadrant & 1u) != 0u) d = vec2(-d.y, d.x);
    return (quadrant & 2u) != 0u ? -d : d;
}

vec2 nextDirection(vec2 d) {
    precise vec2 turned = vec2(fma(kGoldenCosine, d.x, -kGoldenSine * d.y), fma(kGoldenSine, d.x, kGoldenCosine * d.y));
    return turned;
}

// Off the view's axis the disk, which faces the receiver, is stretched outward.
void placeDisk(ShadowPoint s, vec2 pxPerUnit, inout PcssKernel k) {
    precise float stretch = 1.0 / (1.0 + rayLength(s.tangent));
    precise vec2 right = vec2(1.0 + s.tangent.x * s.tangent.x * stretch, s.tangent.x * s.tangent.y * stretch);
    precise vec2 down = vec2(s.tangent.x * s.tangent.y * stretch, 1.0 + s.tangent.y * s.tangent.y * stretch);
    precise vec2 rightPx = right * pxPerUnit;
    precise vec2 downPx = down * pxPerUnit;
    k.right = rightPx;
    k.down = downPx;
}

PcssKernel pcssKernelOf(GpuLight light, ShadowPoint s, uvec2 pixel) {
    GpuShadowView view = shadowViews[s.view];
    precise float a = view.depthFromLinearA;
    precise float b = view.depthFromLinearB;
    precise float r = light.sourceRadius;
    precise float near = s.reversedZ ? 1.0 : 0.0;
    PcssKernel k;
    precise float radius0, radius1, widest;
    if (isOrthographicView(view)) {
        radius1 = -r / b;
        radius0 = r * (s.linear + a / b);
        widest = max(radius0 + radius1 * near, 0.0);
    } else {
        radius1 = r / b;
        radius0 = -r * (a / b) - r / s.linear;
        widest = r * (1.0 / kNearestBlocker - 1.0) / s.linear;
    }
    precise float texel = 1.0 / max(view.pxPerMetre.x, view.pxPerMetre.y);
    precise float cut = min(widest, float(kMaxPcssRadiusPx) * texel);
    precise float limit = abs(s.slope.x) + abs(s.slope.y);
    precise float behind = s.reversedZ ? s.depth - limit : s.depth + limit;
    k.first = firstDirection(pixel);
    placeDisk(s, view.pxPerMetre, k);
    k.texel = texel;
    k.widest = cut;
    k.radius0 = radius0;
    k.radius1 = radius1;
    k.nearest = s.reversedZ ? clamp(behind, 0.0, 1.0) : 0.0;
    k.farthest = s.reversedZ ? 1.0 : clamp(behind, 0.0, 1.0);
    k.cube = lightType(light) == kLightPoint;
    return k;
}

// Where in the atlas a tap lies, from the receiver.
vec2 tapOffset(PcssKernel k, vec2 direction, float radius) {
    precise vec2 unit = vec2(fma(k.right.x, direction.x, k.down.x * direction.y),
                             fma(k.right.y, direction.x, k.down.y * direction.y));
    precise vec2 offset = unit * radius;
    return offset;
}

// Whether a tap within this radius may need more than its four texels of the rectangle.
bool mayLeave(ShadowPoint s, PcssKernel k, float radius) {
    precise vec2 extent = radius * (abs(k.right) + abs(k.down)) + 1.5;
    return any(lessThan(s.px - extent, s.rectMin)) || any(greaterThan(s.px + extent, s.rectMax));
}

#include "generate_shadows/point_faces.glsl"

// Four texels around a tap at `px`: their depths, and 1 where the receiver is lit by them. The plane's depth is affine,
// so it is advanced by the texels' distance from the receiver.
vec4 tapTexels(ShadowPoint s, PcssKernel k, vec2 px, out vec4 stored, out vec2 f) {
    precise vec2 corner = px - 0.5;
    precise vec2 first = floor(corner);
    precise vec2 fraction = corner - first;
    f = fraction;
    precise vec2 away = first + 0.5 - s.px;
    precise float depth = fma(s.slope.x, away.x, fma(s.slope.y, away.y, s.depth));
    precise vec4 depths = depth + vec4(s.slope.y, s.slope.x + s.slope.y, s.slope.x, 0.0);
    stored = gatherShadowTexels(s, first);
    return litBy(s, clamp(depths, k.nearest, k.farthest), stored);
}

// What a search has found: counts of texels, and the sum of the blockers' depths.
struct Blockers {
    float occluding;
    float blocking;
    float depths;
};

void countBlockers(PcssKernel k, float radius, vec4 lit, vec4 stored, inout Blockers found) {
    precise vec4 seen = fma(vec4(k.radius1), stored, vec4(fma(1.5, k.texel, k.radius0)));
    precise vec4 blocks = mix(1.0 - lit, vec4(0.0), lessThan(seen, vec4(radius)));
    precise float occluding = found.occluding + (4.0 - ((lit.x + lit.y) + (lit.z + lit.w)));
    precise float blocking = found.blocking + ((blocks.x + blocks.y) + (blocks.z + blocks.w));
    precise float depths = fma(blocks.x, stored.x, found.depths);
    depths = fma(blocks.y, stored.y, depths);
    depths = fma(blocks.z, stored.z, depths);
    depths = fma(blocks.w, stored.w, depths);
    found = Blockers(occluding, blocking, depths);
}

// What the shadow bounds tell of a search of radius `reach` that stays in the rectangle. True where they tell all. Else
// `needed` is the radius beyond which no blocker can be: the nearest depth in the region bounds what the source can see
// of it, and a smaller region may hold only farther ones.
bool knownByBounds(ShadowPoint s, PcssKernel k, float reach, out float needed, out float visibility) {
    needed = reach;
    visibility = 1.0;
    for (uint i = 0u; i < 3u; ++i) {
        vec2 extent = needed * (abs(k.right) + abs(k.down)) + 1.5;
        bool known;
        vec2 bounds = shadowBoundsOver(s.view, s.px - extent, s.px + extent, known);
        if (!known) return false;
        float rise = dot(abs(s.slope), extent);
        float slack = 1e-6 + 1e-5 * rise;  // the taps' own rounding
        float low = clamp(s.depth - rise - slack, k.nearest, k.farthest);
        float high = clamp(s.depth + rise + slack, k.nearest, k.farthest);
        if (s.reversedZ ? bounds.y <= low : bounds.x >= high) return true;
        if (i == 0u && (s.reversedZ ? bounds.x > high : bounds.y < low)) {
            visibility = 0.0;
            return true;
        }
        // The region of the source grows toward the light.
        float seen = fma(k.radius1, s.reversedZ ? bounds.y : bounds.x, k.radius0) + 1.5 * k.texel;
        seen += 1e-5 * abs(seen) + 1e-6 * (abs(k.radius0) + abs(k.radius1));
        if (!(seen < needed)) return false;
        needed = max(seen, 0.0);
    }
    return false;
}

float searchRadius(uint tap, float reach) {
    precise float share = (float(tap) + 0.5) * (1.0 / float(kPcssSearchTaps));
    precise float radius = share * share * reach;
    return radius;
}

// The filter's radius; or below 0 where no filter is needed, and then `visibility` is known. Two loops: where all taps
// stay inside the rectangle, nothing stands between the texture reads.
float searchBlockers(GpuLight light, ShadowPoint s, PcssKernel k, out float visibility) {
    precise float reach = k.widest + k.texel;
    vec2 direction = k.first;
    Blockers found = Blockers(0.0, 0.0, 0.0);
    vec4 stored;
    vec2 f;
    if (!mayLeave(s, k, reach)) {
        float needed;
        if (knownByBounds(s, k, reach, needed, visibility)) return -1.0;
        for (uint i = 0u; i < kPcssSearchTaps; ++i) {
            float radius = searchRadius(i, reach);
            // Beyond, there is no blocker; and not all texels occlude.
            if (radius > needed && found.occluding != 4.0 * float(i)) break;
            precise vec2 px = s.px + tapOffset(k, direction, radius);
            vec4 lit = tapTexels(s, k, px, stored, f);
            countBlockers(k, radius, lit, stored, found);
            direction = nextDirection(direction);
        }
    } else {
        for (uint i = 0u; i < kPcssSearchTaps; ++i) {
            float radius = searchRadius(i, reach);
            precise vec2 px = s.px + tapOffset(k, direction, radius);
            vec4 lit;
            if (leavesFace(s, k, px)) {
                float there;
                lit = vec4(otherFace(light, s, k, px, there));
                stored = vec4(there);
            } else {
                lit = tapTexels(s, k, clamp(px, s.rectMin + 1.0, s.rectMax - 1.0), stored, f);
            }
            countBlockers(k, radius, lit, stored, found);
            direction = nextDirection(direction);
        }
    }
    bool dark = found.occluding == 4.0 * float(kPcssSearchTaps);
    visibility = dark ? 0.0 : 1.0;
    if (found.blocking == 0.0 || dark) return -1.0;
    precise float mean = found.depths / found.blocking;
    precise float radius = clamp(fma(k.radius1, mean, k.radius0), k.texel, max(k.widest, k.texel));
    return radius;
}

float bilinear(vec4 lit, vec2 f) {
    precise float top = fma(f.x, lit.z - lit.w, lit.w);
    precise float bottom = fma(f.x, lit.y - lit.x, lit.x);
    precise float value = fma(f.y, bottom - top, top);
    return value;
}

float filterPenumbra(GpuLight light, ShadowPoint s, PcssKernel k, float radius) {
    vec2 direction = k.first;
    precise float sum = 0.0;
    vec4 stored;
    vec2 f;
    bool inside = !mayLeave(s, k, radius);
    for (uint i = 0u; i < kPcssFilterTaps; ++i) {
        precise float share = sqrt((float(i) + 0.5) * (1.0 / float(kPcssFilterTaps)));
        precise vec2 px = s.px + tapOffset(k, direction, share * radius);
        direction = nextDirection(direction);
        if (!inside && leavesFace(s, k, px)) {
            sum += otherFace(light, s, k, px, stored.x);
        } else {
            vec4 lit = tapTexels(s, k, clamp(px, s.rectMin + 1.0, s.rectMax - 1.0), stored, f);
            sum += bilinear(lit, f);
        }
    }
    precise float visibility = sum * (1.0 / float(kPcssFilterTaps));
    return visibility;
}

float pcssVisibility(GpuLight light, ShadowPoint s, uvec2 pixel) {
    PcssKernel k = pcssKernelOf(light, s, pixel);
    float visibility;
    float radius = searchBlockers(light, s, k, visibility);
    return radius < 0.0 ? visibility : filterPenumbra(light, s, k, radius);
}

#endif
