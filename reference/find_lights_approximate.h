#pragma once
// Phase 2, Find lights approximate: what its masks and counts must hold.
//
// Source: the specification, Phase 2 and slip 8; the paper, section 2.2.
//
// What: phase 2 may keep too many lights, never too few. A light that surely reaches a pixel of a tile (phase 3's own
// tests, find_lights_accurate.h) must be in the light mask of the tile's group and in the tile's count, and no early
// count may exceed the approximate one. Where phase 2 writes the early lists (kListsByFroxel), a group's mask is
// exactly the union of its tiles' lists.
//
// Limits: the froxel tests themselves are not written again. How tight they are is reported: counted entries against
// those that the exact tests would allow.

#include "reference/find_lights_accurate.h"

namespace gnomon::reference {

struct ApproximateReport {
    Findings findings;
    std::size_t approximateEntries = 0;  ///< sum of the approximate counts
    std::size_t reachableEntries = 0;    ///< (tile, light) pairs that must or may reach
    std::size_t groupBits = 0;           ///< bits set in group masks
    std::size_t groupBitsNeeded = 0;     ///< of them, lights that must or may reach a pixel of the group
    /// Share of the counted entries that reach no pixel of their tile.
    [[nodiscard]] double surplusShare() const {
        return approximateEntries > reachableEntries ? 1.0 - double(reachableEntries) / double(approximateEntries)
                                                     : 0.0;
    }
};

/// `expected`: findLights() with the facing rule that the frame uses. `groupMasks`: kLightMaskEntryWords words per tile
/// group, in rows; words whose group bit is clear count as zero. A group's mask is held to the union of its lists only
/// where all its tiles have list space.
ApproximateReport checkApproximate(const PixelGrid& grid, const std::vector<TileLights>& expected,
                                   std::size_t lightCount, std::span<const std::uint32_t> groupMasks,
                                   const ListBuffers& buffers);

}  // namespace gnomon::reference
