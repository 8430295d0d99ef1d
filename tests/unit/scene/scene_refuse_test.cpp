// What a bad file gets: one sentence, or a note when nothing that is drawn is broken. Never a crash.

#include <limits>
#include <random>

#include "gltf_files.h"

using namespace scene_tests;

namespace {

void expectRefused(const std::string& text, const std::string& part) {
    Scene scene;
    scene.name = "untouched";
    const gnomon::Result result = loadText(text, scene);
    ASSERT_FALSE(result.ok()) << "accepted: " << text.substr(0, 300);
    EXPECT_NE(std::string(result.message()).find(part), std::string::npos) << result.message();
    EXPECT_EQ(scene.name, "untouched");
}

void expectNoted(const std::string& text, const std::string& part) {
    Scene scene;
    const gnomon::Result result = loadText(text, scene);
    ASSERT_TRUE(result.ok()) << result.message();
    expectSound(scene);
    std::string notes;
    for (const std::string& note : scene.notes) notes += note + "\n";
    EXPECT_NE(notes.find(part), std::string::npos) << notes;
}

std::string withBytes(std::size_t offset, float value) {
    std::vector<std::uint8_t> bytes = triangleBytes();
    std::memcpy(bytes.data() + offset, &value, sizeof(value));
    return triangleJson(dataBuffer(bytes));
}

}  // namespace

TEST(SceneRefuse, Containers) {
    Scene scene;
    EXPECT_FALSE(loadGltf("/nowhere/at/all.gltf", scene).ok());
    EXPECT_FALSE(loadGltf(testing::TempDir(), scene).ok());
    expectRefused("", "empty");
    expectRefused("garbage, not JSON", "not JSON");
    expectRefused(std::string("glTF") + std::string(400, '\x7f'), "version");
    expectRefused("{}", "version");
    expectRefused("[]", "root");
    expectRefused(R"({"asset":{"version":"1.0"}})", "only 2.0");
    expectRefused(std::string(100000, '['), "levels deep");
    expectRefused(R"({"asset":{"version":"2.0"},"extras":)" + std::string(5000, '[') + std::string(5000, ']') + "}",
                  "levels deep");
    expectRefused(R"({"asset":{"version":"2.0"}})", "the scene is empty");
    expectRefused(R"({"asset":{"version":"2.0"},"nodes":7})", "not an array");
}

TEST(SceneRefuse, EveryTruncationOfAGlb) {
    const std::string whole = triangleGlb();
    for (std::size_t length = 0; length < whole.size(); ++length) {
        Scene scene;
        EXPECT_FALSE(loadText(whole.substr(0, length), scene).ok()) << length;
    }
    std::string longChunk = whole;  // a binary chunk that claims eight bytes beyond the end
    longChunk[longChunk.size() - triangleBytes().size() - 8] += 8;
    expectRefused(longChunk, "past the file's end");
}

TEST(SceneRefuse, Vertices) {
    expectRefused(withBytes(0, std::numeric_limits<float>::quiet_NaN()), "tri");
    expectRefused(withBytes(16, std::numeric_limits<float>::infinity()), "not finite");
    expectRefused(withBytes(16, 3.0e38f), "not finite or beyond");
    expectRefused(replaced(triangleGltf(), R"("POSITION":0)", R"("NORMAL":0)"), "no POSITION");
    expectRefused(replaced(triangleGltf(), R"("POSITION":0)", R"("POSITION":5)"), "accessor 5");
    expectRefused(replaced(triangleGltf(), R"("POSITION":0)", R"("POSITION":-1)"), "attributes.POSITION is -1");
    expectRefused(replaced(triangleGltf(), R"("POSITION":0)", R"("POSITION":0,"NORMAL":1)"), "components");
    expectRefused(replaced(triangleGltf(), R"("POSITION":0)", R"("POSITION":1)"), "components");
}

