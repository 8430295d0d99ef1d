// What a user is told of things that are drawn otherwise than the file says.
#include "gltf_files.h"

using namespace scene_tests;

namespace {

std::string notesOf(const std::string& text) {
    Scene scene;
    const gnomon::Result result = loadText(text, scene);
    EXPECT_TRUE(result.ok()) << result.message();
    std::string notes;
    for (const std::string& note : scene.notes) notes += note + "\n";
    return notes;
}

void expectSays(const std::string& notes, const std::string& part) {
    EXPECT_NE(notes.find(part), std::string::npos) << notes << "lacks: " << part;
}

std::string using_(const std::string& extension) {
    return triangleGltf(R"(,"extensionsUsed":[")" + extension + R"("])");
}

}  // namespace

TEST(SceneNotes, BlendedMaterials) {
    const auto blended = [](const char* materials) {
        return notesOf(triangleGltf(std::string(R"(,"materials":[)") + materials + "]", R"(,"material":0)"));
    };
    const std::string one = blended(R"({"name":"glass","alphaMode":"BLEND"})");
    expectSays(one, "1 of 1 materials is blended ('glass')");
    expectSays(one, "alpha below 0.5 is cut out, the rest is drawn opaque");
    expectSays(blended(R"({"alphaMode":"BLEND"})"), "1 of 1 materials is blended: alpha");
    EXPECT_EQ(blended(R"({"name":"net","alphaMode":"MASK"})"), "");
    EXPECT_EQ(blended(R"({"name":"used"},{"name":"unused","alphaMode":"BLEND"})"), "");
    const std::string two = notesOf(replaced(
        triangleGltf(R"(,"materials":[{"name":"glass","alphaMode":"BLEND"},{"name":"smoke","alphaMode":"BLEND"},{}])",
                     R"(,"material":0)"),
        R"({"attributes":)",
        R"({"attributes":{"POSITION":0},"material":1},{"attributes":{"POSITION":0},"material":2},{"attributes":)"));
    expectSays(two, "2 of 3 materials are blended ('smoke', 'glass')");
}

// One sentence each, that says what is missing in the picture.
TEST(SceneNotes, ExtensionsSayWhatTheyCost) {
    const std::pair<const char*, const char*> costs[] = {
        {"KHR_node_visibility", "hidden nodes are drawn"},
        {"EXT_mesh_gpu_instancing", "instances are missing"},
        {"KHR_texture_basisu", "textures"},
        {"EXT_texture_webp", "textures"},
        {"EXT_texture_avif", "textures"},
        {"MSFT_texture_dds", "textures"},
        {"KHR_materials_unlit", "lit"},
        {"KHR_materials_transmission", "opaque"},
        {"KHR_materials_diffuse_transmission", "opaque"},
        {"KHR_materials_volume", "opaque"},
        {"KHR_materials_clearcoat", "coat"},
        {"KHR_materials_sheen", "sheen"},
        {"KHR_materials_specular", "reflect"},
        {"KHR_materials_ior", "reflect"},
        {"KHR_materials_iridescence", "iridescen"},
        {"KHR_materials_anisotropy", "direction"},
        {"KHR_materials_dispersion", "colours"},
        {"KHR_materials_variants", "default"},
        {"KHR_materials_pbrSpecularGlossiness", "specular"},
        {"KHR_animation_pointer", "stand still"},
        {"MSFT_lod", "finest"},
        {"EXT_lights_image_based", "light"},
        {"EXT_meshopt_compression", "without compression"},
    };
    for (const auto& [extension, cost] : costs) {
        const std::string notes = notesOf(using_(extension));
        EXPECT_TRUE(notes.starts_with(std::string("The extension '") + extension + "' ")) << notes;
        expectSays(notes, cost);
        EXPECT_EQ(std::count(notes.begin(), notes.end(), '\n'), 1) << notes;
        EXPECT_TRUE(notes.ends_with(".\n")) << notes;
    }
    expectSays(notesOf(using_("VENDOR_whatever")), "The extension 'VENDOR_whatever' is not read.");
    expectSays(notesOf(using_("KHR_materials_future")), "The extension 'KHR_materials_future' is not read: the core");
    for (const char* whole : {"KHR_lights_punctual", "KHR_texture_transform", "KHR_materials_emissive_strength",
                              "KHR_mesh_quantization", "KHR_draco_mesh_compression"})
        EXPECT_EQ(notesOf(using_(whole)), "") << whole;
}

TEST(SceneNotes, RequiredOnesAreRefused) {
    for (const char* name : {"KHR_node_visibility", "EXT_mesh_gpu_instancing", "KHR_texture_basisu", "MSFT_lod"}) {
        Scene scene;
        const gnomon::Result result = loadText(triangleGltf(std::string(R"(,"extensionsUsed":[")") + name +
                                                            R"("],"extensionsRequired":[")" + name + R"("])"),
                                               scene);
        ASSERT_FALSE(result.ok()) << name;
        expectSays(result.message(), name);
    }
}
