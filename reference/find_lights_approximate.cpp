// See find_lights_approximate.h.
#include "reference/find_lights_approximate.h"

#include <set>

#include "reference/prepare.h"

namespace gnomon::reference {
namespace {

void checkTile(ApproximateReport& report, std::size_t tile, const TileLights& wanted,
               std::span<const std::uint32_t> groupEntry, const ListBuffers& buffers) {
    for (const std::uint32_t i : wanted.must)
        if (!maskHas(groupEntry, i)) report.findings.add("tile %zu: its group's mask has lost light %u", tile, i);
    const std::uint32_t approximate = buffers.approximateCounts[tile];
    const std::uint32_t early = buffers.earlyCounts[tile] & gpu::kEarlyCountMask;
    report.approximateEntries += approximate;
    report.reachableEntries += wanted.must.size() + wanted.may.size();
    if (approximate < wanted.must.size())
        report.findings.add("tile %zu counts %u lights, but %zu reach it", tile, approximate, wanted.must.size());
    if (early > approximate)
        report.findings.add("tile %zu: early count %u exceeds the approximate %u", tile, early, approximate);
}

/// The lights of the early lists of a group's tiles.
struct GroupLists {
    std::set<std::uint32_t> lights;
    bool complete = true;  ///< all its tiles have list space
};

void checkUnion(ApproximateReport& report, std::size_t group, std::span<const std::uint32_t> entry,
                const GroupLists& lists) {
    for (std::uint32_t i = 0; i < gpu::kMaxLightsPerView; ++i) {
        const bool listed = lists.lights.count(i) != 0;
        if (listed && !maskHas(entry, i))
            report.findings.add("tile group %zu: a tile lists light %u, which the mask has not", group, i);
        if (!listed && lists.complete && maskHas(entry, i))
            report.findings.add("tile group %zu: no tile lists light %u of the mask", group, i);
    }
}

}  // namespace

ApproximateReport checkApproximate(const PixelGrid& grid, const std::vector<TileLights>& expected,
                                   std::size_t lightCount, std::span<const std::uint32_t> groupMasks,
                                   const ListBuffers& buffers) {
    ApproximateReport report;
    const std::size_t groups = std::size_t(grid.groupsX) * grid.groupsY;
    if (groupMasks.size() < groups * gpu::kLightMaskEntryWords) {
        report.findings.add("%zu words are too few for %zu tile groups", groupMasks.size(), groups);
        return report;
    }
    std::vector<std::set<std::uint32_t>> reaching(groups);
    std::vector<GroupLists> lists(groups);
    for (std::uint32_t tileY = 0; tileY < grid.tilesY; ++tileY) {
        for (std::uint32_t tileX = 0; tileX < grid.tilesX; ++tileX) {
            const std::size_t tile = std::size_t(tileY) * grid.tilesX + tileX;
            const std::size_t group =
                std::size_t(tileY / gpu::kTileGroupSizeTiles) * grid.groupsX + tileX / gpu::kTileGroupSizeTiles;
            checkTile(report, tile, expected[tile],
                      groupMasks.subspan(group * gpu::kLightMaskEntryWords, gpu::kLightMaskEntryWords), buffers);
            reaching[group].insert(expected[tile].must.begin(), expected[tile].must.end());
            reaching[group].insert(expected[tile].may.begin(), expected[tile].may.end());
            const std::vector<std::uint32_t> listed = earlyLights(buffers, tile);
            lists[group].lights.insert(listed.begin(), listed.end());
            lists[group].complete = lists[group].complete && !hasNoListSpace(buffers, tile);
        }
    }
    for (std::size_t group = 0; group < groups; ++group) {
        const auto entry = groupMasks.subspan(group * gpu::kLightMaskEntryWords, gpu::kLightMaskEntryWords);
        for (std::uint32_t i = 0; i < gpu::kMaxLightsPerView; ++i) {
            if (!maskHas(entry, i)) continue;
            ++report.groupBits;
            report.groupBitsNeeded += reaching[group].count(i);
            if (i >= lightCount)
                report.findings.add("tile group %zu has the bit of light %u of %zu", group, i, lightCount);
        }
        if (buffers.lightLists == gpu::kListsByFroxel) checkUnion(report, group, entry, lists[group]);
    }
    return report;
}

}  // namespace gnomon::reference
