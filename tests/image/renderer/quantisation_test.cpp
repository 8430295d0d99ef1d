// What the 8 bits of a stored visibility cost, against inline shadows that keep the float; and what 4 bits cost against
// the 8.
//
// Bound: q = round(255 sqrt(v)) errs by at most sqrt(v) / 255 in v. Encoded as sRGB (about a power of 1 / 2.4), one
// light's L = v E errs by at most 255 / 2.4 * 1 / (255 sqrt(v)) * v^(1 / 2.4) = 0.42 v^-0.08 steps of a byte: below 0.8
// down to v = 1 / 2000. Rounding both pictures adds one step, so 2/255 bounds the largest difference.
#include "image/renderer/harness.h"

namespace gnomon::renderer::image_test {
namespace {

GNOMON_IMAGE_TEST_SUITE(Quantisation);

constexpr std::uint32_t kLargest = 2;   // of 255
constexpr double kMeanAbsolute = 0.05;  // of 255
// With 4 bits a step is 17 times as wide: a light of the picture's own brightness errs by at most 17 * 0.8 + 1 = 14.6
// steps of a byte. Near its lamp a light is many times as bright, and what 4 bits take for dark, below 1/900 of it, is
// seen. Measured at most: 13 and 0.42 (lavapipe), 15 and 0.49 (SwiftShader), 20 and 0.46 (NVIDIA H100).
constexpr std::uint32_t kLargestOfFour = 24;
constexpr double kMeanAbsoluteOfFour = 0.75;

void print(const Device& device, const std::string& what, const RendererDesc& desc, const Difference& error) {
    std::printf("[ figure   ] %s: %s: largest %u/255, mean %.4f/255, %.2f %% of pixels\n", device.info().name.c_str(),
                what.c_str(), error.largest, error.meanAbsolute,
                100.0 * static_cast<double>(error.pixels) / (desc.frame.widthPx * desc.frame.heightPx));
}

TEST_P(Quantisation, CostsAtMostTwoSteps) {
    for (const char* scene : {"courtyard", "columns", "sundial"}) {
        if (!thorough() && scene != std::string("columns")) continue;
        const View3d view = builtin(scene, 64);
        SCOPED_TRACE(view.name);
        RendererDesc desc = smallDesc();
        desc.frame.shadows.pcssPresets[0] = {8, 24};
        desc.frame.inlineVariant.quantises = false;
        Renderer renderer(device(), view.scene, desc, pipelinesOf(device()));
        const Frame exact = draw(renderer, view.camera, ShadowMode::Inline);
        const Frame deferred = draw(renderer, view.camera, ShadowMode::Deferred);
        desc.frame.shadows.visibilityBits = 4;
        const Frame four = drawOnce(device(), view, desc, ShadowMode::Deferred);
        const float exposure = automaticExposure(exact.linear);
        const Picture expected = toneMap(exact.linear, exposure), actual = toneMap(deferred.linear, exposure);
        const Difference error = expectEqual(device(), view.name + " quantised", expected, actual, kLargest);
        EXPECT_LE(error.meanAbsolute, kMeanAbsolute);
        EXPECT_FALSE(exact.linear.rgba == deferred.linear.rgba) << "the switch does nothing";
        print(device(), view.name + ", slots of 8 bits against floats", desc, error);
        const Difference coarse = compare(actual, toneMap(four.linear, exposure));
        EXPECT_LE(coarse.largest, kLargestOfFour);
        EXPECT_LE(coarse.meanAbsolute, kMeanAbsoluteOfFour);
        EXPECT_GT(coarse.largest, error.largest) << "slots of 4 bits were not used";
        print(device(), view.name + ", slots of 4 bits against 8", desc, coarse);
        for (const auto& [name, difference] : {std::pair{"8", error}, std::pair{"4", coarse}}) {
            RecordProperty(std::string(scene) + "_" + name + "_bits_largest", std::to_string(difference.largest));
            RecordProperty(std::string(scene) + "_" + name + "_bits_mean", std::to_string(difference.meanAbsolute));
        }
    }
}

}  // namespace
}  // namespace gnomon::renderer::image_test
