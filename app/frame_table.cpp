#include "app/frame_table.h"

#include <fmt/format.h>

namespace gnomon::app {
namespace {

constexpr double kMiB = 1024.0 * 1024.0;

void printPasses(const renderer::FrameReport& report) {
    if (report.passes.empty()) {
        fmt::print("\nThis device measures no times.\n");
        return;
    }
    fmt::print("\n{:<28} {:<8} {:>10}\n", "Pass", "kind", "ms");
    for (const TimelineRow& pass : report.passes)
        fmt::print("{:<28} {:<8} {:>10.3f}\n", pass.name, kindName(pass.kind), pass.milliseconds());
    const Totals totals = totalsOf(report.passes);
    fmt::print("{:<28} {:<8} {:>10.3f}\n", "all drawing", "", totals.drawing);
    fmt::print("{:<28} {:<8} {:>10.3f}\n", "all compute (no statistics)", "", totals.compute);
    fmt::print("{:<28} {:<8} {:>10.3f}\n", "prepare", "CPU", report.statistics.prepareMilliseconds);
}

void printMemory(const FrameResult& result) {
    std::uint64_t library = 0, renderer = 0;
    fmt::print("\n{:<28} {:<8} {:>10} {:>7}\n", "Memory", "of", "MiB", "copies");
    for (const renderer::MemoryUseRow& row : result.memory) {
        (row.library ? library : renderer) += row.bytes * row.copies;
        fmt::print("{:<28} {:<8} {:>10.3f} {:>7}\n", row.name, row.library ? "library" : "renderer",
                   static_cast<double>(row.bytes) / kMiB, row.copies);
    }
    fmt::print("{:<28} {:<8} {:>10.3f}\n", "all", "library", static_cast<double>(library) / kMiB);
    fmt::print("{:<28} {:<8} {:>10.3f}\n", "all", "renderer", static_cast<double>(renderer) / kMiB);
}

void printCounters(const FrameResult& result, LightLists lists) {
    const FrameStatistics& s = result.report.statistics;
    const renderer::FrameReport& r = result.report;
    fmt::print("\nLights: {} given, {} visible, {} casting, {} directional, {} dropped.\n", s.lights.given,
               s.lights.visible, s.lights.casting, s.lights.directional, s.lights.dropped);
    fmt::print("Lights per tile with geometry, by {}: {:.2f}, shadowed {:.2f}; most in a tile {}.\n",
               lists == LightLists::Froxel ? "froxel" : "pixel", meanPerTile(s.earlyEntries, s),
               meanPerTile(s.earlyCastingEntries, s), s.maxLightsInTile);
    fmt::print("List entries: {} of {}; tiles without space: {}.\n", s.listEntries, s.listCapacity,
               s.listOverflowTiles);
    fmt::print("Visibility slots: {} of {}; entries without one: {}.\n", s.visibilitySlots, s.slotCapacity,
               s.slotOverflowEntries);
    fmt::print("Tiles shaded with shadowmaps: {}. Tiles where accurate exceeds approximate: {}.\n", s.evaluateTiles,
               s.accurateExceedsApproximate);
    fmt::print(
        "Shadow views: {} in an atlas of {} px, {} drawn this frame ({} triangles); lights shrunk {}, without room "
        "{}.\n",
        r.shadowViews, r.atlasSizePx, r.shadowViewsDrawn, r.shadowTrianglesDrawn, r.shadowLightsShrunk,
        r.shadowLightsDropped);
}

void printAdvice(const FrameResult& result) {
    const FrameStatistics& s = result.report.statistics;
    if (result.library.poolsCapped)
        fmt::print("The device's largest storage buffer caps the pools: they are smaller than asked for.\n");
    if (s.listOverflowTiles != 0 || s.slotOverflowEntries != 0)
        fmt::print(
            "The pools were too small for this frame, and what found no space was evaluated while lighting: "
            "--list-entries {} --visibility-slots {} would hold it.\n",
            s.recommendedListEntries, s.recommendedVisibilitySlots);
    if (s.lights.dropped != 0) fmt::print("{} visible lights were dropped: a view holds 1024.\n", s.lights.dropped);
    if (result.report.shadowLightsDropped != 0)
        fmt::print("{} lights cast no shadow for want of room in the atlas: a larger --atlas would hold them.\n",
                   result.report.shadowLightsDropped);
}

}  // namespace

const char* phaseName(Phase phase) {
    switch (phase) {
        case Phase::Host:
            return "host";
        case Phase::HierarchicalDepth:
            return "hierarchical depth";
        case Phase::FindLightsApproximate:
            return "find lights approximate";
        case Phase::FindLightsAccurate:
            return "find lights accurate";
        case Phase::ShadowBounds:
            return "shadow bounds";
        case Phase::GenerateShadows:
            return "generate shadows";
        case Phase::Closeups:
            return "closeups";
        case Phase::Lighting:
            return "lighting";
        case Phase::Statistics:
            return "statistics";
    }
    return "";
}

const char* kindName(RowKind kind) {
    switch (kind) {
        case RowKind::Compute:
            return "compute";
        case RowKind::Drawing:
            return "drawing";
        case RowKind::Transfer:
            return "transfer";
    }
    return "";
}

Totals totalsOf(const std::vector<TimelineRow>& passes) {
    Totals totals;
    for (const TimelineRow& pass : passes) {
        if (pass.phase == Phase::Statistics) continue;
        (pass.kind == RowKind::Drawing ? totals.drawing : totals.compute) += pass.milliseconds();
        if (pass.phase == Phase::Lighting) totals.lighting += pass.milliseconds();
    }
    return totals;
}

double meanPerTile(std::uint32_t entries, const FrameStatistics& statistics) {
    return statistics.tilesWithGeometry == 0 ? 0.0 : static_cast<double>(entries) / statistics.tilesWithGeometry;
}

void printFrame(const Session& session, const FrameResult& result) {
    const Settings& settings = session.settings();
    const renderer::FrameSettings& desc = session.rendererDesc().frame;
    fmt::print("{}, {}x{}, shadows {} ({}), {}\n", settings.scene, desc.widthPx, desc.heightPx, result.shadows,
               settings.filter, session.device().info().name);
    printPasses(result.report);
    printMemory(result);
    printCounters(result, desc.shadows.lightLists);
    printAdvice(result);
    if (result.clippedPixels != 0)
        fmt::print("{} pixels are brighter than {:g}, the most that the picture holds: they are clipped{}.\n",
                   result.clippedPixels, result.brightest,
                   result.brightest > renderer::kBrightestHalf ? "" : " (--exr FILE --exr-type float keeps them)");
    if (!result.hash.empty()) fmt::print("Picture {}, exposed for EV100 {:.2f}.\n", result.hash, result.exposureEv100);
}

}  // namespace gnomon::app
