#include "app/bench/spread.h"

#include <algorithm>
#include <cmath>

namespace gnomon::app {
namespace {

double percentile(const std::vector<double>& sorted, double share) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
    return sorted[std::max<std::size_t>(rank, 1) - 1];
}

}  // namespace

Spread spreadOf(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    return {percentile(values, 0.5), values.front(), percentile(values, 0.95)};
}

}  // namespace gnomon::app
