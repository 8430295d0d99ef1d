// See blocker_search.h.
#include "reference/blocker_search.h"

namespace gnomon::reference {
namespace {

/// Blockers chosen: the sum of their depths, and how many.
struct Chosen {
    double sum = 0, count = 0;
    [[nodiscard]] double above(double mean) const { return sum - mean * count; }
};

/// The choice within one alternative that makes sum - mean * count least.
Chosen bestOf(const SearchAlternative& alternative, double sign, double mean) {
    Chosen chosen;
    for (const SearchTexel& texel : alternative) {
        const double depth = sign > 0 ? texel.depth.lo : -texel.depth.hi;
        if (!texel.surelyBlocks() && !(texel.mayBlock() && depth < mean)) continue;
        chosen.sum += depth * texel.count;
        chosen.count += texel.count;
    }
    return chosen;
}

Chosen bestOf(const std::vector<SearchTap>& taps, double sign, double mean) {
    Chosen all;
    for (const SearchTap& tap : taps) {
        Chosen best = bestOf(tap.alternatives.front(), sign, mean);
        for (const SearchAlternative& alternative : tap.alternatives) {
            const Chosen other = bestOf(alternative, sign, mean);
            if (other.above(mean) < best.above(mean)) best = other;
        }
        all.sum += best.sum;
        all.count += best.count;
    }
    return all;
}

/// Least mean depth (sign 1), or minus the greatest (sign -1). Some texel may block.
double leastMean(const std::vector<SearchTap>& taps, double sign) {
    constexpr int kMaxSteps = 100;
    double mean = 2.0;  // above every depth: the first choice has all blockers of some alternatives, at least one
    for (int step = 0; step < kMaxSteps; ++step) {
        const Chosen chosen = bestOf(taps, sign, mean);
        if (chosen.count == 0 || !(chosen.sum < mean * chosen.count)) break;
        mean = chosen.sum / chosen.count;
    }
    return mean;
}

}  // namespace

SearchOutcome searchOutcome(const std::vector<SearchTap>& taps) {
    SearchOutcome outcome;
    outcome.mayBeDark = outcome.mayBeLit = true;
    int mayBlock = 0, mayBeLit = 0, mayBeEither = 0;
    for (const SearchTap& tap : taps) {
        bool mayAllOcclude = false, mayNoneBlock = false;
        for (const SearchAlternative& alternative : tap.alternatives) {
            bool allOcclude = true, noneBlocks = true;
            for (const SearchTexel& texel : alternative) {
                allOcclude = allOcclude && texel.mayOcclude();
                noneBlocks = noneBlocks && !texel.surelyBlocks();
                mayBlock += texel.mayBlock();
                mayBeLit += texel.mayBeLit();
                mayBeEither += texel.mayBlock() && texel.mayBeLit();
            }
            mayAllOcclude = mayAllOcclude || allOcclude;
            mayNoneBlock = mayNoneBlock || noneBlocks;
        }
        outcome.mayBeDark = outcome.mayBeDark && mayAllOcclude;
        outcome.mayBeLit = outcome.mayBeLit && mayNoneBlock;
    }
    outcome.mayBeLit = outcome.mayBeLit && mayBeLit > 0;
    // A texel to block and a texel to be lit: one and the same cannot be both.
    outcome.mayBePartial = mayBlock > 0 && mayBeLit > 0 && !(mayBlock == 1 && mayBeLit == 1 && mayBeEither == 1);
    if (outcome.mayBePartial) outcome.meanDepth = {leastMean(taps, 1.0), -leastMean(taps, -1.0)};
    return outcome;
}

}  // namespace gnomon::reference
