#pragma once
// Shadow filters by the names that files and the command line use.

#include <optional>
#include <string_view>

#include "gnomon/settings.h"

namespace gnomon {

struct FilterName {
    std::string_view name;
    Filter filter;
};
inline constexpr FilterName kFilterNames[] = {
    {"hard", Filter::Hard}, {"pcf", Filter::Pcf}, {"pcss", Filter::Pcss}, {"pcss-shared", Filter::PcssShared}};

constexpr std::optional<Filter> filterNamed(std::string_view name) noexcept {
    for (const FilterName& known : kFilterNames)
        if (known.name == name) return known.filter;
    return std::nullopt;
}

/// Empty for Filter::Host, which no file names.
constexpr std::string_view nameOf(Filter filter) noexcept {
    for (const FilterName& known : kFilterNames)
        if (known.filter == filter) return known.name;
    return {};
}

}  // namespace gnomon
