#include "checks.h"

#include <set>

#include "reference/hierarchical_depth.h"
#include "reference/on_screen.h"
#include "reference/prepare.h"

namespace gnomon::test {

using namespace reference;

ShadowInput shadowInputOf(const FrameInput& input, const FrameResult& result) {
    const ShadowSettings& settings = result.settings;
    ShadowInput out;
    out.shadowsOff = settings.filters == 0;
    out.pcfRadius = static_cast<int>(settings.pcfRadius);
    for (std::uint32_t i = 0; i < settings.pcssPresetCount; ++i)
        out.pcssPresets[i] = {static_cast<int>(settings.pcssPresets[i].searchTaps),
                              static_cast<int>(settings.pcssPresets[i].filterTaps)};
    out.patternTurn = settings.patternPerFrame ? result.constants.frameNumber * 2654435769u : 0u;
    EXPECT_EQ(result.constants.patternTurn, out.patternTurn);
    out.visibilityBits = settings.visibilityBits;
    out.bias = settings.depthBias == DepthBias::Oriented           ? BiasMode::Oriented
               : settings.depthBias == DepthBias::OrientedConstant ? BiasMode::OrientedConstant
                                                                   : BiasMode::Unbiased;
    out.facedAwayIsDark = settings.facedAwayIsDark;
    out.subsurfaceBiasMetres = settings.subsurfaceBiasMetres;
    out.views = makeShadowViewModels(input.shadows->views, input.shadows->atlases);
    out.atlases = input.shadows->atlases;
    return out;
}

namespace {

void expectNone(const Findings& findings, const char* what) {
    EXPECT_TRUE(findings.ok()) << what << ": " << findings.text();
}

/// Bits of `words` that belong to some tile's list.
std::vector<bool> ownedEntries(const FrameResult& r) {
    std::vector<bool> owned(r.listCapacity, false);
    for (std::size_t tile = 0; tile < r.slotIds.size(); ++tile) {
        if (r.slotIds[tile] == gpu::kNoListSpace) continue;
        const std::uint32_t count = gpu::roundUpToEarlyWord(r.earlyCounts[tile] & gpu::kEarlyCountMask);
        for (std::uint32_t i = 0; i < count && r.slotIds[tile] + i < owned.size(); ++i)
            owned[r.slotIds[tile] + i] = true;
    }
    return owned;
}

/// Words of the queues that no queue of the frame can have used, but were written.
std::size_t strayQueueWords(const FrameResult& r, bool shadows) {
    const std::size_t capacity = r.listCapacity;
    std::vector<bool> used(2 * capacity, false);
    const auto use = [&](std::size_t first, std::size_t count, std::size_t end) {
        for (std::size_t i = first; i < first + count && i < end; ++i) used[i] = true;
    };
    for (const gpu::GpuPairQueue& queue : r.pairs.queues) {
        if (!shadows || queue.searchCount + queue.filterCount == 0) continue;
        use(queue.first, queue.searchCount, capacity);
        use(capacity + queue.first, queue.filterCount, 2 * capacity);
    }
    std::size_t stray = 0;
    for (std::size_t i = 0; i < r.queuedPairs.size(); ++i)
        stray += (i >= used.size() || !used[i]) && r.queuedPairs[i] != kCanary;
    return stray;
}

}  // namespace

void checkCanaries(const FrameResult& r, bool shadows) {
    EXPECT_EQ(r.brokenGuards, 0u);
    EXPECT_EQ(r.beyondTiles, 0u);
    const std::vector<bool> owned = ownedEntries(r);
    std::size_t early = 0, tiles = 0, final = 0, slots = 0;
    for (std::size_t i = 0; i < owned.size(); ++i) {
        if (owned[i]) continue;
        final += i < r.finalList.size() && r.finalList[i] != kCanary;
        const std::size_t word = i / gpu::kEarlyIndicesPerWord;
        if (i % gpu::kEarlyIndicesPerWord != 0 || word >= r.earlyList.size()) continue;
        early += r.earlyList[word] != kCanary;
        tiles += r.listTiles[word] != kCanary;
    }
    const std::size_t used = shadows ? std::min(r.counters.visibilitySlots, r.slotCapacity) : 0;
    for (std::size_t i = used * r.slotWords(); i < r.visibility.size(); ++i) slots += r.visibility[i] != kCanary;
    EXPECT_EQ(early, 0u) << "words of the early list that no tile owns were written";
    EXPECT_EQ(strayQueueWords(r, shadows), 0u) << "words of the queues that no pair has a place in were written";
    EXPECT_EQ(tiles, 0u) << "tiles of words that no tile owns were written";
    EXPECT_EQ(final, 0u) << "words of the final list that no tile owns were written";
    EXPECT_EQ(slots, 0u) << "words of visibility slots that nobody took were written";
}

namespace {

/// Sums over the buffers of a frame.
struct Sums {
    std::uint32_t geometry = 0, approximate = 0, early = 0, casting = 0, most = 0;
    std::uint32_t reservedApproximate = 0, reservedAccurate = 0, withoutSpace = 0;
    std::uint32_t finals = 0, slots = 0, evaluate = 0, evaluateTiles = 0;
};

/// Filter::PcssShared takes slots before it filters. Of tiles that come out all dark or all lit they are spent.
bool mayWasteSlots(const FrameResult& r) {
    return (r.settings.filters & only(Filter::PcssShared)) != 0;
}

/// Queues are as long as list space. Where lists do not fit, some of its pairs find no place, and are evaluated.
bool mayLackQueue(const FrameResult& r, const CheckOptions& options) {
    return options.listOverflow && (r.settings.filters & ~gpu::kFiltersByTile) != 0;
}

Sums sumsOf(const FrameResult& r, bool shadows) {
    Sums sums;
    std::set<std::uint32_t> slots;
    const ListBuffers lists = r.lists();
    for (std::size_t tile = 0; tile < r.slotIds.size(); ++tile) {
        sums.geometry += r.depthRanges[2 * tile] <= r.depthRanges[2 * tile + 1];
        sums.approximate += r.approximateCounts[tile];
        const std::uint32_t count = r.earlyCounts[tile] & gpu::kEarlyCountMask;
        EXPECT_LE(count, r.approximateCounts[tile]) << "tile " << tile;
        sums.early += count;
        sums.most = std::max(sums.most, count);
        sums.casting += r.earlyCounts[tile] >> gpu::kEarlyCastingShift;
        sums.reservedApproximate += gpu::roundUpToEarlyWord(r.approximateCounts[tile]);
        sums.reservedAccurate += gpu::roundUpToEarlyWord(count);
        sums.withoutSpace += r.slotIds[tile] == gpu::kNoListSpace;
        if (!shadows) continue;
        sums.evaluateTiles += (r.finalCounts[tile] & gpu::kFinalEvaluateBit) != 0;
        for (const FinalEntry& entry : finalEntries(lists, tile)) {
            sums.finals += entry.slotOrFlag != gpu::kSlotAllUnlit;
            if (isSlot(entry.slotOrFlag)) slots.insert(entry.slotOrFlag);
            sums.evaluate += entry.slotOrFlag == gpu::kSlotEvaluate;
        }
    }
    sums.slots = static_cast<std::uint32_t>(slots.size());
    if (!slots.empty() && !mayWasteSlots(r)) {
        EXPECT_EQ(*slots.rbegin(), sums.slots - 1) << "slots were left out";
    }
    return sums;
}

void checkStatistics(const FrameResult& r, const Sums& sums) {
    const FrameStatistics& s = r.statistics;
    const auto tiles = static_cast<std::uint32_t>(r.slotIds.size());
    const bool fixed = r.settings.listReservation == ListReservation::Fixed;
    EXPECT_EQ(s.listEntries,
              fixed ? tiles * gpu::roundUpToEarlyWord(r.settings.fixedListEntriesPerTile) : r.counters.listEntries);
    EXPECT_EQ(s.visibilitySlots, r.counters.visibilitySlots);
    EXPECT_EQ(s.listOverflowTiles, sums.withoutSpace);
    EXPECT_EQ(s.accurateExceedsApproximate, 0u);
    EXPECT_EQ(s.tilesWithGeometry, sums.geometry);
    EXPECT_EQ(s.approximateEntries, sums.approximate);
    EXPECT_EQ(s.earlyEntries, sums.early);
    EXPECT_EQ(s.earlyCastingEntries, sums.casting);
    EXPECT_EQ(s.maxLightsInTile, sums.most);
    EXPECT_EQ(s.slotOverflowEntries, sums.evaluate);
    EXPECT_EQ(s.evaluateTiles, sums.evaluateTiles);
    EXPECT_EQ(s.finalEntries, sums.finals);
    EXPECT_EQ(s.finalSlotEntries, sums.slots);
    EXPECT_GE(s.recommendedListEntries, r.counters.listEntries);
    EXPECT_GE(s.recommendedVisibilitySlots, r.counters.visibilitySlots);
}

}  // namespace

namespace {

std::uint32_t queueOf(const gpu::GpuLight& light) {
    const std::uint32_t flags = light.typeAndFlags;
    std::uint32_t kind = gpu::kShadowViewsOne;
    if ((flags & gpu::kLightSixFacesBit) != 0) kind = gpu::kShadowViewsSixFaces;
    if ((flags & gpu::kLightTypeMask) == gpu::kLightDirectional) kind = gpu::kShadowViewsCascades;
    return gpu::pairQueueOf(flags >> gpu::kLightFilterShift & gpu::kLightFilterMask, kind);
}

/// Every pair of a casting light is in its queue, and the dispatches hold all pairs.
void checkQueues(const FrameResult& r) {
    std::uint32_t expected[gpu::kPairQueueCount] = {};
    for (std::size_t tile = 0; tile < r.slotIds.size(); ++tile)
        for (const std::uint32_t i : earlyLights(r.lists(), tile))
            if ((r.lights[i].typeAndFlags & gpu::kLightCastsBit) != 0) ++expected[queueOf(r.lights[i])];
    for (std::uint32_t i = 0; i < gpu::kPairQueueCount; ++i) {
        SCOPED_TRACE("queue " + std::to_string(i));
        const gpu::GpuPairQueue& queue = r.pairs.queues[i];
        const std::uint32_t filter = i / gpu::kShadowViewsKinds;
        const bool used = ((r.settings.filters & ~gpu::kFiltersByTile) >> filter & 1u) != 0;
        const bool searched = used && filter == gpu::kFilterPcssShared;
        EXPECT_GE(queue.listed, expected[i]);  // those of tiles without list space may be counted, too
        EXPECT_EQ(queue.searchCount, searched ? expected[i] : 0u);
        EXPECT_LE(queue.filterCount, expected[i]);
        if (!searched) {
            EXPECT_EQ(queue.filterCount, used ? expected[i] : 0u);
        }
        const std::uint32_t searchGroups = gpu::divideRoundingUp(queue.searchCount, gpu::kPairsPerSearchGroup);
        EXPECT_EQ(queue.searchGroupCountX, std::min(searchGroups, gpu::kPairRowGroups));
        EXPECT_EQ(queue.searchGroupCountY, gpu::divideRoundingUp(searchGroups, gpu::kPairRowGroups));
        EXPECT_EQ(queue.searchGroupCountZ, 1u);
        const std::uint32_t perGroup = r.subgroupSize < gpu::kWorkGroupSize ? gpu::kMostPairsPerFilterGroup : 1u;
        const std::uint32_t filterGroups = gpu::divideRoundingUp(queue.filterCount, perGroup);
        EXPECT_EQ(queue.filterGroupCountX, std::min(filterGroups, gpu::kPairRowGroups));
        EXPECT_EQ(queue.filterGroupCountY, gpu::divideRoundingUp(filterGroups, gpu::kPairRowGroups));
        EXPECT_EQ(queue.filterGroupCountZ, 1u);
    }
}

}  // namespace

void checkCounters(const FrameResult& r, const CheckOptions& options) {
    const Sums sums = sumsOf(r, options.shadows);
    const gpu::GpuCounters& c = r.counters;
    EXPECT_EQ(c.accurateExceedsApproximate, 0u);
    EXPECT_EQ(c.listOverflowTiles, sums.withoutSpace);
    if (r.settings.listReservation == ListReservation::Approximate) {
        EXPECT_EQ(c.listEntries, sums.reservedApproximate);
    } else if (r.settings.listReservation == ListReservation::Accurate) {
        EXPECT_EQ(c.listEntries, sums.reservedAccurate);
    }
    if (!options.listOverflow) {
        EXPECT_EQ(sums.withoutSpace, 0u);
    }
    if (options.shadows) {
        EXPECT_EQ(c.slotOverflowEntries, sums.evaluate);
        const std::uint32_t given = std::min(c.visibilitySlots, r.slotCapacity);
        if (mayWasteSlots(r)) {
            EXPECT_LE(sums.slots, given);
        } else {
            EXPECT_EQ(sums.slots, given);
        }
        if (mayLackQueue(r, options)) {
            EXPECT_GE(sums.evaluate, c.visibilitySlots - given);
        } else {
            EXPECT_EQ(sums.evaluate, c.visibilitySlots - given);
        }
        EXPECT_EQ(r.evaluateTiles[0], std::min(sums.evaluateTiles, gpu::kEvaluateRowTiles));
        EXPECT_EQ(r.evaluateTiles[1], gpu::divideRoundingUp(sums.evaluateTiles, gpu::kEvaluateRowTiles));
        EXPECT_EQ(r.evaluateTiles[2], 1u);
        EXPECT_EQ(r.evaluateTiles[3], sums.evaluateTiles);
        if (!options.slotOverflow && !mayLackQueue(r, options)) {
            EXPECT_EQ(sums.evaluate, 0u);
        }
    }
    if (options.shadows) checkQueues(r);
    if (r.hasStatistics) checkStatistics(r, sums);
}

namespace {

/// What prepare() said before the shadow views were planned: it is what the lists hold.
void checkAnswer(const std::vector<LightModel>& all, const CameraModel& camera, const FrameResult& result) {
    PreparedLights answer;
    answer.visible = result.answer;
    answer.report = result.answerReport;
    const std::vector<LightModel> lights = orderLights(all, answer.visible);
    const VisibleReport visible = checkVisibleLights(all, lights, camera);
    expectNone(visible.findings, "answer of phase 1");
    expectNone(checkReport(all.size(), visible.must, answer), "report of phase 1");
    const gpu::GpuFrame& frame = result.constants;
    const auto tiles = std::size_t(frame.maskTileColumns) * frame.maskTileRows;
    expectNone(checkOnScreen(lights, camera, answer.visible,
                             std::span(result.tileLightMasks).first(tiles * gpu::kLightMaskEntryWords),
                             frame.maskTileColumns, frame.maskTileRows),
               "lights on screen");
    ASSERT_EQ(result.lights.size(), answer.visible.size());
    for (std::size_t i = 0; i < lights.size(); ++i) EXPECT_EQ(result.lights[i].hostIndex, answer.visible[i].light);
}

}  // namespace

Checked checkFrame(const FrameInput& input, const FrameResult& result, const CheckOptions& options) {
    Checked out;
    if (result.slotIds.empty()) {
        ADD_FAILURE() << "the frame did not run";
        return out;
    }
    const CameraModel camera = makeCameraModel(input.camera, input.widthPx, input.heightPx);
    out.grid = makePixelGrid(camera, input.receivers);
    const std::vector<LightModel> all = makeLightModels(input.lights, input.lightViews, camera);
    checkAnswer(all, camera, result);
    expectNone(checkGpuLights(all, camera, result.lights), "lights");
    out.lights = orderLights(all, result.lights);
    if (options.depths) {
        expectNone(checkTileDepths(out.grid, result.depthRanges), "hierarchical depth");
        if (!result.settings.hostDepthPyramid)  // which tells no slices
            expectNone(checkTileSlices(out.grid, result.depthRanges, result.depthSlices), "depth slices");
    }
    const ShadowSettings& settings = result.settings;
    const bool byPixel = settings.lightLists == LightLists::Pixel;
    out.expected =
        findLights(out.grid, out.lights, byPixel && settings.dropLightsFacedAway && settings.facedAwayIsDark);
    const ListBuffers lists = result.lists();
    out.approximate = checkApproximate(out.grid, out.expected, out.lights.size(), result.groupMasks, lists);
    expectNone(out.approximate.findings, "find lights approximate");
    out.early = checkEarlyLists(out.expected, out.lights, lists);
    expectNone(out.early.findings, "find lights accurate");
    ListBuffers structure = lists;
    // Beyond the end of the pool, tiles without lights have no span of their own.
    if (options.listOverflow && result.settings.listReservation == ListReservation::Fixed)
        structure.reservation = gpu::kReserveAccurate;
    if (!options.shadows) structure.finalCounts = {};
    out.structure = checkStructure(structure, out.lights.size());
    expectNone(out.structure.findings, "structure of the lists");
    if (options.shadows) {
        expectNone(checkEvaluateTiles(lists, result.evaluateTiles), "tiles to evaluate");
        if (options.bytes) {
            out.shadows =
                checkFinalLists(out.grid, out.lights, shadowInputOf(input, result), lists, options.slotOverflow);
            expectNone(out.shadows.findings, "generate shadows");
        }
    }
    checkCanaries(result, options.shadows);
    checkCounters(result, options);
    return out;
}

std::vector<std::vector<DecodedEntry>> decodeFinalLists(const FrameResult& r) {
    std::vector<std::vector<DecodedEntry>> tiles(r.slotIds.size());
    const ListBuffers lists = r.lists();
    for (std::size_t tile = 0; tile < tiles.size(); ++tile) {
        for (const FinalEntry& entry : finalEntries(lists, tile)) {
            DecodedEntry decoded;
            decoded.hostLight = r.lights[entry.light].hostIndex;
            if (isSlot(entry.slotOrFlag)) {
                const auto first = r.visibility.begin() + std::ptrdiff_t(entry.slotOrFlag) * r.slotWords();
                decoded.bytes.assign(first, first + r.slotWords());
            } else {
                decoded.flag = entry.slotOrFlag;
            }
            tiles[tile].push_back(std::move(decoded));
        }
    }
    return tiles;
}

std::vector<std::vector<std::uint32_t>> decodeEarlyLists(const FrameResult& r) {
    std::vector<std::vector<std::uint32_t>> tiles(r.slotIds.size());
    for (std::size_t tile = 0; tile < tiles.size(); ++tile) tiles[tile] = earlyLights(r.lists(), tile);
    return tiles;
}

}  // namespace gnomon::test
