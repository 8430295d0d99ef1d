// What the measurement of texture rates reads. Its times are for benchmarks; but a rate is only true if every sample
// that counts is really taken, and that can be tested: the results follow from the depths in the texture.
#include <gtest/gtest.h>

#include <bit>

#include "gpu/renderer/device_test.h"
#include "renderer/rates/texture_rate.h"

namespace gnomon::renderer {
namespace {

class RatesTest : public DeviceTest {};

// Many samples; and more groups than there are tiles (124 by 124), so that tiles begin again.
constexpr SampleAmount kAmounts[] = {{200, 7}, {124 * 124 + 2, 1}};
constexpr std::uint32_t kLanes = 64;
constexpr SampleKind kKinds[] = {{false, false}, {false, true}, {true, false}, {true, true}};

std::string nameOf(SampleKind kind) {
    return std::string(kind.scattered ? "scattered " : "coherent ") + (kind.gathers ? "gathers" : "fetches");
}

std::uint32_t scrambled(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7FEB352Du;
    x ^= x >> 15;
    x *= 0x846CA68Bu;
    x ^= x >> 16;
    return x;
}

class Depths {
public:
    std::uint32_t bits(std::uint32_t x, std::uint32_t y) const {
        return std::bit_cast<std::uint32_t>(depths_.at(std::size_t{y} * 1024 + x));
    }
    std::uint32_t sample(SampleKind kind, std::uint32_t x, std::uint32_t y) const {
        if (!kind.gathers) return bits(x, y);
        return bits(x, y) ^ bits(x + 1, y) ^ bits(x, y + 1) ^ bits(x + 1, y + 1);
    }

private:
    std::vector<float> depths_ = TextureRate::depths();
};

std::uint32_t expectedOf(const Depths& depths, SampleKind kind, std::uint32_t rounds, std::uint32_t index) {
    const std::uint32_t group = index / kLanes, lane = index % kLanes;
    std::uint32_t x = 0, y = 0;  // in the tile: bits of the lane in turn
    for (std::uint32_t bit = 0; bit < 3; ++bit) {
        x |= (lane >> (2 * bit) & 1u) << bit;
        y |= (lane >> (2 * bit + 1) & 1u) << bit;
    }
    x += group % 124 * 8;
    y += group / 124 % 124 * 8;
    std::uint32_t place = scrambled(kind.scattered ? index : group);
    std::uint32_t bits = 0;
    for (std::uint32_t i = 0; i < 4 * rounds; ++i) {
        bits ^= depths.sample(kind, x + place / 0x8000000u, y + place / 2048u % 32u);
        place += 0x9E3779B9u;
    }
    return bits;
}

TEST_F(RatesTest, EverySampleIsTaken) {
    const Depths depths;
    for (const DeviceInfo& info : suitable()) {
        SCOPED_TRACE(info.name);
        const Device device(instance(), info);
        const TextureRate rate(device);
        for (const SampleKind kind : kKinds) {
            for (const SampleAmount amount : kAmounts) {
                const std::vector<std::uint32_t> results = rate.results(kind, amount);
                ASSERT_EQ(results.size(), std::size_t{amount.groups} * kLanes);
                std::size_t wrong = 0;
                for (std::uint32_t i = 0; i < results.size(); ++i)
                    if (results[i] != expectedOf(depths, kind, amount.rounds, i)) ++wrong;
                EXPECT_EQ(wrong, 0u) << "of " << results.size() << ", " << nameOf(kind);
            }
        }
    }
    expectNoMessages();
}

}  // namespace
}  // namespace gnomon::renderer
