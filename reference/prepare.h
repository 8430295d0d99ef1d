#pragma once
// Phase 1, Prepare: what its four outputs must hold.
//
// Problem: phase 1 culls, sorts, and marks lights in zBins and tile light masks by its own fast bounds. Whatever it
// does, a light whose volume meets a piece of the view must be found there.
//
// Source: the specification, Phase 1; the paper, section 2.1.
//
// What: every light is held against every mask tile and zBin by the exact convex test of convex.h. A light that is
// missing where it must be is an error; one that is marked where it can never be is surplus, counted and reported as a
// share.
//
// Limits: the masks' brute force costs (tiles x lights) tests, so views of up to some hundred pixels a side are right
// for it. The volume is that inside the view, between near and far plane: phase 1 may mark more, never less.

#include <span>

#include "gpu_interface/packing.h"
#include "reference/lights.h"

namespace gnomon::reference {

/// Does the light's volume meet the view? Directional lights do. Lights that have faded
/// away, and those that no receiver's mask can meet, do not.
Verdict isVisible(const LightModel& light, const CameraModel& camera);

/// Which lights are in the list, and in which order: every light that must be visible is there (unless the list is
/// full), none twice, directional lights first, the others by nearest view depth. Nearest view depth is that of the
/// ball or of the exact ball-and-cone, clamped to the near plane or not: one of these four keys must explain the whole
/// order. Ties, of lights with the same volume, by the host's index.
struct VisibleReport {
    Findings findings;
    std::size_t must = 0, may = 0;  ///< of all lights
    std::size_t surplus = 0;        ///< in the list, yet never visible (corners of the view): no error
};
VisibleReport checkVisibleLights(const std::vector<LightModel>& all, const std::vector<LightModel>& ordered,
                                 const CameraModel& camera);

struct CoverReport {
    Findings findings;
    std::size_t required = 0;  ///< (light, entry) pairs that must be marked
    std::size_t marked = 0;    ///< that are
    std::size_t surplus = 0;   ///< that are, and never need be
    [[nodiscard]] double surplusShare() const { return marked ? double(surplus) / double(marked) : 0.0; }
};

/// kZBinWords words: standard entries, then ranged ones. Bin b holds view depths from near + b / binsPerMetre on; both
/// numbers as phase 1 chose them (GpuFrame::zBins x, y). Ranged entries are compared as integers.
CoverReport checkZBins(const std::vector<LightModel>& lights, const CameraModel& camera,
                       std::span<const std::uint32_t> words, double nearMetres, double binsPerMetre);

/// The same for one tile's depth range: the light indices that phase 2 will look at, first to last; empty if first >
/// last.
struct IndexRange {
    std::uint32_t first = 1, last = 0;
};
IndexRange candidatesInDepthRange(std::span<const std::uint32_t> zBinWords, double nearMetres, double binsPerMetre,
                                  double minDepthMetres, double maxDepthMetres);

/// kLightMaskEntryWords words per mask tile, rows of `tilesX`. Words whose group bit is clear count as zero. Bits of
/// directional lights and beyond the last light are errors: directional lights stand outside the masks.
CoverReport checkTileLightMasks(const std::vector<LightModel>& lights, const CameraModel& camera,
                                std::span<const std::uint32_t> words, std::uint32_t tilesX, std::uint32_t tilesY);

/// Is the light's bit set in a mask entry, by the group bits?
bool maskHas(std::span<const std::uint32_t> entry, std::uint32_t lightIndex);

}  // namespace gnomon::reference
