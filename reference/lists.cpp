// See lists.h.
#include "reference/lists.h"

#include <algorithm>
#include <map>
#include <set>

namespace gnomon::reference {
namespace {

std::uint32_t reservedEntries(const ListBuffers& buffers, std::size_t tile) {
    switch (buffers.reservation) {
        case gpu::kReserveAccurate:
            return gpu::roundUpToEarlyWord(buffers.earlyCounts[tile] & gpu::kEarlyCountMask);
        case gpu::kReserveFixed:
            return gpu::roundUpToEarlyWord(buffers.fixedEntries);
        default:
            return gpu::roundUpToEarlyWord(buffers.approximateCounts[tile]);
    }
}

void checkSpans(StructureReport& report, const ListBuffers& buffers) {
    std::vector<std::pair<std::uint64_t, std::size_t>> starts;  // (SlotID, tile) of spans that are not empty
    for (std::size_t tile = 0; tile < buffers.tileLightSlotIds.size(); ++tile) {
        if (hasNoListSpace(buffers, tile)) {
            ++report.tilesWithoutSpace;
            continue;
        }
        const std::uint64_t start = buffers.tileLightSlotIds[tile];
        const std::uint64_t size = reservedEntries(buffers, tile);
        if (size == 0) continue;
        report.reservedEntries += size;
        if (start % gpu::kEarlyIndicesPerWord != 0)
            report.findings.add("tile %zu: SlotID %llu is no multiple of three", tile, (unsigned long long)start);
        if (start + size > buffers.listEntries)
            report.findings.add("tile %zu: entries %llu to %llu are beyond the pool's %u", tile,
                                (unsigned long long)start, (unsigned long long)(start + size), buffers.listEntries);
        starts.emplace_back(start, tile);
    }
    std::sort(starts.begin(), starts.end());
    for (std::size_t i = 1; i < starts.size(); ++i) {
        const std::size_t before = starts[i - 1].second;
        if (starts[i - 1].first + reservedEntries(buffers, before) > starts[i].first)
            report.findings.add("tiles %zu and %zu overlap in the list pool", before, starts[i].second);
    }
}

void checkAscending(Findings& findings, std::size_t tile, const std::vector<std::uint32_t>& lights,
                    std::size_t lightCount) {
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (lights[i] >= lightCount)
            findings.add("tile %zu: early list names light %u of %zu", tile, lights[i], lightCount);
        if (i > 0 && lights[i] <= lights[i - 1])
            findings.add("tile %zu: early list has light %u after light %u", tile, lights[i], lights[i - 1]);
    }
}

void checkFinal(StructureReport& report, const ListBuffers& buffers, std::size_t tile,
                const std::vector<std::uint32_t>& early, std::map<std::uint32_t, std::size_t>& slotOwner) {
    bool evaluates = hasNoListSpace(buffers, tile);
    std::vector<std::uint32_t> lights;
    for (const FinalEntry& entry : finalEntries(buffers, tile)) {
        lights.push_back(entry.light);
        if (entry.slotOrFlag == gpu::kSlotEvaluate) {
            evaluates = true;
            ++report.evaluateEntries;
        } else if (isSlot(entry.slotOrFlag)) {
            ++report.usedSlots;
            if (entry.slotOrFlag >= buffers.visibilitySlots)
                report.findings.add("tile %zu, light %u: slot %u is beyond the pool's %u", tile, entry.light,
                                    entry.slotOrFlag, buffers.visibilitySlots);
            const auto [owner, fresh] = slotOwner.emplace(entry.slotOrFlag, tile);
            if (!fresh) report.findings.add("tiles %zu and %zu share slot %u", owner->second, tile, entry.slotOrFlag);
        } else if (entry.slotOrFlag != gpu::kSlotAllLit && entry.slotOrFlag != gpu::kSlotAllUnlit) {
            report.findings.add("tile %zu, light %u: flag %x", tile, entry.light, entry.slotOrFlag);
        }
    }
    if (lights != early) report.findings.add("tile %zu: its final list is not parallel to its early list", tile);
    const bool marked = (buffers.finalCounts[tile] & gpu::kFinalEvaluateBit) != 0;
    report.evaluateTiles += marked;
    if (marked != evaluates)
        report.findings.add("tile %zu %s the evaluate bit", tile, marked ? "must not have" : "lacks");
    const std::uint32_t count = buffers.finalCounts[tile] & gpu::kFinalCountMask;
    if (count != early.size())
        report.findings.add("tile %zu: %u final entries from %zu early ones", tile, count, early.size());
}

}  // namespace

bool hasNoListSpace(const ListBuffers& buffers, std::size_t tile) {
    return buffers.tileLightSlotIds[tile] == gpu::kNoListSpace;
}

