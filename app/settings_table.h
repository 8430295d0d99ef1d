#pragma once
// The one table of the program's settings: command line, JSON and docs follow from it. To add a setting: a row here, a
// member of Settings, and the code that uses it.

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "app/settings.h"

namespace gnomon::app {

/// Where a setting's value is.
using SettingMember = std::variant<std::string Settings::*, double Settings::*, float Settings::*,
                                   std::uint32_t Settings::*, std::uint64_t Settings::*, bool Settings::*>;

struct Setting {
    const char* group;  ///< heading in --help and docs
    const char* name;   ///< the option, without dashes
    const char* key;    ///< in JSON
    SettingMember member;
    std::string help;
    std::vector<std::string> choices;  ///< a value must be one of them, if there are any
    double least = 0.0, most = 0.0;    ///< of numbers, where there are no choices
    const char* needs = nullptr;       ///< another option, with dashes
    /// Where neither choices nor least and most say it: the sentence that says what is wrong, or nothing.
    std::function<std::string(const std::string&)> check;
    std::string range;  ///< in words, where the above do not say it
};

std::span<const Setting> settingsTable();

/// The value that a setting may have, in words.
std::string rangeOf(const Setting& setting);
/// The value that it has.
nlohmann::ordered_json valueOf(const Setting& setting, const Settings& settings);
/// A float's own shortest digits: 0.002, where the nearest double says 0.0020000000949949026.
double shortest(float value);
/// All of them, by key.
nlohmann::ordered_json valuesOf(const Settings& settings);
/// A page of Markdown: one table per group.
std::string settingsPage();

}  // namespace gnomon::app
