#pragma once
// Tables of the paper, measured here: `gnomon bench --preset NAME`.

#include <CLI/CLI.hpp>

#include "app/bench/report.h"

namespace gnomon::app {

/// Names that --preset knows.
const std::vector<std::string>& presetNames();

/// Sets scene, size, filter and variants as the preset wants them, apart from those that the command line gives.
void applyPreset(const std::string& preset, const CLI::App& command, Settings& settings,
                 std::vector<std::string>& variants);
/// Throws UsageError where the preset's table cannot be made of these variants.
void checkPreset(const std::string& preset, const std::vector<std::string>& variants);

void printPreset(const std::string& preset, const Measurement& measured);
Json describePreset(const std::string& preset, const Measurement& measured);

}  // namespace gnomon::app
