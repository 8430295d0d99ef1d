// Deferred equals inline in real scenes, where they are: in the folder that GNOMON_SCENES_DIR names. Every glTF file
// that loads, each with 64 lights more. Left out with GNOMON_QUICK=1.
#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "image/renderer/harness.h"
#include "scene/load_gltf.h"
#include "scene/scatter/scatter_lights.h"

namespace gnomon::renderer::image_test {
namespace {

GNOMON_IMAGE_TEST_SUITE(RealScenes);

namespace fs = std::filesystem;

fs::path scenesFolder() {
    const char* named = std::getenv("GNOMON_SCENES_DIR");
    return named != nullptr ? named : "";
}

// Folders that hold files for other tests: broken ones, and ones that need what we refuse.
bool isForLoaderTests(const fs::path& file) {
    return std::ranges::any_of(file,
                               [](const fs::path& part) { return part == "malformed" || part == "unsupported_ext"; });
}

// Eyes inside or near the scene, where framing the whole of it would show little.
struct Eye {
    const char* stem;
    const char* camera;
};
constexpr Eye kEyes[] = {{"sponza", "9,1.5,0.2:-5,3,0:70"},
                         {"small_house", "0,14,12:0,0,0:60"},
                         {"sophia", "0.5,1.4,2.2:0,0.9,0:60"},
                         {"Knight", "1.5,2,4:0,1.1,0:60"},
                         {"dutch_ship_medium_1k", "20,12,20:2,8,0:60"}};

SceneCamera cameraFor(const fs::path& file, const Scene& scene) {
    SceneCamera camera = defaultCamera(scene);
    for (const Eye& eye : kEyes)
        if (file.stem() == eye.stem) {
            EXPECT_TRUE(parseCamera(eye.camera, scene, camera).ok());
        }
    return camera;
}

std::vector<fs::path> sceneFiles() {
    std::vector<fs::path> files;
    if (!fs::is_directory(scenesFolder())) return files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(scenesFolder())) {
        const fs::path extension = entry.path().extension();
        if ((extension == ".glb" || extension == ".gltf") && !isForLoaderTests(entry.path()))
            files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

TEST_P(RealScenes, DeferredIsInline) {
    if (!thorough()) GTEST_SKIP() << "left out with GNOMON_QUICK=1";
    const std::vector<fs::path> files = sceneFiles();
    if (files.empty()) GTEST_SKIP() << "no real scenes in " << scenesFolder();
    Worst worst;
    std::size_t drawn = 0;
    for (const fs::path& file : files) {
        View3d view;
        view.name = file.stem().string();
        if (const Result loaded = loadGltf(file, view.scene); !loaded) {
            std::printf("skipped: %s: %s\n", file.c_str(), loaded.message());
            continue;
        }
        scatterLights(view.scene, 64, 1);
        completeLights(view.scene);
        view.camera = cameraFor(file, view.scene);
        const std::uint64_t before = worst.pixels;
        const Frame frame =
            expectDeferredIsInline(device(), view.name + "+64", view, smallDesc(200, 112), worst, false);
        const FrameStatistics& s = frame.report.statistics;
        std::printf(
            "[ figure   ] %s: %s+64: %llu pixels differ; %u of %zu lights, %.2f list entries and %.2f slots per "
            "tile with geometry\n",
            device().info().name.c_str(), view.name.c_str(), static_cast<unsigned long long>(worst.pixels - before),
            s.lights.visible, view.scene.lights.size(), double(s.earlyEntries) / std::max(s.tilesWithGeometry, 1u),
            double(s.finalSlotEntries) / std::max(s.tilesWithGeometry, 1u));
        ++drawn;
    }
    EXPECT_GT(drawn, 0u);
    worst.report(device(), "real scenes");
}

}  // namespace
}  // namespace gnomon::renderer::image_test
