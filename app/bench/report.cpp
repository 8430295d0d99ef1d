#include "app/bench/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/build_info.h"

namespace gnomon::app {
namespace {

// The shadow filters' samples per pixel and light: what their shaders do (src/visibility). Lights take turns with the
// filters, and those with PCSS take turns with the presets, so each counts by its share.
FilterNeeds filterNeedsOf(const renderer::FrameSettings& settings) {
    FilterNeeds needs;
    const double share = 1.0 / static_cast<double>(settings.filters.size());
    const ShadowSettings& shadows = settings.shadows;
    for (const Filter filter : settings.filters) {
        const bool shared = filter == Filter::PcssShared;
        FilterWork& work = shared ? needs.byQuad : isSoft(filter) ? needs.byPixel : needs.byTile;
        work.share += share;
        if (filter == Filter::Hard) work.always.fetches += share;
        if (filter == Filter::Pcf) work.always.gathers += share * (shadows.pcfRadius + 1.0) * (shadows.pcfRadius + 1.0);
        if (!isSoft(filter)) continue;
        const double ofPreset = share / shadows.pcssPresetCount;
        for (std::uint32_t i = 0; i < shadows.pcssPresetCount; ++i) {
            work.always.scatteredGathers += ofPreset * shadows.pcssPresets[i].searchTaps / (shared ? 4.0 : 1.0);
            work.ifMixed.scatteredGathers += ofPreset * shadows.pcssPresets[i].filterTaps;
        }
    }
    return needs;
}

FrameCounts countsOf(const Session& session, const renderer::FrameReport& report) {
    const FrameStatistics& s = report.statistics;
    FrameCounts counts = frameCounts(session.rendererDesc().frame.widthPx, session.rendererDesc().frame.heightPx);
    counts.tilesWithGeometry = s.tilesWithGeometry;
    counts.visibleLights = s.lights.visible;
    counts.shadowViews = report.shadowViews;
    counts.earlyEntries = s.earlyEntries;
    counts.earlyCastingEntries = s.earlyCastingEntries;
    counts.finalEntries = s.finalEntries;
    counts.slots = s.finalSlotEntries;
    counts.listsByFroxel = session.rendererDesc().frame.shadows.lightLists == LightLists::Froxel;
    counts.slotBytes = 8.0 * session.rendererDesc().frame.shadows.visibilityBits;  // 64 pixels
    return counts;
}

struct Floor {
    PassNeed need;
    double ms = 0.0;
};
std::optional<Floor> floorOf(const Measurement& measured, const Variant& variant, const Variant::Row& pass) {
    if (!measured.rates) return std::nullopt;
    FrameCounts counts = countsOf(measured.session, variant.last().report);
    // Inline shading stores no slots, but has the same mixed tiles to filter.
    if (const Variant* deferred = find(measured.variants, "deferred"))
        counts.slots = deferred->last().report.statistics.finalSlotEntries;
    const std::optional<PassNeed> need =
        needOf(pass.name, counts, filterNeedsOf(measured.session.rendererDesc().frame));
    if (!need) return std::nullopt;
    return Floor{*need, floorMs(*need, *measured.rates)};
}

void printRow(const std::string& name, const char* kind, const std::vector<double>& milliseconds,
              const std::optional<double>& floor = std::nullopt) {
    const Spread spread = spreadOf(milliseconds);
    fmt::print("{:<28} {:<10} {:>10.4f} {:>10.4f} {:>10.4f}", name, kind, spread.median, spread.min, spread.p95);
    if (floor && *floor > 0.0) fmt::print(" {:>10.4f} {:>9.2f}", *floor, spread.median / *floor);
    fmt::print("\n");
}

void printVariant(const Measurement& measured, const Variant& variant) {
    fmt::print("\n{:<28} {:<10} {:>10} {:>10} {:>10}", "Shadows " + variant.name(), "kind", "median ms", "min", "p95");
    fmt::print("{}\n", measured.rates ? fmt::format(" {:>10} {:>9}", "floor ms", "ratio") : "");
    std::optional<double> all;
    for (const Variant::Row& row : variant.passes()) {
        const std::optional<Floor> floor = floorOf(measured, variant, row);
        if (floor) all = all.value_or(0.0) + floor->ms;
        printRow(row.name, row.phase == Phase::Statistics ? "statistics" : kindName(row.kind), row.milliseconds,
                 floor ? std::optional(floor->ms) : std::nullopt);
    }
    printRow("shadow phases and lighting", "compute", variant.compute(), all);
    printRow("all drawing", "drawing", variant.drawing());
    printRow("prepare", "CPU", variant.prepare());
}

struct Ratio {
    std::string name;
    double ofMedians = 0.0, ofRounds = 0.0;
};

// Against inline, the paper's "before", or else the first: what the comparison is for.
std::vector<Ratio> ratiosOf(const std::vector<Variant>& variants) {
    std::vector<Ratio> ratios;
    const Variant* before = find(variants, "inline");
    if (before == nullptr) before = &variants.front();
    if (spreadOf(before->compute()).median <= 0.0) return ratios;
    for (const Variant& variant : variants)
        if (&variant != before)
            ratios.push_back({variant.name() + "/" + before->name(),
                              spreadOf(variant.compute()).median / spreadOf(before->compute()).median,
                              medianRatio(variant, *before)});
    return ratios;
}

}  // namespace

void Variant::add(const renderer::FrameReport& report) {
    // A pass that some frames leave out takes no time in them.
    const std::size_t before = compute_.size();
    for (const TimelineRow& pass : report.passes) {
        auto row = std::find_if(passes_.begin(), passes_.end(), [&](const Row& r) { return r.name == pass.name; });
        if (row == passes_.end()) {
            const std::vector<double> none(before, 0.0);
            row = passes_.insert(row, {pass.name, pass.phase, pass.kind, none});
        }
        row->milliseconds.push_back(pass.milliseconds());
    }
    for (Row& row : passes_) row.milliseconds.resize(before + 1, 0.0);
    const Totals totals = totalsOf(report.passes);
    drawing_.push_back(totals.drawing);
    compute_.push_back(totals.compute);
    lighting_.push_back(totals.lighting);
    phases_.push_back(totals.compute - totals.lighting);
    prepare_.push_back(report.statistics.prepareMilliseconds);
    last_.report = report;
}

const Variant::Row* Variant::pass(const std::string& name) const {
    const auto found = std::ranges::find(passes_, name, &Row::name);
    return found == passes_.end() ? nullptr : &*found;
}

const Variant* find(const std::vector<Variant>& variants, const std::string& name) {
    const auto found = std::ranges::find(variants, name, &Variant::name);
    return found == variants.end() ? nullptr : &*found;
}

Json toJson(const std::vector<double>& milliseconds) {
    const Spread spread = spreadOf(milliseconds);
    return {{"medianMs", spread.median}, {"minMs", spread.min}, {"p95Ms", spread.p95}};
}

double medianRatio(const Variant& a, const Variant& b) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(a.compute().size(), b.compute().size()); ++i)
        if (b.compute()[i] > 0.0) ratios.push_back(a.compute()[i] / b.compute()[i]);
    return spreadOf(ratios).median;
}

