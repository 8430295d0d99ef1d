#include "app/verify/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <string_view>

#include "app/errors.h"
#include "app/verify/report.h"

namespace gnomon::app {
namespace {

using renderer::Figures;

constexpr std::size_t kMostNumbers = 64;

bool isHardware(const BiasSetting& setting) {
    return setting.bias == "hardware" || setting.bias == "none";
}

std::uint64_t wrongOf(const Figures& f, bool contacts) {
    return f.acne + f.leak + (contacts ? f.contactLeak : 0);
}

void printRow(const SweptSetting& row, const char* mark) {
    const Figures& f = row.figures.opaque;
    fmt::print("{:<24} {:>9} {:>9} {:>11} {:>11} {:>9}  {}\n", nameOf(row.setting), percent(f.share(f.acne)),
               percent(f.share(f.leak)), percent(f.share(f.acne + f.leak)), percent(f.share(f.contactLeak)),
               percent(f.share(f.edgeError)), mark);
}

void printBest(const std::vector<SweptSetting>& sweep, const SweepBest& best, const char* what) {
    const std::string ratio =
        best.againstOnePair ? fmt::format("{:.4g} times one pair; {} has none", best.ratio(), nameOf(sweep[0].setting))
                            : fmt::format("{:.4g} times {}'s", best.ratio(), nameOf(sweep[0].setting));
    fmt::print("Best hardware bias by {}: {}, {} % ({}).\n", what, nameOf(sweep[best.index].setting),
               percent(sweep[best.index].figures.opaque.share(best.wrong)), ratio);
}

Json describeBest(const std::vector<SweptSetting>& sweep, const SweepBest& best) {
    const SweptSetting& row = sweep[best.index];
    return {{"bias", row.setting.bias},
            {"constant", row.setting.constant},
            {"slope", row.setting.slope},
            {"wrong", row.figures.opaque.share(best.wrong)},
            {"wrongOfFirst", sweep[0].figures.opaque.share(best.firstWrong)},
            {"ratio", best.ratio()},
            {"ratioAgainstOnePair", best.againstOnePair}};
}

}  // namespace

std::vector<double> parseSweepNumbers(const std::string& text, const char* what, double most) {
    std::vector<double> numbers;
    const char *at = text.data(), *const end = at + text.size();
    for (bool more = true; more;) {
        double value = 0.0;
        const auto [next, error] = std::from_chars(at, end, value);
        more = next != end;
        if (error != std::errc() || !(value >= 0.0 && value <= most) || (more && *next != ',') ||
            numbers.size() == kMostNumbers)
            throw UsageError(fmt::format("'{}' are no {}: give up to {} numbers from 0 to {:g}, as in 0,1,2.5.", text,
                                         what, kMostNumbers, most));
        numbers.push_back(value);
        at = more ? next + 1 : end;
    }
    return numbers;
}

BiasSetting chosenSetting(const std::string& bias, const renderer::FrameSettings& settings) {
    const renderer::HardwareBias& drawn = settings.drawing.bias;
    return {bias, static_cast<double>(drawn.constantFactor), static_cast<double>(drawn.slopeFactor)};
}

std::vector<BiasSetting> settingsOfSweep(const std::string& chosen, const std::vector<double>& constants,
                                         const std::vector<double>& slopes) {
    std::vector<BiasSetting> settings;
    for (const char* bias : {"oriented", "paper", "none"})
        if (chosen != bias) settings.push_back(chosenSetting(bias, withBias({}, {bias})));
    for (const double constant : constants)
        for (const double slope : slopes)
            if (constant != 0.0 || slope != 0.0) settings.push_back({"hardware", constant, slope});
    return settings;
}

renderer::FrameSettings withBias(renderer::FrameSettings settings, const BiasSetting& setting) {
    setBias(setting.bias, settings);
    if (setting.bias == "hardware")
        settings.drawing.bias = {static_cast<float>(setting.constant), static_cast<float>(setting.slope), 0.0f};
    return settings;
}

std::string nameOf(const BiasSetting& setting) {
    if (setting.bias != "hardware") return setting.bias;
    return fmt::format("hardware {:g}, {:g}", setting.constant, setting.slope);
}

double SweepBest::ratio() const {
    return static_cast<double>(wrong) / static_cast<double>(std::max<std::uint64_t>(firstWrong, 1));
}

SweepBest bestOfSweep(const std::vector<SweptSetting>& sweep, bool contacts) {
    SweepBest best;
    best.wrong = ~0ull;
    for (std::size_t i = 0; i < sweep.size(); ++i) {
        const std::uint64_t wrong = wrongOf(sweep[i].figures.opaque, contacts);
        if (!isHardware(sweep[i].setting) || wrong >= best.wrong) continue;
        best.index = i;
        best.wrong = wrong;
    }
    best.firstWrong = wrongOf(sweep[0].figures.opaque, contacts);
    best.againstOnePair = best.firstWrong == 0;
    return best;
}

void printSweep(const std::vector<SweptSetting>& sweep) {
    const SweepBest best = bestOfSweep(sweep, false), withContacts = bestOfSweep(sweep, true);
    fmt::print("\n{:<24} {:>9} {:>9} {:>11} {:>11} {:>9}\n", "Bias", "acne %", "leak %", "acne+leak %", "contact %",
               "edge %");
    for (std::size_t i = 0; i < sweep.size(); ++i)
        printRow(sweep[i], i == best.index ? "< best hardware" : i == withContacts.index ? "< with contacts" : "");
    printBest(sweep, best, "acne and leak");
    printBest(sweep, withContacts, "acne, leak and contact leak");
}

void describeSweep(const std::vector<SweptSetting>& sweep, Json& out) {
    Json rows = Json::array();
    for (const SweptSetting& row : sweep) {
        Json figures = {{"bias", row.setting.bias}, {"constant", row.setting.constant}, {"slope", row.setting.slope}};
        figures.update(describe(row.figures));
        figures["subsurface"] = describe(row.figures.subsurface);
        rows.push_back(figures);
    }
    out["sweep"] = rows;
    out["sweepBest"] = describeBest(sweep, bestOfSweep(sweep, false));
    out["sweepBestWithContacts"] = describeBest(sweep, bestOfSweep(sweep, true));
    out["ratio"] = out["sweepBest"]["ratio"];
}

}  // namespace gnomon::app
