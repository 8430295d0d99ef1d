#pragma once
// One frame in a table for people, on stdout.

#include "app/session.h"

namespace gnomon::app {

struct FrameResult {
    std::string shadows;  // deferred, inline or off
    renderer::FrameReport report;
    std::vector<renderer::MemoryUseRow> memory;
    MemoryReport library;
    std::string hash;  // of the tone-mapped picture; empty if there is none
    float exposureEv100 = 0.0f;
    float brightest = renderer::kBrightestHalf;     // that the picture holds
    std::uint64_t clippedPixels = 0;                // as bright as that
    std::uint64_t frames = 1;                       // rendered; the report is the last one's
    std::vector<std::vector<float>> cascadeBiases;  // metres; per light of the scene, empty for those without cascades
};

/// GPU milliseconds of one frame. The pass that only gathers statistics stands in no sum.
struct Totals {
    double drawing = 0.0, compute = 0.0;
    double lighting = 0.0;  // of compute
};
Totals totalsOf(const std::vector<TimelineRow>& passes);
const char* phaseName(Phase phase);
const char* kindName(RowKind kind);

/// Mean over the tiles that show geometry; 0 without any.
double meanPerTile(std::uint32_t entries, const FrameStatistics& statistics);

void printFrame(const Session& session, const FrameResult& result);

}  // namespace gnomon::app
