// Shadow view, fragments of alpha-tested casters: texels that are cut out cast no shadow.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "renderer/gpu/material.glsl"

layout(location = 0) in vec4 texcoords;
layout(location = 1) in float alpha;

void main() {
    const vec2 uv = textureUv(material.baseColourUse, texcoords.xy, texcoords.zw);
    if (isCutOut(material.baseColour.a * alpha * texture(baseColourTexture, uv).a)) discard;
}
