#pragma once
// Phase 4 against the oracle: final lists and visibility slots.
//
// Source: the specification, Phase 4, Overflow, and "Stored visibility is perceptual".
//
// What, for every light of a tile's early list: the tile's voting pixels (in the light's influence) each have an
// interval of acceptable values (generate_shadows.h). ALL_UNLIT needs 0 to be acceptable everywhere, ALL_LIT the
// largest; a slot needs each voting pixel's value in its interval, and not surely all dark or all lit. EVALUATE stands
// for a slot where the pool is full. Pixels that only may vote bind nothing by themselves; a light that no pixel votes
// on may have either flag. Filter::PcssShared decides on a slot before it filters. So where a tile has pixels that do
// not vote, all lit may be stored in a slot, and EVALUATE may stand for all dark or all lit.
//
// Limits: early lists are taken as they are (find_lights_accurate.h checks them); tiles without list space have none.

#include "reference/find_lights_accurate.h"
#include "reference/generate_shadows.h"

namespace gnomon::reference {

struct ShadowReport {
    Findings findings;
    std::size_t pairs = 0;           ///< (voting pixel, light) pairs looked at
    std::size_t ambiguousPairs = 0;  ///< of them, with more than one acceptable value
    std::size_t loosePairs = 0;      ///< of them, with more than two
    std::size_t bytes = 0;           ///< pixels of slots compared
    std::size_t exactBytes = 0;      ///< of them, where one value alone was acceptable and it was there
    std::size_t wrongBytes = 0;
    std::size_t allUnlit = 0, allLit = 0, slots = 0, evaluate = 0;  ///< (tile, light) pairs by their fate
    [[nodiscard]] double ambiguousShare() const { return pairs ? double(ambiguousPairs) / double(pairs) : 0.0; }
    [[nodiscard]] double looseShare() const { return pairs ? double(loosePairs) / double(pairs) : 0.0; }
};

/// `mayEvaluate`: the visibility pool overflowed, so EVALUATE is allowed.
ShadowReport checkFinalLists(const PixelGrid& grid, const std::vector<LightModel>& lights, const ShadowInput& input,
                             const ListBuffers& buffers, bool mayEvaluate = false);

}  // namespace gnomon::reference
