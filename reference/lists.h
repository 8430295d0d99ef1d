#pragma once
// The light lists and their pools: decoding, and whether their structure is sound.
//
// Problem: tiles share one pool of list entries and one of visibility slots, given out by atomics. Two tiles that
// overlap, or an entry that names a slot of another, would be hard to see in a picture.
//
// Source: the paper, sections 2.2.2, 2.3.1 and 2.4.1; the specification, slips 2 to 4 and Overflow;
// gpu_interface/packing.h.
//
// What: a span [SlotID, SlotID + reserved) per tile, where reserved is the approximate count, the early count or a
// fixed number, rounded up to whole early words. The early list keeps three 10-bit indices per word from SlotID / 3 on.
// The final list is parallel to it: one word from SlotID on per entry of the early list, in the same order.
//
// Limits: counts and flags only; whether the right lights are listed is checked by the rooms of phases 2 to 4.

#include <cstdint>
#include <span>
#include <vector>

#include "gpu_interface/packing.h"
#include "reference/findings.h"

namespace gnomon::reference {

/// CPU copies of the library's buffers of one frame. Per-tile arrays in rows of shadow tiles.
struct ListBuffers {
    std::uint32_t tilesX = 0, tilesY = 0;
    std::span<const std::uint32_t> tileLightSlotIds;
    std::span<const std::uint32_t> approximateCounts;
    std::span<const std::uint32_t> earlyList;
    std::span<const std::uint32_t> earlyCounts;
    std::span<const std::uint32_t> finalList;  ///< empty: phase 4 has not run
    std::span<const std::uint32_t> finalCounts;
    std::span<const std::uint32_t> visibility;
    std::uint32_t listEntries = 0;                  ///< capacity
    std::uint32_t visibilitySlots = 0;              ///< capacity
    std::uint32_t lightLists = gpu::kListsByPixel;  ///< who writes the early lists
    std::uint32_t reservation = gpu::kReserveApproximate;
    std::uint32_t fixedEntries = 0;                          ///< for kReserveFixed
    std::uint32_t visibilityBits = gpu::kMaxVisibilityBits;  ///< of a pixel in a slot
};

struct FinalEntry {
    std::uint32_t light = 0;
    std::uint32_t slotOrFlag = 0;
};

bool hasNoListSpace(const ListBuffers& buffers, std::size_t tile);
/// Entries of a tile's lists; none if it has no list space. Entries that would lie outside the pool are left out.
std::vector<std::uint32_t> earlyLights(const ListBuffers& buffers, std::size_t tile);
std::vector<FinalEntry> finalEntries(const ListBuffers& buffers, std::size_t tile);
bool isSlot(std::uint32_t slotOrFlag);
/// A pixel's value in a visibility slot; x and y in 0..7.
std::uint8_t storedVisibility(const ListBuffers& buffers, std::uint32_t slot, std::uint32_t x, std::uint32_t y);

struct StructureReport {
    Findings findings;
    std::size_t tilesWithoutSpace = 0;
    std::size_t reservedEntries = 0;  ///< of tiles with space
    std::size_t usedSlots = 0;
    std::size_t evaluateEntries = 0;
    std::size_t evaluateTiles = 0;  ///< tiles with kFinalEvaluateBit
};
/// Spans are disjoint, in the pool and multiples of three; lights are ascending, unique and below `lightCount`; slots
/// are unique over the frame and below capacity; flags are ALL_LIT, ALL_UNLIT or EVALUATE; the final list has the early
/// list's lights, or none where there is no list space; kFinalEvaluateBit is set exactly where a tile has an EVALUATE
/// entry, or no list space.
StructureReport checkStructure(const ListBuffers& buffers, std::size_t lightCount);

/// kEvaluateTiles: a GpuEvaluateHead and then tile coordinates (y << 16 | x). Holds exactly the tiles with
/// kFinalEvaluateBit, each once, and the right dispatch size.
Findings checkEvaluateTiles(const ListBuffers& buffers, std::span<const std::uint32_t> words);

}  // namespace gnomon::reference
