// The set of the receivers: the host's depth and, where it has them, face normals, receiver flags and depth pyramid.
// Placeholders are bound where the host has no image, and never read.
#ifndef GNOMON_GPU_INTERFACE_RECEIVERS_SET_GLSL
#define GNOMON_GPU_INTERFACE_RECEIVERS_SET_GLSL

#extension GL_EXT_samplerless_texture_functions : require

#include "gpu_interface/numbers.h"

#ifndef GNOMON_RECEIVERS_SET
#define GNOMON_RECEIVERS_SET kSetReceivers
#endif

layout(set = GNOMON_RECEIVERS_SET, binding = kBindDepth) uniform texture2D hostDepth;
layout(set = GNOMON_RECEIVERS_SET, binding = kBindFaceNormals) uniform utexture2D hostFaceNormals;
layout(set = GNOMON_RECEIVERS_SET, binding = kBindReceiverFlags) uniform utexture2D hostReceiverFlags;
layout(set = GNOMON_RECEIVERS_SET, binding = kBindHostDepthPyramid) uniform texture2D hostDepthPyramid;

#endif
