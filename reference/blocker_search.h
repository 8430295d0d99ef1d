#pragma once
// What a search for blockers may come to, where some of its texels are too close to call.
//
// Problem: a texel may or may not occlude, may or may not be a blocker; a tap may take these four texels or those.
// Taken together that is more combinations than can be tried.
//
// What: each tap has alternatives, each of them a few texels. Whether all occlude, or none blocks, is asked of the
// alternatives one tap at a time. The least mean depth is a quotient (sum of depths) / (number of blockers) over
// choices that do not hinder each other, so Dinkelbach's method finds it: choose what makes sum - mean * number least,
// take the mean of that, repeat until it falls no more.

#include <vector>

#include "reference/interval.h"

namespace gnomon::reference {

struct SearchTexel {
    Verdict lit = Verdict::Must;
    Verdict inRegion = Verdict::Never;  ///< asked where it is not lit
    Interval depth;                     ///< device depth, in the receiver's view
    int count = 1;                      ///< a texel that stands for this many

    [[nodiscard]] bool mayBeLit() const { return lit != Verdict::Never; }
    [[nodiscard]] bool mayOcclude() const { return lit != Verdict::Must; }
    [[nodiscard]] bool mayBlock() const { return mayOcclude() && inRegion != Verdict::Never; }
    [[nodiscard]] bool surelyBlocks() const { return lit == Verdict::Never && inRegion == Verdict::Must; }
};
using SearchAlternative = std::vector<SearchTexel>;
struct SearchTap {
    std::vector<SearchAlternative> alternatives;  ///< at least one
};

struct SearchOutcome {
    bool mayBeDark = false;     ///< all texels occlude
    bool mayBeLit = false;      ///< none is a blocker, and not all occlude
    bool mayBePartial = false;  ///< there are blockers, and not all texels occlude
    Interval meanDepth;         ///< of the blockers, then
};
SearchOutcome searchOutcome(const std::vector<SearchTap>& taps);

}  // namespace gnomon::reference
