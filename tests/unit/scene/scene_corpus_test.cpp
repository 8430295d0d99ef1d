// Real scenes and the malformed corpus, which the repository does not hold: GNOMON_SCENES_DIR names their
// folder. Without it the tests are skipped, and say so.

#include <chrono>
#include <cstdlib>

#include "gltf_files.h"
#include "scene/play_animation.h"
#include "scene/pose.h"

using namespace scene_tests;

namespace {

std::filesystem::path scenesFolder() {
    const char* given = std::getenv("GNOMON_SCENES_DIR");
    return given != nullptr ? given : "";
}

struct Known {
    const char* file;
    std::uint64_t triangles;
    std::size_t lights;
    std::size_t animations = 0;
};

constexpr std::uint64_t kManyTriangles = 100'000;

constexpr Known kScenes[] = {
    {"sponza/sponza.glb", 262267, 0},
    {"small_house/small_house.glb", 145844, 8},
    {"sophia/sophia.glb", 19086, 0, 8},
    {"kaykit_knight/Knight.glb", 6952, 0, 76},
    {"cesium_man/CesiumMan.glb", 4672, 0, 1},
    {"dutch_ship/dutch_ship_medium_1k.gltf", 69162, 0},
    {"jungle/jungle.glb", 18515, 0},
    {"japanese_garden/japanese_garden.glb", 21883, 0},
    {"palm_tree/PalmTree.gltf", 10124, 0},
    {"intel_sponza_parts/curtains/sponza_curtains.gltf", 55115, 0},
    {"intel_sponza_parts/ivy/sponza_ivy.gltf", 15870, 0},
    {"intel_sponza_parts/lights_only.gltf", 0, 23},
    {"tps_lights/lights.glb", 5440, 20},
    {"bistro_lights_only/BistroExteriorFakeGI.gltf", 0, 7},
    {"mixed_light/MixedLightingExample.gltf", 40898, 1},
    {"zdm2/zdm2.glb", 58772, 0},
    {"draco_test/red_city.draco.glb", 175648, 0},
};

// Figures keep together whatever they play: no vertex leaves them.
void expectWhole(Scene& scene, const std::string& file) {
    const float radius = worldBounds(scene).radius();
    for (std::size_t a = 0; a < scene.animations.size(); ++a) {
        playCompatible(scene, a);
        EXPECT_LT(animatedExtent(scene, 7).drawn.radius(), 6.0f * radius) << file << ", " << scene.animations[a].name;
    }
}

}  // namespace

TEST(SceneCorpus, RealScenes) {
    if (!std::filesystem::exists(scenesFolder())) GTEST_SKIP() << "no scenes at " << scenesFolder();
    // With sanitizers and in a hurry, the largest are left to the image tests.
    const bool all = std::getenv("GNOMON_QUICK") == nullptr;
    for (const Known& known : kScenes) {
        if (!all && known.triangles > kManyTriangles) continue;
        Scene scene;
        const gnomon::Result result = loadGltf(scenesFolder() / known.file, scene);
        ASSERT_TRUE(result.ok()) << result.message();
        expectSound(scene);
        EXPECT_EQ(triangleCount(scene), known.triangles) << known.file;
        EXPECT_EQ(scene.lights.size(), known.lights) << known.file;
        EXPECT_EQ(scene.animations.size(), known.animations) << known.file;
        expectWhole(scene, known.file);
    }
}

TEST(SceneCorpus, UnsupportedExtensionsAreNamed) {
    if (!std::filesystem::exists(scenesFolder())) GTEST_SKIP() << "no scenes at " << scenesFolder();
    for (const auto& [file, name] : {std::pair("meshopt_required.glb", "EXT_meshopt_compression"),
                                     std::pair("webp_and_draco_required.glb", "EXT_texture_webp")}) {
        Scene scene;
        const gnomon::Result result = loadGltf(scenesFolder() / "unsupported_ext" / file, scene);
        EXPECT_FALSE(result.ok());
        EXPECT_NE(std::string(result.message()).find(name), std::string::npos) << result.message();
    }
}

TEST(SceneCorpus, MalformedFilesGetASentence) {
    const std::filesystem::path folder = scenesFolder() / "malformed";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no corpus at " << folder;
    int files = 0, accepted = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;  // reports and buffers too: they are garbage to a glTF loader
        const auto start = std::chrono::steady_clock::now();
        Scene scene;
        const gnomon::Result result = loadGltf(entry.path(), scene);
        ++files;
        EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5)) << entry.path();
        if (result.ok()) {
            ++accepted;
            expectSound(scene);
        } else {
            EXPECT_GT(std::strlen(result.message()), 10u) << entry.path();
        }
    }
    std::printf("%d files, %d loaded, %d refused with a sentence\n", files, accepted, files - accepted);
    EXPECT_GT(files, 200);
}
