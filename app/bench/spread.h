#pragma once
// Many measured values in three.

#include <vector>

namespace gnomon::app {

struct Spread {
    double median = 0.0, min = 0.0, p95 = 0.0;
};
/// Nearest-rank percentiles; zeros without values.
Spread spreadOf(std::vector<double> values);

}  // namespace gnomon::app