const char* listsName(const Session& session) {
    const bool froxel = session.rendererDesc().frame.shadows.lightLists == LightLists::Froxel;
    return froxel ? "by froxel" : "by pixel";
}

static void printRates(const renderer::DeviceRates& rates) {
    fmt::print("Copies {:.0f} GB/s (read and written)\n", rates.bytesPerSecond * 1e-9);
    const auto print = [](const char* what, const renderer::SampleRates& of) {
        fmt::print("{} {:.1f} G/s coherent, {:.1f} G/s scattered\n", what, of.coherent * 1e-9, of.scattered * 1e-9);
    };
    print("Texel fetches", rates.fetches);
    print("Texture gathers", rates.gathers);
}

void printBench(const Measurement& measured) {
    const Session& session = measured.session;
    const std::vector<Variant>& variants = measured.variants;
    const FrameStatistics& s = variants.front().last().report.statistics;
    const renderer::FrameSettings& desc = session.rendererDesc().frame;
    fmt::print("{}\nDriver {}; commit {}\n", session.device().info().name, session.device().info().driver, commit());
    fmt::print(
        "{}, {}x{}, filter {}, {} lights, {} visible; per tile {} {:.2f} lights, {:.2f} shadowed; {} frames each\n",
        session.settings().scene, desc.widthPx, desc.heightPx, session.settings().filter, s.lights.given,
        s.lights.visible, listsName(session), meanPerTile(s.earlyEntries, s), meanPerTile(s.earlyCastingEntries, s),
        variants.front().compute().size());
    if (measured.rates) printRates(*measured.rates);
    for (const Variant& variant : variants) printVariant(measured, variant);
    fmt::print("\n");
    for (const Ratio& ratio : ratiosOf(variants))
        fmt::print("{}: {:.3f} of medians, {:.3f} median over rounds\n", ratio.name, ratio.ofMedians, ratio.ofRounds);
}

