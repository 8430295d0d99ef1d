// A file in earth coordinates is drawn as at zero.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "image/renderer/harness.h"
#include "scene/load_gltf.h"
#include "unit/scene/gltf_files.h"

namespace gnomon::renderer::image_test {
namespace {

GNOMON_IMAGE_TEST_SUITE(FarScenes);

HdrPicture drawn(const Device& device, const std::string& name, Scene scene) {
    View3d view;
    view.name = name;
    view.scene = std::move(scene);
    completeLights(view.scene);
    view.camera = defaultCamera(view.scene);
    RendererDesc desc = smallDesc(160, 90);
    desc.frame.filters = {Filter::Hard};
    return drawOnce(device, view, desc, ShadowMode::Deferred).linear;
}

// Triangles over a ground, a sun and a lamp, below a root with `place`.
Scene underRoot(std::size_t device, const std::string& place) {
    const std::string nodes =
        R"([{)" + place +
        R"("children":[1,2,3,4,5,6]},{"mesh":0,"rotation":[-0.7071067811865476,0,0,0.7071067811865476],)"
        R"("translation":[-8,0,8],"scale":[20,20,20]},{"mesh":0,"translation":[-1.05,0.3,0.1]},)"
        R"({"mesh":0,"translation":[0.35,0.4,0.26],"rotation":[0,0.38,0,0.92],"scale":[0.5,0.5,0.5]},)"
        R"({"translation":[1.5,3,1],"extensions":{"KHR_lights_punctual":{"light":0}}},)"
        R"({"rotation":[-0.5,0.25,0,0.8],"extensions":{"KHR_lights_punctual":{"light":1}}},)"
        R"({"camera":0,"translation":[0,2,5],"rotation":[-0.17364817766,0,0,0.98480775301]}])";
    const std::string more =
        R"(,"materials":[{"doubleSided":true}],"cameras":[{"type":"perspective","perspective":{"yfov":0.8,"znear":0.05}}],)"
        R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":60},)"
        R"({"type":"directional","intensity":4}]}})";
    const std::filesystem::path path =
        std::filesystem::path(testing::TempDir()) / ("gnomon_far_" + std::to_string(device) + ".gltf");
    std::ofstream(path, std::ios::binary) << scene_tests::triangleGltf(more, R"(,"material":0)", nodes);
    Scene scene;
    const Result result = loadGltf(path, scene);
    std::filesystem::remove(path);
    EXPECT_TRUE(result.ok()) << result.message();
    return scene;
}

void expectAsAtZero(const Device& device, const std::string& name, const Scene& near, const Scene& far) {
    const HdrPicture expected = drawn(device, name, near), got = drawn(device, name, far);
    const Difference difference = expectEqual(device, name, expected, got, 0);
    std::printf("[ figure   ] %s: %s: %llu pixels differ, by up to %u\n", device.info().name.c_str(), name.c_str(),
                static_cast<unsigned long long>(difference.pixels), difference.largest);
}

TEST_P(FarScenes, EarthCoordinates) {
    const Scene near = underRoot(GetParam(), "");
    expectAsAtZero(device(), "far-root", near,
                   underRoot(GetParam(), R"("translation":[4510731.2537,4510731.8731,0.333],)"));
}

TEST_P(FarScenes, FieldCase) {
    const char* named = std::getenv("GNOMON_SCENES_DIR");
    if (named == nullptr) GTEST_SKIP() << "GNOMON_SCENES_DIR is not set";
    const std::filesystem::path folder = std::filesystem::path(named) / "field" / "08-transforms-in-float";
    if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "no " << folder;
    Scene near, far;
    ASSERT_TRUE(loadGltf(folder / "geo0root.gltf", near).ok());
    ASSERT_TRUE(loadGltf(folder / "geoecefroot.gltf", far).ok());
    expectAsAtZero(device(), "geoecefroot", near, far);
}

}  // namespace
}  // namespace gnomon::renderer::image_test
