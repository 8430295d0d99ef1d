// The lighting passes' own set: the G-buffer, the host's light data and the picture. GNOMON_FLOAT_PICTURE: its channels
// are 32-bit floats in place of halves.
#ifndef GNOMON_RENDERER_LIGHTING_SET_GLSL
#define GNOMON_RENDERER_LIGHTING_SET_GLSL

#extension GL_EXT_samplerless_texture_functions : require

#include "renderer/lighting/lighting_data.h"

layout(set = 3, binding = 0) uniform texture2D gbufferBaseColour;
layout(set = 3, binding = 1) uniform utexture2D gbufferNormal;
layout(set = 3, binding = 2) uniform texture2D gbufferMaterial;
layout(set = 3, binding = 3) uniform texture2D gbufferEmissive;
#ifdef GNOMON_FLOAT_PICTURE
layout(set = 3, binding = 4, rgba32f) uniform restrict writeonly image2D picture;
const float kBrightest = 3.402823466e38;
#else
layout(set = 3, binding = 4, rgba16f) uniform restrict writeonly image2D picture;
const float kBrightest = 65504.0;
#endif
layout(set = 3, binding = 5, std430) restrict readonly buffer HostLightsBlock { HostLight hostLights[]; };
layout(set = 3, binding = 6, std140) uniform SceneBlock { SceneConstants scene; };

#endif
