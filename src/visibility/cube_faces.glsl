// Taps of a soft shadow that leave their face, where a light has six. Included by pcss_kernel.glsl, whose kernel it uses.
#ifndef GNOMON_VISIBILITY_CUBE_FACES_GLSL
#define GNOMON_VISIBILITY_CUBE_FACES_GLSL

bool leavesFace(ShadowPoint s, PcssKernel k, vec2 corner) {
    return k.cube && (any(lessThan(corner, s.rectMin + 0.5)) || any(greaterThan(corner, s.rectMax - 1.5)));
}

// Row of a view's matrix without its translation.
vec3 viewRow(uint view, uint row) {
    return vec3(shadowViews[view].clipFromWorld[0][row], shadowViews[view].clipFromWorld[1][row],
                shadowViews[view].clipFromWorld[2][row]);
}

// A tap beyond the border of a face looks at the face that its direction meets. There the receiver's
// plane is compared with what is stored; both are told as depths of the face that the tap left.
// The two shadow views are read field by field: two whole ones at once would cost every caller nine registers
// (docs/register-pressure.md).
// `tap` is the number of the tap, and adds nothing to the result. Without it, what is read here would be kept through
// the caller's whole loop.
void otherFace(GpuLight light, ShadowPoint s, uint tap, vec2 px, out float plane, out float stored) {
    uint own = s.view + (tap >> 31u);
    precise vec2 ndc = (px - shadowViews[own].pxFromNdcOffset) / shadowViews[own].pxFromNdcScale;
    vec3 x = viewRow(own, 0u);
    vec3 y = viewRow(own, 1u);
    precise vec3 direction = viewRow(own, 3u) + x * (ndc.x / dot(x, x)) + y * (ndc.y / dot(y, y));
    precise float depth = clamp(planeDepthAt(s, px - 0.5) * s.sign, 0.0, 1.0);
    precise float linear = shadowViews[own].depthFromLinearB / (depth - shadowViews[own].depthFromLinearA);

    uint other = light.shadowView + cubeFace(direction);
    precise vec3 clip = shadowViews[other].clipFromWorld[0].xyw * direction.x +
                        shadowViews[other].clipFromWorld[1].xyw * direction.y +
                        shadowViews[other].clipFromWorld[2].xyw * direction.z;
    precise vec2 otherPx =
        clip.xy / clip.z * shadowViews[other].pxFromNdcScale + shadowViews[other].pxFromNdcOffset;
    ivec2 texel = ivec2(clamp(floor(otherPx), shadowViews[other].rectMinPx, shadowViews[other].rectMaxPx - 1.0));
    uint atlasAndLayer = shadowViews[other].atlasAndLayer;
    float there = fetchAtlas(atlasAndLayer & 0xFFu, float(atlasAndLayer >> 8u), texel);
    bool reversed = (shadowViews[other].flags & kShadowViewReversedZBit) != 0u;
    float otherA = shadowViews[other].depthFromLinearA;
    float otherB = shadowViews[other].depthFromLinearB;
    // No finite depth: as far as the view sees.
    bool finite = linear > 0.0 && linear < 1e15;
    precise float receiver = otherA + otherB / (linear * clip.z);
    if (!finite) receiver = reversed ? 0.0 : 1.0;
    receiver = clamp(receiver, 0.0, 1.0);
    precise float inverse = (there - otherA) / otherB * clip.z;  // 1 / own linear depth
    precise float asOwn = shadowViews[own].depthFromLinearA + shadowViews[own].depthFromLinearB * inverse;
    stored = asOwn * s.sign;
    // The comparison is the other face's; what is told agrees with it.
    bool occludes = reversed ? there > receiver : there < receiver;
    plane = occludes ? -2.0 : 2.0;
}

#endif
