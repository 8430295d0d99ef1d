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

Receiver receiverAt(uvec2 pixel) {
    Receiver r;
    r.positionWs = vec3(0.0);
    r.faceNormalWs = vec3(0.0, 0.0, 1.0);
    r.viewDepth = 0.0;
    r.offPlaneMetres = 0.0;
    r.pixel = pixel;
    r.mask = 0xFFu;
    r.subsurface = false;
    r.valid = all(lessThan(pixel, frame.extentPx));
    if (!r.valid) return r;
    float d = hostDepthAt(pixel);
    r.valid = !isBackground(d);
    if (!r.valid) return r;
    r.viewDepth = viewDepthOf(d);
    r.positionWs = worldFromPixel(vec2(pixel) + 0.5, r.viewDepth);
    precise float rounding = kDeviceDepthRounding * d + frame.hostDepthStep;
    ivec2 texel = ivec2(pixel + frame.viewportPx);
    if (!kNeedsFaceNormals) {
        r.faceNormalWs = vec3(0.0);
    } else if ((frame.flags & kFrameFaceNormalsBit) != 0u) {
        r.faceNormalWs = decodeOctahedral(texelFetch(hostFaceNormals, texel, 0).xy);
    } else {
        r.faceNormalWs = faceNormalFromDepth(pixel, d, r.viewDepth, rounding);
    }
    r.offPlaneMetres = offPlaneMetres(d, rounding, r);
    if ((frame.flags & kFrameReceiverFlagsBit) != 0u) {
        uvec2 flags = texelFetch(hostReceiverFlags, texel, 0).xy;
        r.mask = flags.x;
        r.subsurface = (flags.y & kReceiverSubsurfaceBit) != 0u;
    }
    return r;
}

#endif
