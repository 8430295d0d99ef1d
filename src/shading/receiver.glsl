// What a shadow test needs to know of a pixel.
#ifndef GNOMON_SHADING_RECEIVER_GLSL
#define GNOMON_SHADING_RECEIVER_GLSL

#include "visibility/depth_bias_mode.glsl"
#include "gpu_interface/receivers_set.glsl"
#include "shading/frame.glsl"
#include "shading/normal_from_depth.glsl"
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

// What the rounding of the host's depth makes of the position, across the face. A step aside along the face is no harm.
float offPlaneMetres(float d, float rounding, Receiver r) {
    precise vec3 ray = isOrthographic() ? frame.axisZWs : (r.positionWs - frame.eyeWs) / r.viewDepth;
    precise float metres = abs(metresPerDevice(d) * dot(r.faceNormalWs, ray)) * rounding;
    return metres;
}

// What the host's images hold of a pixel. All are read at once: one that waited for another would double the time until
// a shadow can begin.
struct HostPixel {
    float depth;
    uvec2 faceNormal;
    uvec2 flags;
};

// Pixels beyond the extent repeat its last ones.
HostPixel hostPixelAt(uvec2 pixel) {
    ivec2 texel = ivec2(min(pixel, frame.extentPx - 1u) + frame.viewportPx);
    HostPixel host = HostPixel(texelFetch(hostDepth, texel, 0).x, uvec2(0u), uvec2(0xFFu, 0u));
    if (kNeedsFaceNormals && (frame.flags & kFrameFaceNormalsBit) != 0u) {
        host.faceNormal = texelFetch(hostFaceNormals, texel, 0).xy;
    }
    if ((frame.flags & kFrameReceiverFlagsBit) != 0u) host.flags = texelFetch(hostReceiverFlags, texel, 0).xy;
    return host;
}

Receiver receiverOf(uvec2 pixel, HostPixel host) {
    Receiver r;
    r.positionWs = vec3(0.0);
    r.faceNormalWs = vec3(0.0, 0.0, 1.0);
    r.viewDepth = 0.0;
    r.offPlaneMetres = 0.0;
    r.pixel = pixel;
    r.mask = 0xFFu;
    r.subsurface = false;
    float d = host.depth;
    r.valid = all(lessThan(pixel, frame.extentPx)) && !isBackground(d);
    if (!r.valid) return r;
    r.viewDepth = viewDepthOf(d);
    r.positionWs = worldFromPixel(vec2(pixel) + 0.5, r.viewDepth);
    precise float rounding = kDeviceDepthRounding * d + frame.hostDepthStep;
    if (!kNeedsFaceNormals) {
        r.faceNormalWs = vec3(0.0);
    } else if ((frame.flags & kFrameFaceNormalsBit) != 0u) {
        r.faceNormalWs = decodeOctahedral(host.faceNormal);
    } else {
        r.faceNormalWs = faceNormalFromDepth(pixel, d, r.viewDepth, rounding);
    }
    r.offPlaneMetres = offPlaneMetres(d, rounding, r);
    r.mask = host.flags.x;
    r.subsurface = (host.flags.y & kReceiverSubsurfaceBit) != 0u;
    return r;
}

Receiver receiverAt(uvec2 pixel) { return receiverOf(pixel, hostPixelAt(pixel)); }

#endif
