// Pictures that a person has looked at, drawn with lavapipe: tests/image/golden/. GNOMON_UPDATE_GOLDEN=1 draws them
// anew with the first CPU device whose name contains "llvmpipe".
//
// Other devices filter textures and place edges and shadow texels a little differently, so the tolerance is on shares:
// at most 1 % of the pixels apart by more than 24/255, and a mean absolute difference of at most 0.5/255. In the
// courtyard, full of leaves and textures that are finer than these pixels and texels, 10 % and 6/255: SwiftShader
// has 7.7 % and 4.0/255, with PCF as much as with PCSS, and a quarter of it without any shadow.
#include <cstdlib>
#include <filesystem>

#include "image/renderer/harness.h"

namespace gnomon::renderer::image_test {
namespace {

GNOMON_IMAGE_TEST_SUITE(Golden);

struct GoldenCase {
    const char* scene;
    double meanAbsolute;  // of 255
    double shareApart;
};
constexpr GoldenCase kCases[] = {{"courtyard", 6.0, 0.1},
                                 {"columns", 0.5, 0.01},
                                 {"cloth", 0.5, 0.01},
                                 {"masked", 0.5, 0.01},
                                 {"sundial", 0.5, 0.01}};
constexpr int kApart = 24;

double shareApart(const Picture& a, const Picture& b) {
    std::size_t apart = 0;
    const std::size_t pixels = a.rgb.size() / 3;
    for (std::size_t p = 0; p < pixels; ++p) {
        bool differs = false;
        for (std::size_t i = 3 * p; i < 3 * p + 3; ++i) differs |= std::abs(a.rgb[i] - b.rgb[i]) > kApart;
        apart += differs ? 1 : 0;
    }
    return static_cast<double>(apart) / static_cast<double>(pixels);
}

TEST_P(Golden, PicturesStay) {
    const std::filesystem::path folder = std::filesystem::path(GNOMON_SOURCE_DIR) / "tests/image/golden";
    const bool update = std::getenv("GNOMON_UPDATE_GOLDEN") != nullptr;
    for (const auto& [scene, meanAbsolute, mostApart] : kCases) {
        SCOPED_TRACE(scene);
        const View3d view = builtin(scene);
        RendererDesc desc = smallDesc();
        desc.atlasSizePx = 2048;
        desc.frame.shadows.pcssPresets[0] = kPcssMedium;
        const Frame frame = drawOnce(device(), view, desc, ShadowMode::Deferred);
        const Picture picture = toneMap(frame.linear, view.scene.exposureEv100.value());
        const std::filesystem::path file = folder / (std::string(scene) + ".png");
        if (update) {
            if (device().info().name.find("llvmpipe") == std::string::npos) continue;
            std::filesystem::create_directories(folder);
            writePng(picture, file);
            std::printf("[ written  ] %s\n", file.c_str());
            continue;
        }
        const Picture golden = readPng(file);
        const Difference difference = compare(golden, picture);
        const double share = shareApart(golden, picture);
        std::printf("[ figure   ] %s: golden %s: mean %.4f/255, %.3f %% of pixels apart by more than %d/255\n",
                    device().info().name.c_str(), scene, difference.meanAbsolute, 100.0 * share, kApart);
        EXPECT_LE(difference.meanAbsolute, meanAbsolute);
        EXPECT_LE(share, mostApart);
        if (difference.meanAbsolute > meanAbsolute || share > mostApart)
            writeFailure(device(), std::string("golden ") + scene, golden, picture);
    }
}

}  // namespace
}  // namespace gnomon::renderer::image_test
