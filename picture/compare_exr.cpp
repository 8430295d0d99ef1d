#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "picture/exr.h"

namespace gnomon::renderer {
namespace {

constexpr double kInfinitelyFar = std::numeric_limits<double>::infinity();

std::string namesOf(const ExrPicture& picture) {
    std::string names;
    for (const ExrChannel& channel : picture.channels) names += (names.empty() ? "" : ", ") + channel.name;
    return names;
}

void requireAlike(const ExrPicture& a, const ExrPicture& b) {
    if (a.width != b.width || a.height != b.height)
        throw std::invalid_argument(
            fmt::format("The pictures differ in size: {}x{} and {}x{}.", a.width, a.height, b.width, b.height));
    if (!std::ranges::equal(a.channels, b.channels, {}, &ExrChannel::name, &ExrChannel::name))
        throw std::invalid_argument(fmt::format("The pictures differ in channels: {} and {}.", namesOf(a), namesOf(b)));
    if (a.left != b.left || a.top != b.top)
        throw std::invalid_argument(
            fmt::format("The pictures lie in different places: at {},{} and {},{}.", a.left, a.top, b.left, b.top));
}

/// Of two values of a channel: 0 where equal, NaN where one alone is a number.
double apart(double a, double b) {
    if (a == b || (std::isnan(a) && std::isnan(b))) return 0.0;
    return std::abs(a - b);
}

double relativelyApart(double a, double b, double absolute) {
    if (!std::isfinite(absolute)) return kInfinitelyFar;
    return absolute / std::max(std::abs(a), std::abs(b));
}

/// Adds a pixel's values. True where they differ.
bool add(double a, double b, ExrDifference& difference) {
    const double absolute = apart(a, b);
    if (absolute == 0.0) return false;
    ++difference.pixels;
    if (std::isnan(absolute)) {
        ++difference.notNumbers;
    } else {
        difference.largest = std::max(difference.largest, absolute);
        difference.largestRelative = std::max(difference.largestRelative, relativelyApart(a, b, absolute));
    }
    return true;
}

}  // namespace

ExrComparison compare(const ExrPicture& a, const ExrPicture& b) {
    requireAlike(a, b);
    ExrComparison out;
    for (const ExrChannel& channel : a.channels) out.channels.push_back({channel.name});
    const std::size_t pixels = std::size_t{a.width} * a.height;
    for (std::size_t p = 0; p < pixels; ++p) {
        bool differs = false, notNumber = false;
        for (std::size_t c = 0; c < a.channels.size(); ++c) {
            const std::uint64_t before = out.channels[c].notNumbers;
            differs |= add(a.channels[c].value(p), b.channels[c].value(p), out.channels[c]);
            notNumber |= out.channels[c].notNumbers != before;
        }
        out.all.pixels += differs ? 1 : 0;
        out.all.notNumbers += notNumber ? 1 : 0;
    }
    for (const ExrDifference& channel : out.channels) {
        if (channel.largest > out.all.largest) out.all.channel = channel.channel;
        out.all.largest = std::max(out.all.largest, channel.largest);
        out.all.largestRelative = std::max(out.all.largestRelative, channel.largestRelative);
    }
    return out;
}

ExrPicture differencePicture(const ExrPicture& a, const ExrPicture& b) {
    requireAlike(a, b);
    ExrPicture out{a.width, a.height, {}};
    for (std::size_t c = 0; c < a.channels.size(); ++c) {
        std::vector<float> values(std::size_t{a.width} * a.height);
        for (std::size_t p = 0; p < values.size(); ++p)
            values[p] = static_cast<float>(apart(a.channels[c].value(p), b.channels[c].value(p)));
        out.channels.push_back({a.channels[c].name, std::move(values), {}});
    }
    return out;
}

}  // namespace gnomon::renderer
