// Positions of pixels. All of it is precise: the same pixel must have the same position, bit for bit, in every pipeline
// that evaluates a shadow there, or a hard shadow's edge would differ between deferred and inline evaluation.
#ifndef GNOMON_SHADING_FRAME_GLSL
#define GNOMON_SHADING_FRAME_GLSL

#include "gpu_interface/lists_set.glsl"

bool isOrthographic() { return (frame.pools.w & kFrameOrthographicBit) != 0u; }
bool isBackground(float deviceDepth) { return deviceDepth == frame.eyeWs.w; }

// Metres along the view axis.
float viewDepthOf(float deviceDepth) {
    precise float numerator = frame.viewDepthFromDevice.x * deviceDepth + frame.viewDepthFromDevice.y;
    precise float denominator = frame.viewDepthFromDevice.z * deviceDepth + frame.viewDepthFromDevice.w;
    precise float depth = numerator / denominator;
    return depth;
}

// `pixel` in the active viewport, centres at .5; origin-relative metres.
vec3 worldFromPixel(vec2 pixel, float viewDepth) {
    precise vec2 xy = pixel * frame.viewXyFromPixel.xy + frame.viewXyFromPixel.zw;
    precise vec2 scaled = isOrthographic() ? xy : xy * viewDepth;
    precise vec3 p = frame.eyeWs.xyz + (frame.axisXWs.xyz * scaled.x + frame.axisYWs.xyz * scaled.y +
                                        frame.axisZWs.xyz * viewDepth);
    return p;
}

#endif
