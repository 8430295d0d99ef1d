#include "app/bench_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/build_info.h"

namespace gnomon::app {
namespace {

double percentile(const std::vector<double>& sorted, double share) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
    return sorted[std::max<std::size_t>(rank, 1) - 1];
}

void printRow(const std::string& name, const char* kind, const std::vector<double>& milliseconds) {
    const Spread spread = spreadOf(milliseconds);
    fmt::print("{:<28} {:<10} {:>10.4f} {:>10.4f} {:>10.4f}\n", name, kind, spread.median, spread.min, spread.p95);
}

void printVariant(const Variant& variant) {
    fmt::print("\n{:<28} {:<10} {:>10} {:>10} {:>10}\n", "Shadows " + variant.name(), "kind", "median ms", "min",
               "p95");
    for (const Variant::Row& row : variant.passes())
        printRow(row.name, row.statistics ? "statistics" : row.drawing ? "drawing" : "compute", row.milliseconds);
    printRow("shadow phases and lighting", "compute", variant.compute());
    printRow("all drawing", "drawing", variant.drawing());
    printRow("prepare", "CPU", variant.prepare());
}

Json toJson(const std::vector<double>& milliseconds) {
    const Spread spread = spreadOf(milliseconds);
    return {{"medianMs", spread.median}, {"minMs", spread.min}, {"p95Ms", spread.p95}};
}

const Variant* find(const std::vector<Variant>& variants, const std::string& name) {
    const auto found =
        std::find_if(variants.begin(), variants.end(), [&](const Variant& v) { return v.name() == name; });
    return found == variants.end() ? nullptr : &*found;
}

struct Ratio {
    std::string name;
    double ofMedians = 0.0, ofRounds = 0.0;
};

// Against inline, the paper's "before": what the comparison is for.
std::vector<Ratio> ratiosOf(const std::vector<Variant>& variants) {
    std::vector<Ratio> ratios;
    const Variant* before = find(variants, "inline");
    if (before == nullptr || spreadOf(before->compute()).median <= 0.0) return ratios;
    for (const Variant& variant : variants)
        if (&variant != before)
            ratios.push_back({variant.name() + "/inline",
                              spreadOf(variant.compute()).median / spreadOf(before->compute()).median,
                              medianRatio(variant, *before)});
    return ratios;
}

}  // namespace

Spread spreadOf(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    return {percentile(values, 0.5), values.front(), percentile(values, 0.95)};
}

void Variant::add(const renderer::FrameReport& report) {
    for (const renderer::PassTime& pass : report.passes) {
        auto row = std::find_if(passes_.begin(), passes_.end(), [&](const Row& r) { return r.name == pass.name; });
        if (row == passes_.end()) row = passes_.insert(row, {pass.name, pass.drawing, isStatisticsPass(pass), {}});
        row->milliseconds.push_back(pass.milliseconds);
    }
    const Totals totals = totalsOf(report.passes);
    drawing_.push_back(totals.drawing);
    compute_.push_back(totals.compute);
    prepare_.push_back(report.statistics.prepareMilliseconds);
    last_.report = report;
}

double medianRatio(const Variant& a, const Variant& b) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(a.compute().size(), b.compute().size()); ++i)
        if (b.compute()[i] > 0.0) ratios.push_back(a.compute()[i] / b.compute()[i]);
    return spreadOf(ratios).median;
}

void printBench(const Session& session, const std::vector<Variant>& variants) {
    const FrameStatistics& s = variants.front().last().report.statistics;
    const renderer::RendererDesc& desc = session.rendererDesc();
    fmt::print("{}\nDriver {}; commit {}\n", session.device().info().name, session.device().info().driver, commit());
    fmt::print("{}, {}x{}, filter {}, {} lights, {} visible; per tile {:.2f} lights, {:.2f} shadowed; {} frames each\n",
               session.settings().scene, desc.widthPx, desc.heightPx, session.settings().filter, s.lights.given,
               s.lights.visible, meanPerTile(s.earlyEntries, s), meanPerTile(s.earlyCastingEntries, s),
               variants.front().compute().size());
    for (const Variant& variant : variants) printVariant(variant);
    fmt::print("\n");
    for (const Ratio& ratio : ratiosOf(variants))
        fmt::print("{}: {:.3f} of medians, {:.3f} median over rounds\n", ratio.name, ratio.ofMedians, ratio.ofRounds);
}

Json describeBench(const Session& session, const std::vector<Variant>& variants) {
    Json out = describe(session);
    const FrameStatistics& s = variants.front().last().report.statistics;
    out["lightsGiven"] = s.lights.given;
    out["lightsVisible"] = s.lights.visible;
    out["meanLightsPerTile"] = meanPerTile(s.earlyEntries, s);
    out["meanShadowedLightsPerTile"] = meanPerTile(s.earlyCastingEntries, s);
    out["frames"] = variants.front().compute().size();
    for (const Variant& variant : variants) {
        Json passes = Json::object();
        for (const Variant::Row& row : variant.passes()) {
            passes[row.name] = toJson(row.milliseconds);
            passes[row.name]["drawing"] = row.drawing;
        }
        out["variants"][variant.name()] = {{"shadowPhasesAndLighting", toJson(variant.compute())},
                                           {"drawing", toJson(variant.drawing())},
                                           {"prepareCpu", toJson(variant.prepare())},
                                           {"passes", passes},
                                           {"counters", countersOf(variant.last())}};
    }
    out["ratios"] = Json::object();
    for (const Ratio& ratio : ratiosOf(variants))
        out["ratios"][ratio.name] = {{"ofMedians", ratio.ofMedians}, {"medianOverRounds", ratio.ofRounds}};
    return out;
}

}  // namespace gnomon::app
