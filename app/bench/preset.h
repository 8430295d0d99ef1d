#pragma once
// Tables of the paper, measured here: `gnomon bench --preset NAME`.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/bench/report.h"

namespace gnomon::app {

/// Names that --preset knows.
const std::vector<std::string>& presetNames();

/// Sets scene, size, filter and variants as the preset wants them, apart from those that the command line gives:
/// `given` says so of an option.
void applyPreset(const std::string& preset, const std::function<bool(const char*)>& given, Settings& settings,
                 std::vector<std::string>& variants);
/// Throws UsageError where the preset's table cannot be made of these variants.
void checkPreset(const std::string& preset, const std::vector<std::string>& variants);

void printPreset(const std::string& preset, const Measurement& measured);
/// All times as JSON, with the preset's table where there is one.
void writeMeasurement(const Measurement& measured, const std::string& preset, const std::filesystem::path& file);

}  // namespace gnomon::app
