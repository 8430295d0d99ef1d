// The search's outcome against every combination of what is too close to call.
#include <gtest/gtest.h>

#include "reference/blocker_search.h"
#include "reference/test_scene.h"

namespace gnomon::reference {
namespace {

/// One way in which everything may be decided.
struct Decided {
    int texels = 0, occluding = 0, blockers = 0;
    double least = 0, greatest = 0;  // sums of depths
};

/// Outcomes of all combinations, the slow way.
struct Everything {
    bool dark = false, lit = false, partial = false;
    double least = 2, greatest = -1;

    void decide(const std::vector<SearchTap>& taps, std::size_t tap, const SearchAlternative* rest, std::size_t texel,
                Decided d) {
        if (rest != nullptr && texel < rest->size()) {
            const SearchTexel& t = (*rest)[texel];
            d.texels += t.count;
            if (t.mayBeLit()) decide(taps, tap, rest, texel + 1, d);
            if (!t.mayOcclude()) return;
            d.occluding += t.count;
            if (t.inRegion != Verdict::Must) decide(taps, tap, rest, texel + 1, d);
            if (t.inRegion == Verdict::Never) return;
            d.blockers += t.count;
            d.least += t.count * t.depth.lo;
            d.greatest += t.count * t.depth.hi;
            decide(taps, tap, rest, texel + 1, d);
        } else if (tap < taps.size()) {
            for (const SearchAlternative& a : taps[tap].alternatives) decide(taps, tap + 1, &a, 0, d);
        } else if (d.occluding == d.texels) {
            dark = true;
        } else if (d.blockers == 0) {
            lit = true;
        } else {
            partial = true;
            least = std::min(least, d.least / d.blockers);
            greatest = std::max(greatest, d.greatest / d.blockers);
        }
    }
};

Verdict anyVerdict(Random& random, double may) {
    if (random.chance(may)) return Verdict::May;
    return random.chance(0.5) ? Verdict::Must : Verdict::Never;
}

TEST(BlockerSearch, AgreesWithEveryCombination) {
    Random random(5);
    int partial = 0, dark = 0, lit = 0, several = 0;
    for (int i = 0; i < 4000; ++i) {
        const double may = random.uniform(0, 0.6);
        std::vector<SearchTap> taps(1 + random.below(3));
        for (SearchTap& tap : taps) {
            tap.alternatives.resize(random.chance(may) ? 2 : 1);
            for (SearchAlternative& alternative : tap.alternatives)
                for (std::uint32_t n = 1 + random.below(2); n > 0; --n) {
                    const double depth = random.uniform();
                    alternative.push_back({anyVerdict(random, may),
                                           anyVerdict(random, may),
                                           {depth, depth + (random.chance(0.3) ? 0.1 : 0.0)},
                                           random.chance(0.2) ? 4 : 1});
                }
        }
        Everything all;
        all.decide(taps, 0, nullptr, 0, {});
        const SearchOutcome outcome = searchOutcome(taps);
        // Never narrower than the truth.
        EXPECT_GE(outcome.mayBeDark, all.dark);
        EXPECT_GE(outcome.mayBeLit, all.lit);
        EXPECT_GE(outcome.mayBePartial, all.partial);
        if (all.partial) {
            EXPECT_LE(outcome.meanDepth.lo, all.least + 1e-12);
            EXPECT_GE(outcome.meanDepth.hi, all.greatest - 1e-12);
        }
        // Dark is told exactly; the others may count what cannot come together.
        EXPECT_EQ(outcome.mayBeDark, all.dark);
        partial += all.partial;
        dark += all.dark;
        lit += all.lit;
        several += all.partial + all.dark + all.lit > 1;
        if (may < 0.01) {
            EXPECT_EQ(outcome.mayBePartial, all.partial);
            EXPECT_EQ(outcome.mayBeLit, all.lit);
        }
    }
    EXPECT_GT(partial, 1000);
    EXPECT_GT(dark, 300);
    EXPECT_GT(lit, 300);
    EXPECT_GT(several, 300);
}

// With sure verdicts the mean is the mean.
TEST(BlockerSearch, SureOnesGiveOneMean) {
    const SearchTexel lit{Verdict::Must, Verdict::Never, 0.9};
    const SearchTexel blocker{Verdict::Never, Verdict::Must, 0.25}, four{Verdict::Never, Verdict::Must, 0.5, 4};
    const SearchOutcome outcome = searchOutcome({{{{lit, blocker}}}, {{{four}}}});
    EXPECT_TRUE(outcome.mayBePartial);
    EXPECT_FALSE(outcome.mayBeLit);
    EXPECT_FALSE(outcome.mayBeDark);
    EXPECT_DOUBLE_EQ(outcome.meanDepth.lo, 0.45);
    EXPECT_DOUBLE_EQ(outcome.meanDepth.hi, 0.45);
}

}  // namespace
}  // namespace gnomon::reference
