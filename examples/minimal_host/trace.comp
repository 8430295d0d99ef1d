#version 460
// Stands for the host's drawing: the depth of a few boxes, by casting a ray per pixel, for the camera and for every
// shadow view. Reversed z, without a far plane.
#extension GL_EXT_buffer_reference : require
layout(local_size_x = 8, local_size_y = 8) in;
layout(buffer_reference, std430) writeonly buffer Depths { float at[]; };
layout(push_constant) uniform Push {
    mat4 clipFromWorld;
    Depths depths;      // rows of the whole image
    uvec2 rectFirstPx;  // the view's rectangle in it
    uvec2 rectSizePx;
    uint rowPx;
};

// Lowest and highest corner, metres; y is up.
const int kBoxes = 6;
const vec3 kLow[kBoxes] = vec3[](vec3(-6.0, -0.2, -4.0),  // floor
                                 vec3(-6.0, -0.2, -4.2),  // back wall
                                 vec3(-2.0, 0.0, -0.6),   // cube
                                 vec3(0.9, 0.0, -1.4),    // pillar
                                 vec3(1.8, 0.0, 0.6),     // slab
                                 vec3(-0.4, 0.9, 1.0));   // a box that floats
const vec3 kHigh[kBoxes] = vec3[](vec3(6.0, 0.0, 5.0), vec3(6.0, 2.5, -4.0), vec3(-0.8, 1.2, 0.6), vec3(1.3, 2.2, -1.0),
                                  vec3(3.2, 0.4, 1.8), vec3(0.4, 1.2, 1.8));

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, rectSizePx))) return;
    vec2 ndc = (vec2(pixel) + 0.5) / vec2(rectSizePx) * 2.0 - 1.0;
    mat4 worldFromClip = inverse(clipFromWorld);
    vec4 nearest = worldFromClip * vec4(ndc, 1.0, 1.0);
    vec3 origin = nearest.xyz / nearest.w;
    vec3 direction = (worldFromClip * vec4(ndc, 0.0, 1.0)).xyz;  // depth 0 is a point at infinity
    const float kNothing = 3.0e38;
    float hit = kNothing;
    for (int i = 0; i < kBoxes; ++i) {
        vec3 a = (kLow[i] - origin) / direction;
        vec3 b = (kHigh[i] - origin) / direction;
        vec3 enter = min(a, b);
        vec3 leave = max(a, b);
        float first = max(max(enter.x, enter.y), enter.z);
        float last = min(min(leave.x, leave.y), leave.z);
        if (first <= last && first > 0.0) hit = min(hit, first);
    }
    vec4 clip = clipFromWorld * vec4(origin + hit * direction, 1.0);
    uvec2 texel = rectFirstPx + pixel;
    depths.at[texel.y * rowPx + texel.x] = hit < kNothing ? clip.z / clip.w : 0.0;
}