TEST(SceneRefuse, Accessors) {
    const std::string good = triangleGltf();
    for (const char* count : {"4", "4000000000", "18446744073709551615"})
        expectRefused(
            replaced(good, R"("count":3,"type":"VEC3")", std::string(R"("count":)") + count + R"(,"type":"VEC3")"),
            "wants");
    expectRefused(replaced(good, R"("count":3,"type":"VEC3")", R"("count":0,"type":"VEC3")"), "without elements");
    expectRefused(
        replaced(good, R"("componentType":5126)", R"("componentType":5126,"byteOffset":18446744073709551614)"),
        "wants");
    expectRefused(replaced(good, R"("componentType":5126)", R"("componentType":5130)"), "");
    expectRefused(replaced(good, R"("componentType":5123)", R"("componentType":5126)"), "");
    expectRefused(replaced(good, R"("bufferView":0)", R"("bufferView":9)"), "bufferView 9");
    expectRefused(replaced(good, R"("byteLength":36)", R"("byteLength":8)"), "wants");  // less than one element
    expectRefused(replaced(good, R"("byteLength":36)", R"("byteLength":99999)"), "past the end");
    expectRefused(replaced(good, R"("byteOffset":36)", R"("byteOffset":18446744073709551600)"), "past the end");
    expectRefused(replaced(good, R"("byteLength":36)", R"("byteLength":36,"byteStride":4)"), "apart");
    expectRefused(replaced(good, R"({"buffer":0,"byteLength":36})", R"({"buffer":3,"byteLength":36})"), "buffer 3");
    expectRefused(replaced(good, R"("byteLength":44)", R"("byteLength":45)"), "truncated");
    expectRefused(replaced(good, "base64,", "base64,!!"), "malformed");
    const std::string sparse =
        R"("count":3,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":1,"byteOffset":4,)"
        R"("componentType":5123},"values":{"bufferView":0}})";
    Scene scene;
    EXPECT_TRUE(loadText(replaced(good, R"("count":3,"type":"VEC3")", sparse), scene).ok());
    const std::string bad = replaced(good, R"("count":3,"type":"VEC3")", sparse);
    expectRefused(replaced(bad, R"("sparse":{"count":1)", R"("sparse":{"count":4)"), "sparse");
    expectRefused(replaced(bad, R"("byteOffset":4)", R"("byteOffset":-4)"), "byteOffset is -4");
    expectRefused(replaced(bad, R"("values":{"bufferView":0})", R"("values":{"bufferView":77})"), "bufferView 77");
    expectRefused(
        R"({"asset":{"version":"2.0"},"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"componentType":5126,)"
        R"("count":4000000000,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":0,"componentType":5123},)"
        R"("values":{"bufferView":0}}}],"bufferViews":[{"buffer":0,"byteLength":44}],"buffers":[)" +
            dataBuffer(triangleBytes()) + "]}",
        "without a bufferView");
}

TEST(SceneRefuse, Indices) {
    std::vector<std::uint8_t> bytes = triangleBytes();
    bytes[36] = 200;
    expectRefused(triangleJson(dataBuffer(bytes)), "index 200 for 3 vertices");
    expectRefused(replaced(triangleGltf(), R"("indices":1)", R"("indices":8)"), "");
    expectRefused(triangleGltf("", R"(,"material":4)"), "material 4");
    expectRefused(triangleGltf("", R"(,"mode":9)"), "mode is 9");
    expectRefused(
        triangleGltf(R"(,"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":3}}}])", R"(,"material":0)"),
        "texture 3");
}

TEST(SceneRefuse, Nodes) {
    const auto nodes = [](const char* text) { return triangleGltf("", "", text); };
    expectRefused(nodes(R"([{"mesh":0,"children":[0]}])"), "reached twice");
    expectRefused(nodes(R"([{"children":[1]},{"mesh":0,"children":[0]}])"), "reached twice");
    expectRefused(nodes(R"([{"children":[1,2]},{"children":[2]},{"mesh":0}])"), "reached twice");
    expectRefused(nodes(R"([{"mesh":0,"children":[5]}])"), "node 5");
    expectRefused(nodes(R"([{"mesh":3}])"), "mesh 3");
    expectRefused(nodes(R"([{"mesh":0,"matrix":[1,2,3]}])"), "matrix");
    expectRefused(nodes(R"([{"mesh":0,"rotation":[0,0,0,0]}])"), "rotation");
    expectRefused(nodes(R"([{"mesh":0,"scale":[1e39,1,1]}])"), "float");
    expectRefused(nodes(R"([{"mesh":0,"extensions":{"KHR_lights_punctual":{"light":2}}}])"), "light 2");
    expectRefused(replaced(triangleGltf(), R"("scene":0)", R"("scene":4)"), "scene 4");
    expectRefused(replaced(triangleGltf(), R"("scene":0)", R"("scene":-7)"), "scene is -7");
    std::string chain = "[";  // deep, and no trouble
    for (int i = 1; i < 20000; ++i) chain += R"({"children":[)" + std::to_string(i) + "]},";
    Scene scene;
    EXPECT_TRUE(loadText(triangleGltf("", "", chain + R"({"mesh":0}])"), scene).ok());
}

