// zBins against the plain way: every light visits every bin.

#include <algorithm>

#include "src/prepare/zbins.h"
#include "unit/prepare/scenes.h"

namespace gnomon::test {
namespace {

using prepare::DepthRange;

TEST(ZBins, EqualThePlainWay) {
    for (int trial = 0; trial < 100; ++trial) {
        Random random(trial);
        const int count = trial == 0 ? 0 : static_cast<int>(random() % 1024) + 1;
        const double reach = std::pow(10.0, uniform(random, -1, 4));
        std::vector<DepthRange> depths;
        for (int i = 0; i < count; ++i) {
            const double nearest = uniform(random, -0.2 * reach, reach);
            depths.push_back({nearest, std::max(0.2, nearest + reach * uniform(random, 0, trial % 2 == 0 ? 0.01 : 1))});
        }
        // Only nearly sorted, as rounding may leave them.
        std::sort(depths.begin(), depths.end(), [](auto a, auto b) { return a.nearest < b.nearest; });
        for (int i = 1; i < count; i += 7)
            std::swap(depths[static_cast<std::size_t>(i)], depths[static_cast<std::size_t>(i - 1)]);
        const std::uint32_t first = random() % 3;
        const auto layout = prepare::layOutZBins(depths, 0.1, trial % 3 == 0 ? reach : 1e30);
        const auto words = prepare::buildZBins(depths, first, layout);

        std::vector<std::uint32_t> low(1024, 0xFFFF), high(1024, 0);
        for (std::uint32_t i = 0; i < depths.size(); ++i) {
            const auto bin = [&](double metres, double slack) {
                return std::clamp(std::floor((metres - layout.nearDepth) * layout.binsPerMetre + slack), 0.0, 1023.0);
            };
            for (double b = bin(depths[i].nearest, -1e-3); b <= bin(depths[i].farthest, 1e-3); ++b) {
                auto& l = low[static_cast<std::size_t>(b)];
                auto& h = high[static_cast<std::size_t>(b)];
                l = std::min(l, first + i), h = std::max(h, first + i);
            }
        }
        for (std::uint32_t b = 0; b < 1024; ++b) {
            ASSERT_EQ(words[b], gpu::packZBin(low[b], high[b])) << "trial " << trial << " bin " << b;
            ASSERT_EQ(gpu::zBinMin(words[1024 + b]), *std::min_element(low.begin() + b, low.end()));
            ASSERT_EQ(gpu::zBinMax(words[1024 + b]), *std::max_element(high.begin(), high.begin() + b + 1));
        }
    }
}

// The paper's figures 3a and 3b: a light between the two ends of a range.
TEST(ZBins, RangedHoldsLightsBetweenTheEnds) {
    const std::vector<DepthRange> depths = {{1, 2}, {5, 6}, {9, 10}};
    const auto layout = prepare::layOutZBins(depths, 0, 1e30);
    const auto words = prepare::buildZBins(depths, 0, layout);
    const auto bin = [&](double depth) { return static_cast<std::uint32_t>(depth * layout.binsPerMetre); };
    EXPECT_EQ(words[bin(3)], gpu::kZBinEmpty);
    EXPECT_EQ(words[bin(5.5)], gpu::packZBin(1, 1));
    EXPECT_EQ(gpu::zBinMin(words[1024 + bin(3)]), 1u);
    EXPECT_EQ(gpu::zBinMax(words[1024 + bin(8)]), 1u);
    EXPECT_EQ(gpu::zBinMin(words[1024 + bin(0.5)]), 0u);
    EXPECT_EQ(gpu::zBinMax(words[1024 + bin(9.9)]), 2u);
}

TEST(ZBins, SpanFromNearToTheFarthestReach) {
    const std::vector<DepthRange> depths = {{-3, 2}, {5, 60}};
    const auto open = prepare::layOutZBins(depths, 0.5, std::numeric_limits<double>::infinity());
    EXPECT_EQ(open.nearDepth, 0.5f);
    EXPECT_GE(open.farthestReach, 60.0f);
    EXPECT_NEAR(open.farthestReach, 60, 0.001);
    EXPECT_NEAR(open.binsPerMetre, 1024 / 59.5, 1e-3);
    EXPECT_NEAR(prepare::layOutZBins(depths, 0.5, 20).farthestReach, 20, 0.001);
    const std::vector<DepthRange> thin = {{0.4, 0.5}};
    EXPECT_TRUE(std::isfinite(prepare::layOutZBins(thin, 0.5, 20).binsPerMetre));
    EXPECT_EQ(prepare::layOutZBins({}, 0.5, 20).binsPerMetre, 0.0f);
}

// Bins must also be of use: a short light is in few of them.
TEST(ZBins, AreTight) {
    Light light;
    light.position[2] = -50, light.rangeMetres = 5;
    Light far = light;
    far.position[2] = -95;
    const Prepared p = runOnce(makeCamera({}), 640, 360, {light, far});
    ASSERT_TRUE(p.result.ok()) << p.result.message();
    int bins = 0;
    for (std::uint32_t b = 0; b < 1024; ++b) bins += gpu::zBinMin(p.zBins[b]) == 0 ? 1 : 0;
    EXPECT_NEAR(bins, 102, 3);
}

}  // namespace
}  // namespace gnomon::test
