// The 64-lane work group and operations over it, for any subgroup size. A subgroup operation comes first; its results
// are combined through shared memory, and the combining step is compiled away where one subgroup is the whole group.
#ifndef GNOMON_VULKAN_WORK_GROUP_GLSL
#define GNOMON_VULKAN_WORK_GROUP_GLSL

#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require

#include "gpu_interface/numbers.h"
#include "gpu_interface/packing.h"

layout(local_size_x = 64, local_size_y = 1, local_size_z = 1) in;
layout(constant_id = kSpecSubgroupSize) const uint kSubgroupSize = 32;
const uint kSubgroupCount = kWorkGroupSize / kSubgroupSize;

// Pipelines ask for full subgroups of kSubgroupSize lanes, so this numbers the 64 lanes whatever the device's order.
uint laneIndex() { return gl_SubgroupID * kSubgroupSize + gl_SubgroupInvocationID; }
uvec2 laneCoordinates(uint lane) { return uvec2(mortonX(lane), mortonY(lane)); }

#endif
