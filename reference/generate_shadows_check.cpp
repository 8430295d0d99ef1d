// See generate_shadows_check.h.
#include "reference/generate_shadows_check.h"

#include <optional>

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
    for (const auto [x, y] : grid.tilePixels(tileX, tileY)) {
        const Verdict votes = inInfluence(light, grid.at(x, y));
        if (votes == Verdict::Never) continue;
        result.push_back({x, y, votes == Verdict::Must, storedVisibility(light, grid.at(x, y), input)});
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

void checkPair(ShadowReport& report, const ListBuffers& buffers, std::size_t tile, std::uint32_t light,
               const std::vector<Voter>& all, int levels, std::optional<std::uint32_t> slotOrFlag, bool mayEvaluate) {
    for (const Voter& voter : all) {
        ++report.pairs;
        report.ambiguousPairs += voter.stored.ambiguous();
        report.loosePairs += voter.stored.max - voter.stored.min > 1;
    }
    const Unanimity together = unanimity(all, levels);
    if (!slotOrFlag) {
        ++report.absent;
        if (!together.mayBeDark) report.findings.add("tile %zu: light %u is absent but not all dark", tile, light);
        return;
    }
    if (together.mustBeDark) report.findings.add("tile %zu: light %u is listed but all dark", tile, light);
    if (*slotOrFlag == gpu::kSlotAllLit) {
        ++report.allLit;
        if (!together.mayBeLit) report.findings.add("tile %zu: light %u is ALL_LIT but not all lit", tile, light);
        return;
    }
    if (together.mustBeLit) report.findings.add("tile %zu: light %u is all lit but not flagged so", tile, light);
    if (*slotOrFlag == gpu::kSlotEvaluate) {
        ++report.evaluate;
        if (!mayEvaluate) report.findings.add("tile %zu: light %u is EVALUATE without overflow", tile, light);
    } else if (isSlot(*slotOrFlag)) {
        ++report.slots;
        checkSlot(report, buffers, tile, light, *slotOrFlag, all);
    } else {
        report.findings.add("tile %zu: light %u has flag %x", tile, light, *slotOrFlag);
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
            const std::vector<FinalEntry> entries = finalEntries(buffers, tile);
            for (const std::uint32_t light : earlyLights(buffers, tile)) {
                if (light >= lights.size()) continue;  // checkStructure tells
                std::optional<std::uint32_t> slotOrFlag;
                for (const FinalEntry& entry : entries)
                    if (entry.light == light) slotOrFlag = entry.slotOrFlag;
                checkPair(report, buffers, tile, light, voters(grid, tileX, tileY, lights[light], input),
                          input.levels(), slotOrFlag, mayEvaluate);
            }
        }
    }
    return report;
}

}  // namespace gnomon::reference
