// See generate_shadows_check.h.
#include "reference/generate_shadows_check.h"

#include <algorithm>

#include "reference/pcss_quad.h"

namespace gnomon::reference {
namespace {

struct Voter {
    std::uint32_t x = 0, y = 0;
    bool surely = false;
    StoredVisibility stored;
};

std::vector<Voter> voters(const PixelGrid& grid, std::uint32_t tileX, std::uint32_t tileY, const LightModel& light,
                          const ShadowInput& input) {
    std::vector<Voter> result;
    QuadFindings quads(light, grid, input);
    for (const auto [x, y] : grid.tilePixels(tileX, tileY)) {
        const Verdict votes = inInfluence(light, grid.at(x, y));
        if (votes == Verdict::Never) continue;
        result.push_back({x, y, votes == Verdict::Must, storedVisibility(light, grid.at(x, y), input, quads.at(x, y))});
    }
    return result;
}

/// What all voters together allow: is "all dark" possible, and must it be so? Likewise "all lit".
struct Unanimity {
    bool mayBeDark = true, mustBeDark = true, mayBeLit = true, mustBeLit = true;
};
Unanimity unanimity(const std::vector<Voter>& all, int levels) {
    Unanimity result;
    for (const Voter& voter : all) {
        if (voter.surely && voter.stored.min > 0) result.mayBeDark = false;
        if (voter.surely && voter.stored.max < levels) result.mayBeLit = false;
        if (voter.stored.max > 0) result.mustBeDark = false;
        if (voter.stored.min < levels) result.mustBeLit = false;
    }
    return result;
}

void checkSlot(ShadowReport& report, const ListBuffers& buffers, std::size_t tile, std::uint32_t light,
               std::uint32_t slot, const std::vector<Voter>& all) {
    for (const Voter& voter : all) {
        if (!voter.surely) continue;
        const int q =
            storedVisibility(buffers, slot, voter.x % gpu::kShadowTileSizePx, voter.y % gpu::kShadowTileSizePx);
        ++report.bytes;
        if (voter.stored.holds(q)) {
            report.exactBytes += !voter.stored.ambiguous();
            continue;
        }
        ++report.wrongBytes;
        report.findings.add("tile %zu, light %u, pixel (%u, %u): stored %d is not in [%d, %d]", tile, light, voter.x,
                            voter.y, q, voter.stored.min, voter.stored.max);
    }
}

/// Is a slot, or EVALUATE in its place, needed?
void checkNeed(ShadowReport& report, std::size_t tile, const LightModel& light, const FinalEntry& entry,
               const std::vector<Voter>& all, int levels) {
    const Unanimity together = unanimity(all, levels);
    const bool shared = light.filter == Filter::PcssShared;
    const bool slot = isSlot(entry.slotOrFlag);
    if (together.mustBeDark && (slot || !shared))
        report.findings.add("tile %zu: light %u is all dark but not flagged so", tile, entry.light);
    const bool everyPixelVotes = all.size() == gpu::kWorkGroupSize &&
                                 std::all_of(all.begin(), all.end(), [](const Voter& v) { return v.surely; });
    if (together.mustBeLit && (!shared || (slot && everyPixelVotes)))
        report.findings.add("tile %zu: light %u is all lit but not flagged so", tile, entry.light);
}

void checkPair(ShadowReport& report, const ListBuffers& buffers, std::size_t tile, const LightModel& light,
               const FinalEntry& entry, const std::vector<Voter>& all, int levels, bool mayEvaluate) {
    for (const Voter& voter : all) {
        ++report.pairs;
        report.ambiguousPairs += voter.stored.ambiguous();
        report.loosePairs += voter.stored.max - voter.stored.min > 1;
    }
    const Unanimity together = unanimity(all, levels);
    if (entry.slotOrFlag == gpu::kSlotAllUnlit) {
        ++report.allUnlit;
        if (!together.mayBeDark)
            report.findings.add("tile %zu: light %u is ALL_UNLIT but not all dark", tile, entry.light);
    } else if (entry.slotOrFlag == gpu::kSlotAllLit) {
        ++report.allLit;
        if (!together.mayBeLit) report.findings.add("tile %zu: light %u is ALL_LIT but not all lit", tile, entry.light);
    } else if (entry.slotOrFlag == gpu::kSlotEvaluate) {
        ++report.evaluate;
        checkNeed(report, tile, light, entry, all, levels);
        if (!mayEvaluate) report.findings.add("tile %zu: light %u is EVALUATE without overflow", tile, entry.light);
    } else if (isSlot(entry.slotOrFlag)) {
        ++report.slots;
        checkNeed(report, tile, light, entry, all, levels);
        checkSlot(report, buffers, tile, entry.light, entry.slotOrFlag, all);
    } else {
        report.findings.add("tile %zu: light %u has flag %x", tile, entry.light, entry.slotOrFlag);
    }
}

}  // namespace

ShadowReport checkFinalLists(const PixelGrid& grid, const std::vector<LightModel>& lights, const ShadowInput& input,
                             const ListBuffers& buffers, bool mayEvaluate) {
    ShadowReport report;
    if (buffers.visibilityBits != input.visibilityBits) {
        report.findings.add("slots have %u bits instead of %u", buffers.visibilityBits, input.visibilityBits);
        return report;
    }
    for (std::uint32_t tileY = 0; tileY < grid.tilesY; ++tileY) {
        for (std::uint32_t tileX = 0; tileX < grid.tilesX; ++tileX) {
            const std::size_t tile = std::size_t(tileY) * grid.tilesX + tileX;
            for (const FinalEntry& entry : finalEntries(buffers, tile)) {
                if (entry.light >= lights.size()) continue;  // checkStructure tells
                const LightModel& light = lights[entry.light];
                checkPair(report, buffers, tile, light, entry, voters(grid, tileX, tileY, light, input), input.levels(),
                          mayEvaluate);
            }
        }
    }
    return report;
}

}  // namespace gnomon::reference
