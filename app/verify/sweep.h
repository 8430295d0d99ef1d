#pragma once
// `verify --sweep`: the chosen depth bias beside all others, each judged against the same truth.

#include <string>
#include <vector>

#include "app/frame_json.h"
#include "truth/figures.h"

namespace gnomon::app {

/// A way to bias depths.
struct BiasSetting {
    std::string bias;                    ///< as --bias has it
    double constant = 0.0, slope = 0.0;  ///< factors that shadowmaps are drawn with
};
BiasSetting chosenSetting(const std::string& bias, const renderer::FrameSettings& settings);

struct SweptSetting {
    BiasSetting setting;
    renderer::LightFigures figures;  ///< of all lights
};

/// What --sweep-constants and --sweep-slopes say: numbers from 0 to `most`, parted by commas. Throws UsageError.
std::vector<double> parseSweepNumbers(const std::string& text, const char* what, double most);

/// Oriented, paper and none, but not `chosen` again, and then every constant with every slope.
std::vector<BiasSetting> settingsOfSweep(const std::string& chosen, const std::vector<double>& constants,
                                         const std::vector<double>& slopes);

renderer::FrameSettings withBias(renderer::FrameSettings settings, const BiasSetting& setting);
std::string nameOf(const BiasSetting& setting);

/// Of the hardware settings (none is one of them), and how many times as many pairs it has wrong as the first setting.
struct SweepBest {
    std::size_t index = 0;  ///< in the sweep
    std::uint64_t wrong = 0, firstWrong = 0;
    bool againstOnePair = false;  ///< the first setting has none wrong: the ratio is that to one pair
    [[nodiscard]] double ratio() const;
};
/// By acne and leak, and, where `contacts`, contact leak too. The sweep must have a hardware setting.
SweepBest bestOfSweep(const std::vector<SweptSetting>& sweep, bool contacts);

void printSweep(const std::vector<SweptSetting>& sweep);
/// Adds sweep, sweepBest, sweepBestWithContacts and ratio.
void describeSweep(const std::vector<SweptSetting>& sweep, Json& out);

}  // namespace gnomon::app
