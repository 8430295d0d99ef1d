// Accessors without a bufferView hold zeros (glTF 2.0, section 5.1.1), wherever an accessor may stand.
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "gltf_files.h"
#include "scene/pose.h"

using namespace scene_tests;
using nlohmann::json;

namespace {

// A skinned, morphed triangle that moves. Accessors: 0 positions, 1 indices, 2 joints, 3 weights, 4 target, 5 times,
// 6 moves, 7 inverse bind matrices, 8 one time, 9 normals.
json moving() {
    std::vector<std::uint8_t> bytes;
    append<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 2, 0});
    append<std::uint16_t>(bytes, {0, 1, 2, 0});
    append<std::uint8_t>(bytes, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    append<float>(bytes, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    append<float>(bytes, {0, 0, 1, 0, 0, 1, 0, 0, 1});
    append<float>(bytes, {0, 1});
    append<float>(bytes, {7, 0, 0, 7, 0, 0});
    for (int i = 0; i < 2; ++i) append<float>(bytes, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    json root = json::parse(R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0,1,2]}],
      "nodes":[{"mesh":0,"skin":0},{"name":"first"},{"name":"second","translation":[0,0,5]}],
      "meshes":[{"weights":[1],"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3,"NORMAL":9},
        "indices":1,"targets":[{"POSITION":4}]}]}],
      "skins":[{"joints":[1,2],"inverseBindMatrices":7}],
      "animations":[{"samplers":[{"input":5,"output":6}],
        "channels":[{"sampler":0,"target":{"node":2,"path":"translation"}}]}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
        {"bufferView":0,"byteOffset":36,"componentType":5123,"count":3,"type":"SCALAR"},
        {"bufferView":0,"byteOffset":44,"componentType":5121,"count":3,"type":"VEC4"},
        {"bufferView":0,"byteOffset":56,"componentType":5126,"count":3,"type":"VEC4"},
        {"bufferView":0,"byteOffset":104,"componentType":5126,"count":3,"type":"VEC3"},
        {"bufferView":0,"byteOffset":140,"componentType":5126,"count":2,"type":"SCALAR"},
        {"bufferView":0,"byteOffset":148,"componentType":5126,"count":2,"type":"VEC3"},
        {"bufferView":0,"byteOffset":172,"componentType":5126,"count":2,"type":"MAT4"},
        {"bufferView":0,"byteOffset":140,"componentType":5126,"count":1,"type":"SCALAR"},
        {"bufferView":0,"byteOffset":104,"componentType":5126,"count":3,"type":"VEC3"}],
      "bufferViews":[{"buffer":0,"byteLength":300}]})");
    root["buffers"] = json::array({json::parse(dataBuffer(bytes))});
    return root;
}

Scene loadedFrom(const json& root) {
    Scene scene;
    const gnomon::Result result = loadText(root.dump(), scene);
    EXPECT_TRUE(result.ok()) << result.message();
    if (result.ok()) expectSound(scene);
    return scene;
}

Scene withoutView(int accessor) {
    json root = moving();
    root["accessors"][accessor].erase("bufferView");
    root["accessors"][accessor].erase("byteOffset");
    return loadedFrom(root);
}

std::vector<glm::vec3> corners(const Scene& scene) {
    if (scene.instances.empty()) return {};
    return poseAt(scene, 0.5).deformed.at(0).positions;
}

using Corners = std::vector<glm::vec3>;

}  // namespace

TEST(SceneAccessor, WithAllItsViews) {
    EXPECT_EQ(corners(loadedFrom(moving())), (Corners{{7, 0, 1}, {8, 0, 1}, {7, 2, 1}}));
}

TEST(SceneAccessor, PositionsAreZeros) {
    EXPECT_EQ(corners(withoutView(0)), (Corners{{7, 0, 1}, {7, 0, 1}, {7, 0, 1}}));
}

TEST(SceneAccessor, IndicesAreZeros) {
    const Scene scene = withoutView(1);
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].primitives[0].indices, (std::vector<std::uint32_t>{0, 0, 0}));
}

