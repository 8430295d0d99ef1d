// Positions of pixels. All of it is precise: the same pixel must have the same position, bit for bit, in every pipeline
// that evaluates a shadow there. Else a hard shadow's edge would differ between deferred and inline evaluation.
#ifndef GNOMON_SHADING_FRAME_GLSL
#define GNOMON_SHADING_FRAME_GLSL

#include "gpu_interface/lists_set.glsl"

bool isOrthographic() { return (frame.flags & kFrameOrthographicBit) != 0u; }
bool isBackground(float deviceDepth) { return deviceDepth == frame.backgroundDepth; }

// Metres along the view axis.
float viewDepthOf(float deviceDepth) {
    precise float numerator = frame.viewDepthNumerator.x * deviceDepth + frame.viewDepthNumerator.y;
    precise float denominator = frame.viewDepthDenominator.x * deviceDepth + frame.viewDepthDenominator.y;
    precise float depth = numerator / denominator;
    return depth;
}

// `pixel` in the active viewport, centres at .5; origin-relative metres.
vec3 worldFromPixel(vec2 pixel, float viewDepth) {
    precise vec2 xy = pixel * frame.viewXyPerPixel + frame.viewXyAtPixel0;
    precise vec2 scaled = isOrthographic() ? xy : xy * viewDepth;
    precise vec3 p = frame.eyeWs + (frame.axisXWs * scaled.x + frame.axisYWs * scaled.y +
                                        frame.axisZWs * viewDepth);
    return p;
}

#endif
