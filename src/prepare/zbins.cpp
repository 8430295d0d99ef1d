// zBins. Source: the paper, section 2.1.1. Binning sorted lights by depth is also known from Drobot, "Improved Culling
// for Tiled and Clustered Rendering" (2017); the ranged table is the paper's.
//
// Problem: reject lights by depth with two look-ups. Lights are sorted by nearest depth, so a slice of depth needs the
// lowest and the highest index only. For a range of slices, the two end slices do not do: a light may lie wholly
// between them. So there is a second, *ranged* table. Per slice it holds the lowest index of this and all later slices,
// and the highest of this and all earlier ones. Then rangedMin[first] and rangedMax[last] enclose every light that
// meets the range.
//
// Plain way: every light visits every bin of its depth range. That is 1024 x 1024 steps where all ranges are long.
// What we do: a bin takes its minimum from the first light that reaches it and its maximum from the last one. So once
// painted it is done. Lights paint in ascending order (minimum), then in descending order (maximum). They skip painted
// bins by a chain of "next unpainted" links that is shortened as it is walked. That is about 1024 + 1024 steps each.
//
// Rounding: the shader computes int(floor((depth - near) * binsPerMetre)), clamped, in float. Depth ranges come rounded
// outward by 1e-5 of themselves, which covers depth's own error. The product and the rounded binsPerMetre add up to
// 1024 * 3 * 2^-24 = 2e-4 of a bin. Every range is widened by 1e-3 of a bin.
//
// Limits: bins are uniform, so one light that reaches very far makes all bins thick. Directional lights stand outside.

#include "prepare/zbins.h"

#include <algorithm>
#include <cmath>

#include "gpu_interface/packing.h"

namespace gnomon::prepare {
namespace {

constexpr double kBinSlack = 1e-3;  // bins

struct BinRange {
    std::uint32_t first, last;
};

BinRange binsOf(const DepthRange& depth, const ZBinLayout& layout) {
    const auto bin = [&](double metres, double slack) {
        const double b = (metres - layout.nearDepth) * layout.binsPerMetre + slack;
        // Clamped first: truncation is floor for what is not negative.
        return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::clamp(b, 0.0, gpu::kZBinCount - 1.0)));
    };
    return {bin(depth.nearest, -kBinSlack), bin(depth.farthest, kBinSlack)};
}

// Bins that are painted once each.
class Canvas {
public:
    Canvas() {
        for (std::uint32_t b = 0; b <= gpu::kZBinCount; ++b) next_[b] = b;
    }
    template <class Paint>
    void paint(BinRange range, Paint&& paintBin) {
        for (std::uint32_t b = unpaintedFrom(range.first); b <= range.last; b = unpaintedFrom(b)) {
            paintBin(b);
            next_[b] = b + 1;
        }
    }

private:
    // First unpainted bin at or after b; kZBinCount where there is none.
    std::uint32_t unpaintedFrom(std::uint32_t b) {
        while (next_[b] != b) {
            next_[b] = next_[next_[b]];
            b = next_[b];
        }
        return b;
    }
    std::array<std::uint32_t, gpu::kZBinCount + 1> next_;
};

}  // namespace

ZBinLayout layOutZBins(std::span<const DepthRange> depths, double nearMetres, double farMetres) noexcept {
    ZBinLayout layout;
    layout.nearDepth = static_cast<float>(nearMetres);
    layout.farthestReach = layout.nearDepth;
    if (depths.empty()) return layout;
    double reach = nearMetres;
    for (const DepthRange& depth : depths) reach = std::max(reach, depth.farthest);
    reach = std::min(reach, farMetres);
    // Rounded outward, and never so thin that a float cannot tell near from reach.
    const double thinnest = nearMetres * (1 + 1e-3) + 1e-3;
    reach = std::max(reach * (1 + 1e-6), thinnest);
    layout.farthestReach = static_cast<float>(reach);
    layout.binsPerMetre = static_cast<float>(gpu::kZBinCount / (reach - nearMetres));
    return layout;
}

std::array<std::uint32_t, gpu::kZBinWords> buildZBins(std::span<const DepthRange> depths, std::uint32_t firstIndex,
                                                      const ZBinLayout& layout) noexcept {
    constexpr std::uint32_t kNone = 0xFFFFu;
    std::array<std::uint32_t, gpu::kZBinCount> lowest, highest;
    lowest.fill(kNone);
    highest.fill(0);
    const auto count = static_cast<std::uint32_t>(depths.size());
    std::array<BinRange, gpu::kMaxLightsPerView> ranges;
    Canvas ascending, descending;
    for (std::uint32_t i = 0; i < count; ++i) {
        ranges[i] = binsOf(depths[i], layout);
        ascending.paint(ranges[i], [&](std::uint32_t b) { lowest[b] = firstIndex + i; });
    }
    for (std::uint32_t i = count; i-- > 0;) {
        descending.paint(ranges[i], [&](std::uint32_t b) { highest[b] = firstIndex + i; });
    }

    std::array<std::uint32_t, gpu::kZBinWords> words;
    for (std::uint32_t b = 0; b < gpu::kZBinCount; ++b) words[b] = gpu::packZBin(lowest[b], highest[b]);
    for (std::uint32_t b = gpu::kZBinCount - 1; b-- > 0;) lowest[b] = std::min(lowest[b], lowest[b + 1]);
    for (std::uint32_t b = 1; b < gpu::kZBinCount; ++b) highest[b] = std::max(highest[b], highest[b - 1]);
    for (std::uint32_t b = 0; b < gpu::kZBinCount; ++b) {
        words[gpu::kZBinCount + b] = gpu::packZBin(lowest[b], highest[b]);
    }
    return words;
}

}  // namespace gnomon::prepare
