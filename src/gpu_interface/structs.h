// Every structure that crosses from the CPU to the shaders, once. Compiled as C++ and as GLSL.
//
// Layout: std430 for arrays in storage buffers, std140 for the frame's uniform buffer; members are ordered so that both
// agree with C++ (every vec3 is followed by a scalar). Sizes are asserted here, offsets compared with the compiled
// shaders by a test.
#ifndef GNOMON_GPU_INTERFACE_STRUCTS_H
#define GNOMON_GPU_INTERFACE_STRUCTS_H

#include "gpu_interface/numbers.h"

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>
namespace gnomon::gpu {
using uint = std::uint32_t;
struct vec2 {
    float x, y;
};
struct vec3 {
    float x, y, z;
};
struct vec4 {
    float x, y, z, w;
};
struct uvec2 {
    uint x, y;
};
struct mat4 {
    vec4 column[4];
};
#endif

// One visible light in sorted order. Directional lights come first, then the others by nearest view depth.
// View space here is (right, up, view depth): z is the positive distance along the view axis.
struct GpuLight {
    vec3 positionWs;     // metres, relative to the frame's origin; 0 for directional lights
    float rangeMetres;   // no influence beyond; 3.0e38 for directional lights
    vec3 directionWs;    // unit, from the light into the scene (spot axis, directional light's travel); 0 for points
    float cosOuter;      // spot: cosine of the half-angle of the cone; else -2
    vec3 positionVs;     // metres; 0 for directional lights
    float sinOuter;      // spot: sine of the half-angle; else 0
    vec3 directionVs;    // unit
    float sourceRadius;  // metres; directional: tangent of the angular radius
    uint typeAndFlags;   // kLightPoint ..., kLightCastsBit, kLightShadowFadesBit, filter, PCSS preset, cascades, faces
    uint lightMask;      // low 8 bits; the light reaches a receiver iff (lightMask & receiverMask) != 0
    uint shadowView;     // first shadow view (points: of six, +X -X +Y -Y +Z -Z; cascades: nearest), or kNoShadowView
    uint hostIndex;      // index into the light array that the host gave
    float lightFade;     // above 0 to 1, multiplies the light
    // The shadow's fade: visibility becomes 1 - fade * (1 - visibility). fade is shadowFade, 0..1. For directional
    // lights it is shadowFade + shadowFadePerMetre * distance between pixel and eye, cut to 0..1.
    float shadowFade;
    float biasMetres;  // depth bias of this light
    float shadowFadePerMetre;
};

// One shadowmap view: a perspective or orthographic frustum drawn into a rectangle of an atlas layer.
struct GpuShadowView {
    mat4 clipFromWorld;
    vec2 pxFromNdcScale;  // atlas pixel = ndc.xy * scale + offset
    vec2 pxFromNdcOffset;
    vec2 rectMinPx;          // the rectangle's first pixel
    vec2 rectMaxPx;          // one past its last pixel
    float depthFromLinearA;  // perspective: device depth = A + B / linear depth; orthographic: A + B * linear depth
    float depthFromLinearB;
    uint flags;          // kShadowViewOrthographicBit, kShadowViewReversedZBit
    uint atlasAndLayer;  // atlas in the low 8 bits, layer above
    vec2 pxPerMetre;     // texels per metre at linear depth 1 m (perspective) or anywhere (orthographic)
    vec2 atlasPerTexel;  // 1 / atlas width, 1 / atlas height
    uint boundsFirst;    // shadow bounds: entry of the first block of the atlas layer,
    uint boundsRow;      // blocks of the finest level in a row,
    uint boundsBlocks;   // and in all; 0: the view has no bounds
    uint reserved;
    // What gives the slope of a plane's depth. Take a plane with unit normal n, and m = (n planeX, n planeY, n planeZ).
    // The normal's part along the ray through ndc, per metre of linear depth, is
    //     k = m.x ndc.x + m.y ndc.y + m.z    (orthographic: k = m.z).
    // The slope of the plane's device depth per texel is
    //     m.xy * planeSlopePerPx / (k * linear depth)    (orthographic: divided by k alone).
    // These members lie beside what is read together with them: a load of its own for the slopes cost PCF 2 % on an
    // NVIDIA H200.
    vec3 planeX;
    float planeSlopePerPxX;
    vec3 planeY;
    float planeSlopePerPxY;
    vec3 planeZ;
    float depthStep;     // of the atlas, beyond that of floats
    vec2 tangentPerNdc;  // lateral over linear depth; orthographic: 0
    // Between which GpuLight::biasMetres is taken: shares of linear depth (orthographic: metres).
    float mostBias;
    float leastBias;
};

// A cell of the shadow bounds to be made this frame.
struct GpuShadowBoundsCell {
    uint atlasAndLayer;
    uint cellX;  // in the atlas
    uint cellY;
    uint first;  // as in GpuShadowView
    uint row;
    uint blocks;
    float atlasPerTexelX;
    float atlasPerTexelY;
};

// Taps of soft shadows, one over the square of the number of search taps, and one over that of filter taps.
struct GpuPcssTaps {
    uint searchTaps;
    uint filterTaps;
    float perSearchTapSquared;
    float perFilterTap;
};

// Where taps of soft shadows lie, in the pattern's axes: tap i is at the golden angle i times. Read with an index that
// is the same for all lanes.
struct GpuPcssTap {
    vec2 filtered;  // times the radius over the square root of their number; evenly spread
    vec2 searched;  // times the radius over the square of their number; crowded in the middle,
    float squared;  // at this distance
    float reserved0, reserved1, reserved2;
};

// Constants of one frame and view.
struct GpuFrame {
    vec3 eyeWs;             // camera position, metres, relative to the frame's origin
    float backgroundDepth;  // device depth of pixels without geometry
    vec3 axisXWs;           // unit axes of the view in the world: right,
    float zBinNearDepth;    // view depth at which the first zBin begins, metres
    vec3 axisYWs;           // up,
    float zBinsPerMetre;
    vec3 axisZWs;         // and into the scene
    float farthestReach;  // greatest view depth that a light reaches, metres
    // View xy (at depth 1 if perspective) = pixel * viewXyPerPixel + viewXyAtPixel0.
    vec2 viewXyPerPixel;
    vec2 viewXyAtPixel0;
    // View depth of device depth d = (numerator.x * d + numerator.y) / (denominator.x * d + denominator.y).
    vec2 viewDepthNumerator;
    vec2 viewDepthDenominator;
    uvec2 extentPx;    // active extent
    uvec2 viewportPx;  // where it begins in the host's images
    uvec2 tileCounts;  // shadow tiles, across and down
    uvec2 tileGroupCounts;
    uint lightCount;
    uint directionalLightCount;  // the first ones
    uint maskTileColumns;
    uint maskTileRows;
    uint listCapacity;      // entries
    uint slotCapacity;      // visibility slots
    uint fixedListEntries;  // per tile, with kReserveFixed
    uint flags;             // kFrameOrthographicBit ...
    float subsurfaceBiasMetres;
    float hostDepthStep;      // between neighbouring values of the host's depth buffer, beyond that of floats
    float largestCoordinate;  // the scale of rounding errors, metres
    float reserved0;
    uint frameNumber;  // low 32 bits
    uint patternTurn;  // turns the filters' pattern; 2^32 to a turn
    uint reserved1;
    uint reserved2;
    GpuPcssTaps pcssTaps[kMaxPcssPresets];
    GpuPcssTap pcssPattern[kMaxPcssTaps];
};

// What the passes count, written with atomics, cleared at the start of every frame.
struct GpuCounters {
    uint listEntries;                 // reserved, whether or not there was space
    uint visibilitySlots;             // asked for, whether or not there was space
    uint listOverflowTiles;           // tiles whose lights are walked in the group mask while lighting
    uint slotOverflowEntries;         // entries flagged EVALUATE
    uint accurateExceedsApproximate;  // tiles in which the invariant broke: must stay 0
    uint tilesWithGeometry;           // this and the rest are summed by gather_statistics
    uint approximateEntries;
    uint earlyEntries;
    uint earlyCastingEntries;
    uint finalEntries;
    uint finalSlotEntries;
    uint maxLightsInTile;
    uint frameStamp;  // of the host, never changed by a pass: which frame has been counted
};

// Pairs of one filter and one kind of shadow views, waiting to be evaluated. A pair is named by its place in list
// space.
struct GpuPairQueue {
    uint searchGroupCountX;  // a VkDispatchIndirectCommand: groups in a row,
    uint searchGroupCountY;  // rows in use,
    uint searchGroupCountZ;  // 1
    uint searchCount;        // pairs whose quads are to be searched
    uint filterGroupCountX;  // likewise
    uint filterGroupCountY;
    uint filterGroupCountZ;
    uint filterCount;  // pairs whose pixels are to be filtered
    uint listed;       // pairs of all early lists: how long a segment the queue has in each half of queuedPairs,
    uint first;        // and where it begins
    uint reserved0;
    uint reserved1;
};

struct GpuPairHead {
    uint classifyGroupCountX;  // a VkDispatchIndirectCommand over list space: groups in a row,
    uint classifyGroupCountY;  // rows in use,
    uint classifyGroupCountZ;  // 1
    uint reserved0;
    GpuPairQueue queues[kPairQueueCount];
};

// Head of the list of tiles to be shaded with evaluation; tile coordinates (y << 16 | x) follow.
struct GpuEvaluateHead {
    uint groupCountX;  // a VkDispatchIndirectCommand: tiles in a row,
    uint groupCountY;  // rows in use,
    uint groupCountZ;  // 1
    uint tileCount;
};

#ifdef __cplusplus
// Values of the specialization constants: member i is constant id i.
struct Specialization {
    uint subgroupSize;
    uint filters;
    uint listReservation;
    uint pcfRadius;
    uint hostDepthPyramid;
    uint pcssPresets;
    uint visibilityBits;
    uint shadowAtlases;
    uint depthBias;
    uint facedAwayIsDark;
    uint lightLists;
    uint shadowViews;
};
static_assert(sizeof(Specialization) == 4 * kSpecCount);
static_assert(offsetof(Specialization, subgroupSize) == 4 * kSpecSubgroupSize);
static_assert(offsetof(Specialization, filters) == 4 * kSpecFilters);
static_assert(offsetof(Specialization, listReservation) == 4 * kSpecListReservation);
static_assert(offsetof(Specialization, pcfRadius) == 4 * kSpecPcfRadius);
static_assert(offsetof(Specialization, hostDepthPyramid) == 4 * kSpecHostDepthPyramid);
static_assert(offsetof(Specialization, pcssPresets) == 4 * kSpecPcssPresets);
static_assert(offsetof(Specialization, visibilityBits) == 4 * kSpecVisibilityBits);
static_assert(offsetof(Specialization, shadowAtlases) == 4 * kSpecShadowAtlases);
static_assert(offsetof(Specialization, depthBias) == 4 * kSpecDepthBias);
static_assert(offsetof(Specialization, facedAwayIsDark) == 4 * kSpecFacedAwayIsDark);
static_assert(offsetof(Specialization, lightLists) == 4 * kSpecLightLists);
static_assert(offsetof(Specialization, shadowViews) == 4 * kSpecShadowViews);

static_assert(sizeof(GpuLight) == 96);
static_assert(sizeof(GpuShadowView) == 208);
static_assert(sizeof(GpuShadowBoundsCell) == 32);
static_assert(kDepthSlices == 32);                                          // bits of a word
static_assert(kMostPairsPerFilterGroup * kQuadsPerTile <= kWorkGroupSize);  // filter_pairs: a lane per quad
static_assert(sizeof(GpuFrame) == 16 * (16 + 2 * kMaxPcssTaps));
static_assert(sizeof(GpuCounters) == 52);
static_assert(sizeof(GpuPairQueue) == 48);
static_assert(sizeof(GpuPairHead) == 16 + 48 * kPairQueueCount);
static_assert(sizeof(GpuEvaluateHead) == 16);
}  // namespace gnomon::gpu
#endif
#endif  // GNOMON_GPU_INTERFACE_STRUCTS_H