TEST(SceneAccessor, JointsAreZeros) {  // the first joint, which stands still
    EXPECT_EQ(corners(withoutView(2)), (Corners{{0, 0, 1}, {1, 0, 1}, {0, 2, 1}}));
}

TEST(SceneAccessor, WeightsAreZeros) {  // nothing weighs: as without weights of any use, the first joint has it all
    EXPECT_EQ(corners(withoutView(3)).size(), 3u);
}

TEST(SceneAccessor, MorphTargetsAreZeros) {
    EXPECT_EQ(corners(withoutView(4)), (Corners{{7, 0, 0}, {8, 0, 0}, {7, 2, 0}}));
}

TEST(SceneAccessor, TimesAreZeros) {
    json root = moving();
    root["accessors"][5] = json::parse(R"({"componentType":5126,"count":1,"type":"SCALAR"})");
    root["accessors"][6]["count"] = 1;
    EXPECT_EQ(corners(loadedFrom(root)).at(0), glm::vec3(7, 0, 1));
}

TEST(SceneAccessor, ValuesOfAnimationsAreZeros) {
    EXPECT_EQ(corners(withoutView(6)), (Corners{{0, 0, 1}, {1, 0, 1}, {0, 2, 1}}));
}

TEST(SceneAccessor, InverseBindMatricesAreZeros) {  // all vertices fall into the origin
    EXPECT_EQ(corners(withoutView(7)), (Corners{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}));
}

TEST(SceneAccessor, NormalsAreZerosAndComputedAnew) {
    const Scene scene = withoutView(9);
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].primitives[0].normals.at(0), glm::vec3(0, 0, 1));
}

// Sparse values stand on zeros: here the last of three, a VEC3 of floats.
TEST(SceneAccessor, SparseStandsOnZeros) {
    for (int accessor : {0, 4}) {
        json root = moving();
        json& changed = root["accessors"][accessor];
        changed = json::parse(R"({"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,
            "indices":{"bufferView":0,"byteOffset":40,"componentType":5123},
            "values":{"bufferView":0,"byteOffset":148}}})");
        const Corners expected =
            accessor == 0 ? Corners{{7, 0, 1}, {7, 0, 1}, {14, 0, 1}} : Corners{{7, 0, 0}, {8, 0, 0}, {14, 2, 0}};
        EXPECT_EQ(corners(loadedFrom(root)), expected) << accessor;
    }
    json root = moving();  // of indices: 0 0 2
    root["accessors"][1] = json::parse(R"({"componentType":5123,"count":3,"type":"SCALAR","sparse":{"count":1,
        "indices":{"bufferView":0,"byteOffset":40,"componentType":5123},"values":{"bufferView":0,"byteOffset":40}}})");
    EXPECT_EQ(loadedFrom(root).meshes.at(0).primitives.at(0).indices, (std::vector<std::uint32_t>{0, 0, 1}));
}

// No bytes vouch for such a count.
TEST(SceneAccessor, ManyZerosAreRefused) {
    const auto refused = [](std::uint64_t count, int meshes) {
        json root = json::parse(R"({"asset":{"version":"2.0"},"accessors":[{"componentType":5126,"type":"VEC3"}]})");
        root["accessors"][0]["count"] = count;
        for (int i = 0; i < meshes; ++i)
            root["meshes"].push_back(json::parse(R"({"primitives":[{"attributes":{"POSITION":0}}]})"));
        Scene scene;
        const gnomon::Result result = loadText(root.dump(), scene);
        EXPECT_FALSE(result.ok());
        EXPECT_NE(std::string(result.message()).find("without a bufferView"), std::string::npos) << result.message();
    };
    refused(4000000000u, 1);
    refused(18446744073709551615u, 1);
    if (std::getenv("GNOMON_QUICK") == nullptr) refused(4000000u, 20);  // the sum; a minute with sanitizers
}
