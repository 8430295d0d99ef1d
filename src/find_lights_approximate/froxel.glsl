// A froxel (a tile's screen rectangle between two depths) and its intersection tests with lights, in view space.
//
// Problem: discard, per tile and at the price of a few dozen instructions, most lights that reach none of its pixels.
// Never discard one that does: phase 3 writes into the space that is reserved from these answers.
// Source: the paper, section 2.2 (three tests); Wronski 2017, "Cull that cone!"; Harada 2012 (depth slices).
// Floats: every comparison gives way by `margin`. It bounds the rounding of both this test and the per-pixel test, for
// positions of up to frame.largestCoordinate metres. The per-pixel test compares cosines. Their rounding widens narrow
// cones the most, so cones are taken a little wider here.
#ifndef GNOMON_FIND_LIGHTS_APPROXIMATE_FROXEL_GLSL
#define GNOMON_FIND_LIGHTS_APPROXIMATE_FROXEL_GLSL

#include "shading/frame.glsl"
#include "shading/light_tests.glsl"
#include "hierarchical_depth/depth_slices.glsl"

struct Froxel {
    vec2 slopeMin;  // xy bounds at depth 1 (perspective) or at any depth (orthographic)
    vec2 slopeMax;
    vec3 boxMin;    // view-space bounds
    vec3 boxMax;
    float margin;   // metres
    vec2 range;     // of depths, metres,
    uint slices;    // and which parts of it hold geometry
};

Froxel froxelOf(uvec2 tile, vec2 range, uint slices) {
    Froxel f;
    f.range = range;
    f.slices = slices;
    float nearDepth = range.x, farDepth = range.y;
    vec2 a = vec2(tile * kShadowTileSizePx) * frame.viewXyPerPixel + frame.viewXyAtPixel0;
    vec2 b = vec2((tile + 1u) * kShadowTileSizePx) * frame.viewXyPerPixel + frame.viewXyAtPixel0;
    f.slopeMin = min(a, b);
    f.slopeMax = max(a, b);
    // No light reaches beyond, so a froxel need not reach farther (a host's pyramid may give infinity).
    float end = max(nearDepth, min(farDepth, frame.farthestReach));
    vec2 boundsMin = f.slopeMin;
    vec2 boundsMax = f.slopeMax;
    if (!isOrthographic()) {
        boundsMin = min(f.slopeMin * nearDepth, f.slopeMin * end);
        boundsMax = max(f.slopeMax * nearDepth, f.slopeMax * end);
    }
    f.boxMin = vec3(boundsMin, nearDepth);
    f.boxMax = vec3(boundsMax, end);
    // 16 float steps of the largest coordinate: the chain from device depth to a distance rounds fewer times than that.
    f.margin = 2e-6 * (frame.largestCoordinate + end + length(max(abs(boundsMin), abs(boundsMax))));
    return f;
}

bool sphereOutside(Froxel f, vec3 centre, float radius) {
    vec3 away = max(max(f.boxMin - centre, centre - f.boxMax), vec3(0.0));
    float reach = radius + f.margin;
    if (dot(away, away) > reach * reach) return true;
    if (isOrthographic()) return false;
    // Side planes through the eye.
    vec2 above = (centre.xy - f.slopeMax * centre.z) * inversesqrt(1.0 + f.slopeMax * f.slopeMax);
    vec2 below = (f.slopeMin * centre.z - centre.xy) * inversesqrt(1.0 + f.slopeMin * f.slopeMin);
    return max(max(above.x, above.y), max(below.x, below.y)) > reach;
}

// Which slices of the range a sphere may reach. A pixel is at most half a diagonal of the froxel's far end aside from
// the ray through the tile's middle. So the sphere, wider by that, is cut with the ray.
uint slicesOfSphere(Froxel f, vec3 centre, float radius) {
    vec2 middle = 0.5 * (f.slopeMin + f.slopeMax);
    float diagonal = length(f.slopeMax - f.slopeMin);
    vec3 ray = isOrthographic() ? vec3(0.0, 0.0, 1.0) : vec3(middle, 1.0);
    vec3 start = isOrthographic() ? vec3(middle, 0.0) : vec3(0.0);
    float aside = 0.5 * (isOrthographic() ? diagonal : diagonal * f.boxMax.z);
    float squared = dot(ray, ray);
    vec3 toCentre = centre - start;
    float depth = dot(toCentre, ray) / squared;
    vec3 away = toCentre - depth * ray;
    float reach = radius + aside + f.margin;
    float chord = reach * reach - dot(away, away);
    if (chord < 0.0) return 0u;
    float extent = sqrt(chord / squared) + f.margin;
    if (depth + extent < f.range.x || depth - extent > f.range.y) return 0u;
    uint first = depthSlice(f.range, depth - extent), last = depthSlice(f.range, depth + extent);
    return (kAllDepthSlices >> (kDepthSlices - 1u - last)) & (kAllDepthSlices << first);
}

// Cosine and sine of the half-angle at which the per-pixel test may still say yes.
vec2 widenedCone(GpuLight light) {
    float cosine = light.cosOuter - 1e-6;
    return vec2(cosine, sqrt(max(1.0 - cosine * cosine, 0.0)));
}

bool coneMissesSphere(GpuLight light, vec2 cone, vec3 centre, float radius) {
    vec3 v = centre - light.positionVs;
    float along = dot(v, light.directionVs);
    float across = length(v - light.directionVs * along);
    return cone.x * across - along * cone.y > radius || along < -radius || along > radius + light.rangeMetres;
}

// The froxel's corners against the pyramid around the cone, which is the spot's own clip space up to scale.
bool pyramidMissesFroxel(GpuLight light, vec2 cone, Froxel f) {
    vec3 axis = light.directionVs;
    vec3 helper = abs(axis.z) < 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0);
    vec3 u = normalize(cross(axis, helper));
    vec3 v = cross(axis, u);
    vec4 least = vec4(3e38);  // how far outside each side the nearest corner is
    float front = -3e38;
    for (uint corner = 0u; corner < 8u; ++corner) {
        bvec3 high = bvec3((corner & 1u) != 0u, (corner & 2u) != 0u, (corner & 4u) != 0u);
        float z = high.z ? f.boxMax.z : f.boxMin.z;
        vec2 slope = vec2(high.x ? f.slopeMax.x : f.slopeMin.x, high.y ? f.slopeMax.y : f.slopeMin.y);
        vec3 q = vec3(isOrthographic() ? slope : slope * z, z) - light.positionVs;
        float along = dot(q, axis);
        vec2 side = vec2(dot(q, u), dot(q, v)) * cone.x;
        least = min(least, vec4(side, -side) - cone.y * along);
        front = max(front, along);
    }
    return max(max(least.x, least.y), max(least.z, least.w)) > f.margin || front < -f.margin;
}

bool lightMayReachFroxel(GpuLight light, Froxel f) {
    uint type = lightType(light);
    if (type == kLightDirectional) return true;
    if (sphereOutside(f, light.positionVs, light.rangeMetres)) return false;
    if ((slicesOfSphere(f, light.positionVs, light.rangeMetres) & f.slices) == 0u) return false;
    if (type == kLightPoint) return true;
    vec3 centre = 0.5 * (f.boxMin + f.boxMax);
    vec2 cone = widenedCone(light);
    if (coneMissesSphere(light, cone, centre, 0.5 * length(f.boxMax - f.boxMin) + f.margin)) return false;
    return !pyramidMissesFroxel(light, cone, f);
}

#endif