TEST(SceneRefuse, LightsWithABiasThatIsNoLength) {
    for (const char* value : {"-0.001", "-1e-9", "1e39"})
        expectRefused(lightGltf(std::string(R"(,"extras":{"shadowBiasMetres":)") + value + "}"), "light 0 'lamp'");
}

TEST(SceneRefuse, LightsWithASourceThatIsNoLength) {
    for (const char* value : {"-0.001", "0", "1e16", "1e39"})
        expectRefused(lightGltf(std::string(R"(,"extras":{"sourceRadius":)") + value + "}"), "light 0 'lamp'");
}

TEST(SceneRefuse, Extensions) {
    expectRefused(triangleGltf(R"(,"extensionsRequired":["EXT_meshopt_compression"])"), "EXT_meshopt_compression");
    expectNoted(triangleGltf(R"(,"extensionsUsed":["VENDOR_whatever"])"), "VENDOR_whatever");
    expectRefused(
        triangleGltf("",
                     R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}})"),
        "Draco");
    expectRefused(triangleGltf("", R"(,"extensions":{"KHR_draco_mesh_compression":{}})"), "bufferView -1");
}

TEST(SceneRefuse, WhatIsNotDrawnIsNoted) {
    expectNoted(triangleGltf(R"(,"images":[{"uri":"missing.png"}],"textures":[{"source":0}],)"
                             R"("materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])",
                             R"(,"material":0)"),
                "missing.png");
    expectNoted(triangleGltf(R"(,"images":[{"uri":"https://example.org/a.png"}],"textures":[{"source":0}],)"
                             R"("materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])",
                             R"(,"material":0)"),
                "nothing is fetched");
    expectNoted(triangleGltf("", "", R"([{"mesh":0,"camera":3}])"), "camera 3");
    expectNoted(
        replaced(triangleGltf(), R"({"attributes":)", R"({"attributes":{"POSITION":0},"mode":0},{"attributes":)"),
        "points");
    expectNoted(triangleGltf("", "", R"([{"mesh":0,"children":[1]},{"mesh":0,"scale":[0,0,0]}])"), "scale of zero");
    expectNoted(replaced(triangleGltf(), R"("POSITION":0)", R"("POSITION":0,"NORMAL":0)"),
                "normals without a direction");
    Scene scene;  // a broken buffer that nothing drawn refers to
    EXPECT_TRUE(
        loadText(replaced(triangleGltf(), R"("}]})", R"("},{"byteLength":99,"uri":"gone.bin"}]})"), scene).ok());
}

// A seeded storm of damaged files: whatever loads must be sound.
TEST(SceneRefuse, DamagedBytes) {
    const std::string whole = triangleGlb();
    std::mt19937 random(20240607);
    int accepted = 0;
    for (int round = 0; round < 3000; ++round) {
        std::string text = whole;
        const int changes = 1 + static_cast<int>(random() % 3);
        for (int i = 0; i < changes; ++i) {
            const std::size_t at = 12 + random() % (text.size() - 12);
            const char digits[] = "0123456789-,[]{}e.";
            text[at] = random() % 2 == 0 ? static_cast<char>(random()) : digits[random() % (sizeof(digits) - 1)];
        }
        Scene scene;
        if (loadText(text, scene).ok()) {
            ++accepted;
            expectSound(scene);
            completeLights(scene);
            (void)defaultCamera(scene);
        }
    }
    EXPECT_GT(accepted, 100);  // else the storm tests the JSON parser alone
}
