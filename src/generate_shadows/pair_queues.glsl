// Pairs of a tile and a light of its early list, named by the light's place in list space, and the queues in which they
// wait.
#ifndef GNOMON_GENERATE_SHADOWS_PAIR_QUEUES_GLSL
#define GNOMON_GENERATE_SHADOWS_PAIR_QUEUES_GLSL

#include "gpu_interface/lists_set.glsl"
#include "gpu_interface/working_set.glsl"

// How pixels and quads vote on their pair.
const uint kNoVote = 0u;
const uint kNotLit = 1u;   // some pixel is not wholly lit
const uint kNotDark = 2u;  // some pixel is not wholly dark
const uint kMixed = kNotLit | kNotDark;

struct Pair {
    uint place;       // in list space
    uint lightIndex;
    uvec2 tile;
};

Pair pairAt(uint place) {
    uint word = place / kEarlyIndicesPerWord;
    uint tile = listTiles[word];
    return Pair(place, unpackEarlyIndex(earlyList[word], place), uvec2(tile & 0xFFFFu, tile >> 16u));
}

// Whether the queue's pairs are searched quad by quad before they are filtered.
bool isSearched(uint queue) { return queue / kShadowViewsKinds == kFilterPcssShared; }

// Pairs that one work group of filter_pairs takes.
const uint kPairsPerFilterGroup = kSubgroupSize < kWorkGroupSize ? kMostPairsPerFilterGroup : 1u;

// A work group's number in a dispatch over pairs.
uint pairGroup() { return gl_WorkGroupID.y * kPairRowGroups + gl_WorkGroupID.x; }

#endif