std::vector<std::uint32_t> earlyLights(const ListBuffers& buffers, std::size_t tile) {
    std::vector<std::uint32_t> result;
    if (hasNoListSpace(buffers, tile)) return result;
    const std::uint32_t slotId = buffers.tileLightSlotIds[tile];
    const std::uint32_t count = buffers.earlyCounts[tile] & gpu::kEarlyCountMask;
    for (std::uint32_t entry = 0; entry < count; ++entry) {
        const std::uint32_t word = gpu::earlyWordIndex(slotId, entry);
        if (word < buffers.earlyList.size()) result.push_back(gpu::unpackEarlyIndex(buffers.earlyList[word], entry));
    }
    return result;
}

std::vector<FinalEntry> finalEntries(const ListBuffers& buffers, std::size_t tile) {
    std::vector<FinalEntry> result;
    if (hasNoListSpace(buffers, tile)) return result;
    const std::uint32_t slotId = buffers.tileLightSlotIds[tile];
    const std::uint32_t count = buffers.finalCounts[tile] & gpu::kFinalCountMask;
    for (std::uint32_t entry = 0; entry < count; ++entry) {
        if (std::size_t(slotId) + entry >= buffers.finalList.size()) break;
        const std::uint32_t word = buffers.finalList[slotId + entry];
        result.push_back({gpu::finalLightIndex(word), gpu::finalSlotOrFlag(word)});
    }
    return result;
}

bool isSlot(std::uint32_t slotOrFlag) {
    return slotOrFlag < gpu::kMaxVisibilitySlots;
}

std::uint8_t storedVisibility(const ListBuffers& buffers, std::uint32_t slot, std::uint32_t x, std::uint32_t y) {
    const std::uint32_t lane = gpu::mortonLane(x, y);
    const std::uint32_t bits = buffers.visibilityBits, perWord = 32 / bits;
    const std::size_t word = std::size_t(slot) * gpu::visibilitySlotWords(bits) + lane / perWord;
    if (word >= buffers.visibility.size()) return 0;
    const std::uint32_t value = buffers.visibility[word] >> (bits * (lane % perWord));
    return static_cast<std::uint8_t>(value & gpu::visibilityLevels(bits));
}

StructureReport checkStructure(const ListBuffers& buffers, std::size_t lightCount) {
    StructureReport report;
    const std::size_t tiles = std::size_t(buffers.tilesX) * buffers.tilesY;
    if (buffers.tileLightSlotIds.size() != tiles || buffers.approximateCounts.size() != tiles ||
        buffers.earlyCounts.size() != tiles) {
        report.findings.add("per-tile arrays do not have %zu elements", tiles);
        return report;
    }
    checkSpans(report, buffers);
    std::map<std::uint32_t, std::size_t> slotOwner;
    for (std::size_t tile = 0; tile < tiles; ++tile) {
        const std::vector<std::uint32_t> early = earlyLights(buffers, tile);
        const std::uint32_t count = buffers.earlyCounts[tile] & gpu::kEarlyCountMask;
        if (!hasNoListSpace(buffers, tile) && count > reservedEntries(buffers, tile))
            report.findings.add("tile %zu: %u early entries in a span of %u", tile, count,
                                reservedEntries(buffers, tile));
        checkAscending(report.findings, tile, early, lightCount);
        if (buffers.finalCounts.size() == tiles) checkFinal(report, buffers, tile, early, slotOwner);
    }
    return report;
}

Findings checkEvaluateTiles(const ListBuffers& buffers, std::span<const std::uint32_t> words) {
    Findings findings;
    std::set<std::uint32_t> expected, found;
    for (std::uint32_t y = 0; y < buffers.tilesY; ++y)
        for (std::uint32_t x = 0; x < buffers.tilesX; ++x)
            if (buffers.finalCounts[std::size_t(y) * buffers.tilesX + x] & gpu::kFinalEvaluateBit)
                expected.insert(y << 16 | x);
    constexpr std::size_t kHeadWords = sizeof(gpu::GpuEvaluateHead) / 4;
    if (words.size() < kHeadWords + expected.size()) {
        findings.add("%zu words are too few for %zu tiles", words.size(), expected.size());
        return findings;
    }
    const std::uint32_t count = words[3];
    if (count != expected.size()) findings.add("%u tiles to evaluate instead of %zu", count, expected.size());
    for (std::size_t i = 0; i < count && kHeadWords + i < words.size(); ++i) {
        const std::uint32_t tile = words[kHeadWords + i];
        if (!found.insert(tile).second) findings.add("tile (%u, %u) is listed twice", tile & 0xFFFFu, tile >> 16);
        if (expected.count(tile) == 0) findings.add("tile (%u, %u) needs no evaluation", tile & 0xFFFFu, tile >> 16);
    }
    const std::uint32_t rows = gpu::divideRoundingUp(count, gpu::kEvaluateRowTiles);
    if (words[0] != std::min(count, gpu::kEvaluateRowTiles) || words[1] != rows || words[2] != 1)
        findings.add("dispatch of %u x %u x %u for %u tiles", words[0], words[1], words[2], count);
    return findings;
}

}  // namespace gnomon::reference
