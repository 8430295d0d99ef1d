// The set of the working buffers: what the library's passes keep among themselves. Hosts use its number for a set of
// their own.
#ifndef GNOMON_GPU_INTERFACE_WORKING_SET_GLSL
#define GNOMON_GPU_INTERFACE_WORKING_SET_GLSL

#include "gpu_interface/numbers.h"
#include "gpu_interface/structs.h"

layout(set = kSetWorking, binding = kBindCounters, std430) restrict buffer CountersBlock { GpuCounters counters; };
layout(set = kSetWorking, binding = kBindApproximateCounts, std430) restrict buffer ApproximateCountsBlock {
    uint approximateCounts[];
};
layout(set = kSetWorking, binding = kBindShadowBoundsCells, std430) restrict readonly buffer CellsBlock {
    GpuShadowBoundsCell shadowBoundsCells[];
};
// The tile of every word of the early list: packTile().
layout(set = kSetWorking, binding = kBindListTiles, std430) restrict buffer ListTilesBlock { uint listTiles[]; };
layout(set = kSetWorking, binding = kBindPairQueues, std430) restrict buffer PairQueuesBlock { GpuPairHead pairs; };
// Places in list space. Two halves, each as long as list space: pairs to be searched, and pairs to be filtered. In each
// half a queue has a segment as long as its pairs are many.
layout(set = kSetWorking, binding = kBindQueuedPairs, std430) restrict buffer QueuedPairsBlock { uint queuedPairs[]; };
// Which parts of a tile's depth range hold geometry: hierarchical_depth/depth_slices.glsl.
layout(set = kSetWorking, binding = kBindTileDepthSlices, std430) restrict buffer TileDepthSlicesBlock {
    uint tileDepthSlices[];
};

#endif
