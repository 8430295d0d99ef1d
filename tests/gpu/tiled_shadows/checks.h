#pragma once
// A frame's result against the oracle. Every function reports through GoogleTest and adds to what the test may bound.

#include "reference/find_lights_accurate.h"
#include "reference/find_lights_approximate.h"
#include "reference/generate_shadows_check.h"
#include "reference/lists.h"
#include "rig.h"

namespace gnomon::test {

struct CheckOptions {
    bool shadows = true;        ///< phase 4 ran: check lists, slots and bytes against the oracle
    bool bytes = true;          ///< with `shadows`: the bytes too (slow)
    bool depths = true;         ///< the hierarchical depth is the library's own
    bool listOverflow = false;  ///< tiles without list space are expected
    bool slotOverflow = false;  ///< EVALUATE entries are expected
};

/// What the oracle found, for bounds and counts.
struct Checked {
    reference::PixelGrid grid;
    std::vector<reference::LightModel> lights;
    std::vector<reference::TileLights> expected;
    reference::ApproximateReport approximate;
    reference::EarlyListReport early;
    reference::StructureReport structure;
    reference::ShadowReport shadows;
};

/// Everything below, with bounds on what is too close to call.
Checked checkFrame(const FrameInput& input, const FrameResult& result, const CheckOptions& options = {});

/// What the oracle of phase 4 needs to know of a frame.
[[nodiscard]] reference::ShadowInput shadowInputOf(const FrameInput& input, const FrameResult& result);

/// Guards, and words that no tile owns, are as they were before the frame.
void checkCanaries(const FrameResult& result, bool shadows);
/// Counters and statistics against sums over the buffers.
void checkCounters(const FrameResult& result, const CheckOptions& options);

/// A tile's final lights with their bytes: equal for equal frames, whatever slots the atomics gave out.
struct DecodedEntry {
    std::uint32_t hostLight = 0;
    std::uint32_t flag = 0;  ///< 0: a slot
    std::vector<std::uint32_t> bytes;
    bool operator==(const DecodedEntry&) const = default;
};
std::vector<std::vector<DecodedEntry>> decodeFinalLists(const FrameResult& result);
std::vector<std::vector<std::uint32_t>> decodeEarlyLists(const FrameResult& result);

}  // namespace gnomon::test
