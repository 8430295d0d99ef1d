// Every number that the CPU and the shaders both rely on, once. Compiled as C++ and as GLSL.
//
// Source: Fatnassi 2023, "Shadow Techniques from Final Fantasy XVI", sections 2.1 to 2.4 and the glossary.
// The consequence noted beside a number is for 3840x2160.
#ifndef GNOMON_GPU_INTERFACE_NUMBERS_H
#define GNOMON_GPU_INTERFACE_NUMBERS_H

#ifdef __cplusplus
#include <cstdint>
#define GNOMON_CONSTANT inline constexpr
#define GNOMON_UINT std::uint32_t
namespace gnomon::gpu {
#else
#define GNOMON_CONSTANT const
#define GNOMON_UINT uint
#endif

// --- Tiles -----------------------------------------------------------------------------------------------------------
// One work unit of phases 3 and 4, one lane per pixel: 480x270 = 129,600 tiles.
GNOMON_CONSTANT GNOMON_UINT kShadowTileSizePx = 8u;
// One work unit of phase 2, one lane per shadow tile: 60x34 = 2,040 groups of 64x64 pixels.
GNOMON_CONSTANT GNOMON_UINT kTileGroupSizeTiles = 8u;
GNOMON_CONSTANT GNOMON_UINT kTileGroupSizePx = kShadowTileSizePx * kTileGroupSizeTiles;
// Tiles in a row whose depth ranges one work group finds.
GNOMON_CONSTANT GNOMON_UINT kDepthTilesPerGroup = 4u;
// Equal parts of a tile's depth range; one bit each says whether it holds a pixel.
GNOMON_CONSTANT GNOMON_UINT kDepthSlices = 32u;
GNOMON_CONSTANT GNOMON_UINT kAllDepthSlices = 0xFFFFFFFFu;
// Granularity of the CPU's light masks: 120x68 = 8,160 entries.
GNOMON_CONSTANT GNOMON_UINT kMaskTileSizePx = 32u;
// Every work group is 64x1x1, lanes in Morton order over 8x8.
GNOMON_CONSTANT GNOMON_UINT kWorkGroupSize = 64u;
// Widest and highest extent accepted.
GNOMON_CONSTANT GNOMON_UINT kMaxExtentPx = 16384u;

// --- Lights ----------------------------------------------------------------------------------------------------------
GNOMON_CONSTANT GNOMON_UINT kMaxLightsPerView = 1024u;  // a light index has 10 bits
GNOMON_CONSTANT GNOMON_UINT kLightIndexBits = 10u;
GNOMON_CONSTANT GNOMON_UINT kLightGroupSize = 32u;  // lights per mask word
GNOMON_CONSTANT GNOMON_UINT kLightGroupCount = kMaxLightsPerView / kLightGroupSize;
// A light mask entry: one word with a bit per light group, then one word per light group: 132 bytes.
GNOMON_CONSTANT GNOMON_UINT kLightMaskEntryWords = 1u + kLightGroupCount;
GNOMON_CONSTANT GNOMON_UINT kZBinCount = 1024u;
// Standard entries first, then ranged ones: 8 KiB.
GNOMON_CONSTANT GNOMON_UINT kZBinWords = 2u * kZBinCount;
// A zBin without lights: minimum 0xFFFF above maximum 0.
GNOMON_CONSTANT GNOMON_UINT kZBinEmpty = 0x0000FFFFu;

// --- Lists and visibility slots --------------------------------------------------------------------------------------
// Early list space is given out in whole words, so list SlotIDs are multiples of three.
GNOMON_CONSTANT GNOMON_UINT kEarlyIndicesPerWord = 3u;
GNOMON_CONSTANT GNOMON_UINT kMaxVisibilityBits = 8u;  // of a pixel in a slot: 8, or 4
GNOMON_CONSTANT GNOMON_UINT kMinVisibilityBits = 4u;
GNOMON_CONSTANT GNOMON_UINT kDefaultListEntriesPerTile = 8u;
// The paper has 8. Four are 31.6 MiB, and enough for 7.5 shadowed lights per tile in the courtyard, which take 2.2.
GNOMON_CONSTANT GNOMON_UINT kDefaultVisibilitySlotsPerTile = 4u;
// Flags that stand in place of a 22-bit VisibilitySlotID. Slots are below the lowest of them.
GNOMON_CONSTANT GNOMON_UINT kSlotAllLit = 0x3FFFFFu;
GNOMON_CONSTANT GNOMON_UINT kSlotAllUnlit = 0x3FFFFEu;
GNOMON_CONSTANT GNOMON_UINT kSlotEvaluate = 0x3FFFFDu;
GNOMON_CONSTANT GNOMON_UINT kMaxVisibilitySlots = kSlotEvaluate;
// Tile Light SlotID of a tile that got no list space.
GNOMON_CONSTANT GNOMON_UINT kNoListSpace = 0xFFFFFFFFu;
// Tiles to be shaded with evaluation form rows of this many work groups in the indirect dispatch. A lone row is as long
// as there are tiles.
GNOMON_CONSTANT GNOMON_UINT kEvaluateRowTiles = 1024u;

// --- Light types and flags -------------------------------------------------------------------------------------------
GNOMON_CONSTANT GNOMON_UINT kLightPoint = 0u;
GNOMON_CONSTANT GNOMON_UINT kLightSpot = 1u;
GNOMON_CONSTANT GNOMON_UINT kLightDirectional = 2u;
GNOMON_CONSTANT GNOMON_UINT kLightTypeMask = 3u;
GNOMON_CONSTANT GNOMON_UINT kLightCastsBit = 4u;
// The shadow lets some light through, here or farther away: faces that look away may not be taken for dark.
GNOMON_CONSTANT GNOMON_UINT kLightShadowFadesBit = 8u;
// Bits 4 to 8: filter and PCSS preset, see below. Directional lights: number of cascades.
GNOMON_CONSTANT GNOMON_UINT kLightCascadesShift = 9u;
GNOMON_CONSTANT GNOMON_UINT kLightCascadesMask = 0xFu;
// Its six shadow views look along the axes of world space: point lights, and spots that have six.
GNOMON_CONSTANT GNOMON_UINT kLightSixFacesBit = 0x2000u;
// shadowView of a light that casts no shadow.
GNOMON_CONSTANT GNOMON_UINT kNoShadowView = 0xFFFFFFFFu;
GNOMON_CONSTANT GNOMON_UINT kPointLightFaces = 6u;
GNOMON_CONSTANT GNOMON_UINT kMaxCascades = 8u;

// --- Shadowmaps ------------------------------------------------------------------------------------------------------
GNOMON_CONSTANT GNOMON_UINT kMaxShadowAtlases = 4u;
GNOMON_CONSTANT GNOMON_UINT kShadowViewOrthographicBit = 1u;
GNOMON_CONSTANT GNOMON_UINT kShadowViewReversedZBit = 2u;
GNOMON_CONSTANT GNOMON_UINT kMaxPcfRadius = 3u;
// Smallest side of a shadow view's rectangle: the widest PCF kernel must fit.
GNOMON_CONSTANT GNOMON_UINT kMinShadowViewSizePx = 2u * kMaxPcfRadius + 2u;
// Texels of a cascade's border that no receiver uses: what a bilinear tap and the snapping to texels may need.
GNOMON_CONSTANT GNOMON_UINT kCascadeMarginPx = 4u;
// One part in so many of a cascade's extent, at its border, is blended into the next one. Of the last, into light.
GNOMON_CONSTANT GNOMON_UINT kCascadeBlendedPart = 10u;
// Shadow bounds: blocks of the finest level; levels, each twice as wide; a cell is one block of the coarsest.
GNOMON_CONSTANT GNOMON_UINT kShadowBoundsBlockPx = 16u;
GNOMON_CONSTANT GNOMON_UINT kShadowBoundsLevels = 5u;
GNOMON_CONSTANT GNOMON_UINT kShadowBoundsCellPx = kShadowBoundsBlockPx << (kShadowBoundsLevels - 1u);
GNOMON_CONSTANT GNOMON_UINT kShadowBoundsCellBlocks = 1u << (kShadowBoundsLevels - 1u);
// 256 + 64 + 16 + 4 + 1 blocks of a cell, rounded up: 8 bytes each, 2.8 MB for an atlas of 8192x8192.
GNOMON_CONSTANT GNOMON_UINT kShadowBoundsCellEntries = 344u;
GNOMON_CONSTANT GNOMON_UINT kMaxPcssTaps = 64u;
// A penumbra is never wider than this radius in texels; what a source asks for beyond is cut.
GNOMON_CONSTANT GNOMON_UINT kMaxPcssRadiusPx = 48u;

// --- Visibility providers --------------------------------------------------------------------------------------------
// A light's filter, in its typeAndFlags; a set of filters has one bit each: 1 << filter.
GNOMON_CONSTANT GNOMON_UINT kFilterHard = 0u;
GNOMON_CONSTANT GNOMON_UINT kFilterPcf = 1u;
GNOMON_CONSTANT GNOMON_UINT kFilterPcss = 2u;
GNOMON_CONSTANT GNOMON_UINT kFilterHost = 3u;        // the host's own function
GNOMON_CONSTANT GNOMON_UINT kFilterPcssShared = 4u;  // one search for 2x2 pixels
GNOMON_CONSTANT GNOMON_UINT kFilterCount = 5u;
GNOMON_CONSTANT GNOMON_UINT kLightFilterShift = 4u;
GNOMON_CONSTANT GNOMON_UINT kLightFilterMask = 7u;
// Filters that are evaluated tile by tile: so cheap that a queue costs more than it saves. A set.
GNOMON_CONSTANT GNOMON_UINT kFiltersByTile = 1u << kFilterHard | 1u << kFilterPcf;
// Which of the frame's taps the light's soft shadows take.
GNOMON_CONSTANT GNOMON_UINT kMaxPcssPresets = 4u;
GNOMON_CONSTANT GNOMON_UINT kLightPcssPresetShift = 7u;
GNOMON_CONSTANT GNOMON_UINT kLightPcssPresetMask = kMaxPcssPresets - 1u;

// --- Pairs -----------------------------------------------------------------------------------------------------------
// What shadow views a casting light has. Pipelines that know it hold less code.
GNOMON_CONSTANT GNOMON_UINT kShadowViewsAny = 0u;       // to be asked of the light
GNOMON_CONSTANT GNOMON_UINT kShadowViewsOne = 1u;       // spots
GNOMON_CONSTANT GNOMON_UINT kShadowViewsSixFaces = 2u;  // points, and spots that have six
GNOMON_CONSTANT GNOMON_UINT kShadowViewsCascades = 3u;  // directional lights
GNOMON_CONSTANT GNOMON_UINT kShadowViewsKinds = 3u;     // without "any"
// A queue per filter and kind of shadow views: see pairQueueOf() of packing.h.
GNOMON_CONSTANT GNOMON_UINT kPairQueueCount = kFilterCount * kShadowViewsKinds;
// Work groups over pairs form rows of this many in indirect dispatches. A lone row is as long as it must be.
GNOMON_CONSTANT GNOMON_UINT kPairRowGroups = 1024u;
// List space beyond this might need more rows than a dispatch may have, 65535.
GNOMON_CONSTANT GNOMON_UINT kMostListEntries = 65535u * kPairRowGroups;
// Places of list space that one work group of classify_pairs takes.
GNOMON_CONSTANT GNOMON_UINT kPlacesPerClassifyGroup = 512u;
// Pairs that one work group of search_pairs takes, 16 quads of 2x2 pixels each. Several rounds of them, so that the
// group's atomics are few.
GNOMON_CONSTANT GNOMON_UINT kQuadsPerTile = kWorkGroupSize / 4u;
GNOMON_CONSTANT GNOMON_UINT kSearchRounds = 4u;
GNOMON_CONSTANT GNOMON_UINT kPairsPerSearchGroup = kSearchRounds * (kWorkGroupSize / kQuadsPerTile);
// Pairs that one work group of filter_pairs takes: so many where subgroups are smaller than a tile, else one.
GNOMON_CONSTANT GNOMON_UINT kMostPairsPerFilterGroup = 4u;
// What a search tells of a quad, 16 bits. Else the filter's radius in parts of a texel.
GNOMON_CONSTANT GNOMON_UINT kQuadDark = 0u;
GNOMON_CONSTANT GNOMON_UINT kQuadLit = 0xFFFFu;
GNOMON_CONSTANT GNOMON_UINT kQuadOwn = 0xFFFEu;         // each pixel searches by itself
GNOMON_CONSTANT GNOMON_UINT kQuadLitIfAsked = 0xFFFDu;  // lit, but for pixels that do not ask the shadowmap
GNOMON_CONSTANT GNOMON_UINT kQuadDarkInMap = 0xFFFCu;   // dark, but where the last cascade blends into light
GNOMON_CONSTANT GNOMON_UINT kQuadMostRadius = 0xFFFBu;
GNOMON_CONSTANT GNOMON_UINT kQuadRadiusParts = 1024u;

// --- Depth bias ------------------------------------------------------------------------------------------------------
GNOMON_CONSTANT GNOMON_UINT kDepthBiasOriented = 0u;          // toward the light; each texel against the face's plane
GNOMON_CONSTANT GNOMON_UINT kDepthBiasOrientedConstant = 1u;  // toward the light or away from it; one depth for all
GNOMON_CONSTANT GNOMON_UINT kDepthBiasUnbiased = 2u;          // the host biases what it draws, or nobody does

// --- Frame flags -----------------------------------------------------------------------------------------------------
GNOMON_CONSTANT GNOMON_UINT kFrameOrthographicBit = 1u;
GNOMON_CONSTANT GNOMON_UINT kFrameFaceNormalsBit = 2u;    // the host has face normals; else derived from depth
GNOMON_CONSTANT GNOMON_UINT kFrameReceiverFlagsBit = 4u;  // the host has receiver flags; else mask 0xFF, no subsurface
GNOMON_CONSTANT GNOMON_UINT kFrameFacingCullBit = 8u;     // phase 3 drops lights that every pixel faces away from

// Receiver flags: R8G8_UINT, red = receiver mask, green = these bits.
GNOMON_CONSTANT GNOMON_UINT kReceiverSubsurfaceBit = 1u;

// --- Who writes the early lists --------------------------------------------------------------------------------------
GNOMON_CONSTANT GNOMON_UINT kListsByFroxel = 0u;  // phase 2: lights that may reach a tile's froxel
GNOMON_CONSTANT GNOMON_UINT kListsByPixel = 1u;   // phase 3, the paper's: lights that reach a pixel

// --- How list space is reserved --------------------------------------------------------------------------------------
GNOMON_CONSTANT GNOMON_UINT kReserveApproximate = 0u;  // the paper: by phase 2, from the approximate count
GNOMON_CONSTANT GNOMON_UINT kReserveAccurate = 1u;     // by phase 3, from the exact count
GNOMON_CONSTANT GNOMON_UINT kReserveFixed = 2u;        // debugging: a fixed number of entries per tile

// --- Per-tile count words --------------------------------------------------------------------------------------------
// Early count: the number of lights in the low bits, and above them how many of these cast shadows. Tiles without list
// space have both numbers, too.
GNOMON_CONSTANT GNOMON_UINT kEarlyCountMask = 0x7FFu;
GNOMON_CONSTANT GNOMON_UINT kEarlyCastingShift = 16u;
// Final count: number of entries, and this bit where the tile must be shaded with evaluation.
GNOMON_CONSTANT GNOMON_UINT kFinalCountMask = 0x7FFu;
GNOMON_CONSTANT GNOMON_UINT kFinalEvaluateBit = 0x80000000u;

// --- Specialization constants ----------------------------------------------------------------------------------------
// Ids are the order of the members of Specialization (structs.h).
GNOMON_CONSTANT GNOMON_UINT kSpecSubgroupSize = 0u;      // 4, 8, 16, 32 or 64
GNOMON_CONSTANT GNOMON_UINT kSpecFilters = 1u;           // set of filters that lights may have; 0: everything is lit
GNOMON_CONSTANT GNOMON_UINT kSpecListReservation = 2u;   // kReserveApproximate ...
GNOMON_CONSTANT GNOMON_UINT kSpecPcfRadius = 3u;         // texels, 1 to kMaxPcfRadius
GNOMON_CONSTANT GNOMON_UINT kSpecHostDepthPyramid = 4u;  // 1: tile depth ranges come from the host's own pyramid
GNOMON_CONSTANT GNOMON_UINT kSpecPcssPresets = 5u;       // 1 to kMaxPcssPresets
GNOMON_CONSTANT GNOMON_UINT kSpecVisibilityBits = 6u;    // 8 or 4
GNOMON_CONSTANT GNOMON_UINT kSpecShadowAtlases = 7u;     // 1 to kMaxShadowAtlases: how many a frame may have
GNOMON_CONSTANT GNOMON_UINT kSpecDepthBias = 8u;         // kDepthBiasOriented ...
GNOMON_CONSTANT GNOMON_UINT kSpecFacedAwayIsDark = 9u;   // 1: a face that looks away from a light is dark, unasked
GNOMON_CONSTANT GNOMON_UINT kSpecLightLists = 10u;       // kListsByFroxel ...
GNOMON_CONSTANT GNOMON_UINT kSpecShadowViews = 11u;      // kShadowViewsAny ...
GNOMON_CONSTANT GNOMON_UINT kSpecCount = 12u;
GNOMON_CONSTANT GNOMON_UINT kSpecFirstFree = 16u;  // a host's own constants start here

// --- Descriptor sets and bindings ------------------------------------------------------------------------------------
// Vulkan promises no more than four sets.
GNOMON_CONSTANT GNOMON_UINT kSetLists = 0u;       // all that lighting, EVALUATE and forward shaders read
GNOMON_CONSTANT GNOMON_UINT kSetReceivers = 1u;   // the host's depth and what belongs to it
GNOMON_CONSTANT GNOMON_UINT kSetShadowmaps = 2u;  // bound only where shadows are evaluated
GNOMON_CONSTANT GNOMON_UINT kSetWorking = 3u;     // of the library's own passes; in the host's shaders the host's own
GNOMON_CONSTANT GNOMON_UINT kSetCount = 4u;

GNOMON_CONSTANT GNOMON_UINT kBindFrame = 0u;
GNOMON_CONSTANT GNOMON_UINT kBindLights = 1u;
GNOMON_CONSTANT GNOMON_UINT kBindZBins = 2u;
GNOMON_CONSTANT GNOMON_UINT kBindTileLightMasks = 3u;
GNOMON_CONSTANT GNOMON_UINT kBindTileGroupLightMasks = 4u;
GNOMON_CONSTANT GNOMON_UINT kBindTileDepthRanges = 5u;
GNOMON_CONSTANT GNOMON_UINT kBindTileLightSlotIds = 6u;
GNOMON_CONSTANT GNOMON_UINT kBindEarlyList = 7u;
GNOMON_CONSTANT GNOMON_UINT kBindEarlyCounts = 8u;
GNOMON_CONSTANT GNOMON_UINT kBindFinalList = 9u;
GNOMON_CONSTANT GNOMON_UINT kBindFinalCounts = 10u;
GNOMON_CONSTANT GNOMON_UINT kBindVisibility = 11u;
GNOMON_CONSTANT GNOMON_UINT kBindEvaluateTiles = 12u;
GNOMON_CONSTANT GNOMON_UINT kListsBindingCount = 13u;
// Receivers: depth and, where the host has them, face normals, receiver flags and a depth pyramid.
GNOMON_CONSTANT GNOMON_UINT kBindDepth = 0u;
GNOMON_CONSTANT GNOMON_UINT kBindFaceNormals = 1u;
GNOMON_CONSTANT GNOMON_UINT kBindReceiverFlags = 2u;
GNOMON_CONSTANT GNOMON_UINT kBindHostDepthPyramid = 3u;
GNOMON_CONSTANT GNOMON_UINT kReceiversBindingCount = 4u;
// Shadowmaps and their bounds.
GNOMON_CONSTANT GNOMON_UINT kBindShadowViews = 0u;
GNOMON_CONSTANT GNOMON_UINT kBindShadowAtlas0 = 1u;  // and the next kMaxShadowAtlases - 1
GNOMON_CONSTANT GNOMON_UINT kBindShadowSampler = kBindShadowAtlas0 + kMaxShadowAtlases;  // nearest, clamped
GNOMON_CONSTANT GNOMON_UINT kBindShadowBounds = kBindShadowSampler + 1u;
GNOMON_CONSTANT GNOMON_UINT kShadowmapsBindingCount = kBindShadowBounds + 1u;
// Working buffers of the view's passes.
GNOMON_CONSTANT GNOMON_UINT kBindCounters = 0u;
GNOMON_CONSTANT GNOMON_UINT kBindApproximateCounts = 1u;
GNOMON_CONSTANT GNOMON_UINT kBindShadowBoundsCells = 2u;
GNOMON_CONSTANT GNOMON_UINT kBindListTiles = 3u;
GNOMON_CONSTANT GNOMON_UINT kBindPairQueues = 4u;
GNOMON_CONSTANT GNOMON_UINT kBindQueuedPairs = 5u;
GNOMON_CONSTANT GNOMON_UINT kBindTileDepthSlices = 6u;
GNOMON_CONSTANT GNOMON_UINT kWorkingBindingCount = 7u;

#ifdef __cplusplus
}  // namespace gnomon::gpu
#endif
#undef GNOMON_CONSTANT
#undef GNOMON_UINT
#endif  // GNOMON_GPU_INTERFACE_NUMBERS_H
