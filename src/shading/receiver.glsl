// What a shadow test needs to know of a pixel.
#ifndef GNOMON_SHADING_RECEIVER_GLSL
#define GNOMON_SHADING_RECEIVER_GLSL

#include "depth_bias/mode.glsl"
#include "gpu_interface/receivers_set.glsl"
#include "shading/frame.glsl"
#include "shading/octahedral.glsl"

// Relative error of a device depth that a rasterizer interpolated and stored as a float: one to two steps.
const float kDeviceDepthRounding = 1.2e-7;

struct Receiver {
    vec3 positionWs;
    vec3 faceNormalWs;  // of the side that the camera sees, from the geometry and not from a normal map
    float viewDepth;
    float offPlaneMetres;  // how far the position may lie from the face that the camera saw
    uvec2 pixel;  // in the active extent
    uint mask;
    bool subsurface;
    bool valid;  // inside the extent and not background
};

float hostDepthAt(uvec2 pixel) { return texelFetch(hostDepth, ivec2(pixel + frame.extent.zw), 0).x; }

// Position of a neighbour, or of the pixel itself at the border of the extent and at background.
vec3 neighbourPosition(uvec2 pixel, ivec2 offset, vec3 self, out bool usable) {
    ivec2 q = ivec2(pixel) + offset;
    usable = all(greaterThanEqual(q, ivec2(0))) && all(lessThan(q, ivec2(frame.extent.xy)));
    if (!usable) return self;
    float d = hostDepthAt(uvec2(q));
    usable = !isBackground(d);
    return usable ? worldFromPixel(vec2(q) + 0.5, viewDepthOf(d)) : self;
}

// The shorter of the two one-sided differences is the one that does not cross an edge.
vec3 shorterDifference(uvec2 pixel, ivec2 step, vec3 p) {
    bool ahead, behind;
    precise vec3 a = neighbourPosition(pixel, step, p, ahead) - p;
    precise vec3 b = p - neighbourPosition(pixel, -step, p, behind);
    precise float lengthA = dot(a, a);
    precise float lengthB = dot(b, b);
    return ahead && (!behind || lengthA <= lengthB) ? a : b;
}

vec3 faceNormalFromDepth(uvec2 pixel, vec3 p) {
    vec3 dx = shorterDifference(pixel, ivec2(1, 0), p);
    vec3 dy = shorterDifference(pixel, ivec2(0, 1), p);
    precise vec3 n = cross(dx, dy);
    precise float squared = dot(n, n);
    precise vec3 toEye = isOrthographic() ? -frame.axisZWs.xyz : frame.eyeWs.xyz - p;
    if (squared < 1e-30) return normalize(toEye);  // a pixel without neighbours
    precise vec3 unit = n * inversesqrt(squared);
    return dot(unit, toEye) < 0.0 ? -unit : unit;
}

// What the rounding of the host's depth makes of the position, across the face. A step aside along the face is no harm.
float offPlaneMetres(float d, Receiver r) {
    vec4 m = frame.viewDepthFromDevice;
    precise float w = m.z * d + m.w;
    precise float perDevice = (m.x * m.w - m.y * m.z) / (w * w);
    precise vec3 ray = isOrthographic() ? frame.axisZWs.xyz : (r.positionWs - frame.eyeWs.xyz) / r.viewDepth;
    precise float metres = abs(perDevice * dot(r.faceNormalWs, ray)) * (kDeviceDepthRounding * d + frame.shadows.y);
    return metres;
}

Receiver receiverAt(uvec2 pixel) {
    Receiver r;
    r.positionWs = vec3(0.0);
    r.faceNormalWs = vec3(0.0, 0.0, 1.0);
    r.viewDepth = 0.0;
    r.offPlaneMetres = 0.0;
    r.pixel = pixel;
    r.mask = 0xFFu;
    r.subsurface = false;
    r.valid = all(lessThan(pixel, frame.extent.xy));
    if (!r.valid) return r;
    float d = hostDepthAt(pixel);
    r.valid = !isBackground(d);
    if (!r.valid) return r;
    r.viewDepth = viewDepthOf(d);
    r.positionWs = worldFromPixel(vec2(pixel) + 0.5, r.viewDepth);
    ivec2 texel = ivec2(pixel + frame.extent.zw);
    if (!kNeedsFaceNormals) {
        r.faceNormalWs = vec3(0.0);
    } else if ((frame.pools.w & kFrameFaceNormalsBit) != 0u) {
        r.faceNormalWs = decodeOctahedral(texelFetch(hostFaceNormals, texel, 0).xy);
    } else {
        r.faceNormalWs = faceNormalFromDepth(pixel, r.positionWs);
    }
    r.offPlaneMetres = offPlaneMetres(d, r);
    if ((frame.pools.w & kFrameReceiverFlagsBit) != 0u) {
        uvec2 flags = texelFetch(hostReceiverFlags, texel, 0).xy;
        r.mask = flags.x;
        r.subsurface = (flags.y & kReceiverSubsurfaceBit) != 0u;
    }
    return r;
}

#endif