static Json passesOf(const Measurement& measured, const Variant& variant) {
    Json passes = Json::object();
    for (const Variant::Row& row : variant.passes()) {
        Json& pass = passes[row.name];
        pass = toJson(row.milliseconds);
        pass.update(sortOf(row.phase, row.kind));
        if (const std::optional<Floor> floor = floorOf(measured, variant, row)) {
            pass["floor"] = {{"bytes", floor->need.bytes},
                             {"fetches", floor->need.fetches},
                             {"gathers", floor->need.gathers},
                             {"scatteredGathers", floor->need.scatteredGathers},
                             {"ms", floor->ms},
                             {"ratio", spreadOf(row.milliseconds).median / floor->ms}};
        }
    }
    return passes;
}

Json describeBench(const Measurement& measured) {
    const std::vector<Variant>& variants = measured.variants;
    Json out = describe(measured.session);
    const FrameStatistics& s = variants.front().last().report.statistics;
    out["lightsGiven"] = s.lights.given;
    out["lightsVisible"] = s.lights.visible;
    out["meanLightsPerTile"] = meanPerTile(s.earlyEntries, s);
    out["meanShadowedLightsPerTile"] = meanPerTile(s.earlyCastingEntries, s);
    if (measured.byPixel)
        out["meanShadowedLightsPerTileByPixel"] = meanPerTile(measured.byPixel->earlyCastingEntries, *measured.byPixel);
    out["warmUp"] = measured.warmUp;
    out["frames"] = variants.front().compute().size();
    out["framesPerSecond"] = measured.framesPerSecond;
    if (measured.rates)
        out["rates"] = {{"copyBytesPerSecond", measured.rates->bytesPerSecond},
                        {"coherentFetchesPerSecond", measured.rates->fetches.coherent},
                        {"scatteredFetchesPerSecond", measured.rates->fetches.scattered},
                        {"coherentGathersPerSecond", measured.rates->gathers.coherent},
                        {"scatteredGathersPerSecond", measured.rates->gathers.scattered}};
    for (const Variant& variant : variants) {
        out["variants"][variant.name()] = {{"shadowPhasesAndLighting", toJson(variant.compute())},
                                           {"shadowPhases", toJson(variant.phases())},
                                           {"lighting", toJson(variant.lighting())},
                                           {"drawing", toJson(variant.drawing())},
                                           {"prepareCpu", toJson(variant.prepare())},
                                           {"passes", passesOf(measured, variant)},
                                           {"counters", countersOf(variant.last())}};
    }
    out["ratios"] = Json::object();
    for (const Ratio& ratio : ratiosOf(variants))
        out["ratios"][ratio.name] = {{"ofMedians", ratio.ofMedians}, {"medianOverRounds", ratio.ofRounds}};
    return out;
}

}  // namespace gnomon::app
