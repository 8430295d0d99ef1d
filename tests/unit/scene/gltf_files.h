#pragma once
// Tiny glTF files made in memory for the tests: one triangle, and ways to damage it.

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "scene/load_gltf.h"

namespace scene_tests {

using namespace gnomon::renderer;

inline std::string base64(const std::vector<std::uint8_t>& bytes) {
    static const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k) out += k <= bytes.size() - i ? digits[bits >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

template <class T>
void append(std::vector<std::uint8_t>& bytes, std::initializer_list<T> values) {
    for (T value : values) {
        const std::size_t offset = bytes.size();
        bytes.resize(offset + sizeof(T));
        std::memcpy(bytes.data() + offset, &value, sizeof(T));
    }
}

// Positions (36 bytes), indices as u16 (6 bytes and 2 of padding).
inline std::vector<std::uint8_t> triangleBytes() {
    std::vector<std::uint8_t> bytes;
    append<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 2, 0});
    append<std::uint16_t>(bytes, {0, 1, 2, 0});
    return bytes;
}

// JSON of one triangle around the given buffer object; `more` goes into the root, `primitive` into the primitive.
inline std::string triangleJson(const std::string& buffer, const std::string& more = "",
                                const std::string& primitive = "", const std::string& nodes = R"([{"mesh":0}])") {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":)" + nodes +
           R"(,"meshes":[{"name":"tri","primitives":[{"attributes":{"POSITION":0},"indices":1)" + primitive +
           R"(}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
           R"({"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],)"
           R"("bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],"buffers":[)" +
           buffer + "]" + more + "}";
}

inline std::string dataBuffer(const std::vector<std::uint8_t>& bytes) {
    return R"({"byteLength":)" + std::to_string(bytes.size()) + R"(,"uri":"data:application/octet-stream;base64,)" +
           base64(bytes) + "\"}";
}

inline std::string triangleGltf(const std::string& more = "", const std::string& primitive = "",
                                const std::string& nodes = R"([{"mesh":0}])") {
    return triangleJson(dataBuffer(triangleBytes()), more, primitive, nodes);
}

inline std::string glb(std::string json, const std::vector<std::uint8_t>& binary) {
    while (json.size() % 4 != 0) json += ' ';
    std::vector<std::uint8_t> bytes;
    append<std::uint32_t>(bytes, {0x46546C67, 2, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + binary.size()),
                                  static_cast<std::uint32_t>(json.size()), 0x4E4F534A});
    bytes.insert(bytes.end(), json.begin(), json.end());
    append<std::uint32_t>(bytes, {static_cast<std::uint32_t>(binary.size()), 0x004E4942});
    bytes.insert(bytes.end(), binary.begin(), binary.end());
    return std::string(bytes.begin(), bytes.end());
}

inline std::string triangleGlb() {
    return glb(triangleJson(R"({"byteLength":44})"), triangleBytes());
}

// One point light named 'lamp' and nothing else; `more` goes into the light.
inline std::string lightGltf(const std::string& more) {
    return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],)"
           R"("nodes":[{"extensions":{"KHR_lights_punctual":{"light":0}}}],)"
           R"("extensions":{"KHR_lights_punctual":{"lights":[{"name":"lamp","type":"point")" +
           more + "}]}}}";
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << "nothing to replace: " << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

inline gnomon::Result loadText(const std::string& text, Scene& scene) {
    static std::atomic<int> number = 0;
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    const std::filesystem::path path =
        std::filesystem::path(testing::TempDir()) /
        (std::string("gnomon_scene_") + test->name() + std::to_string(number++) + ".gltf");
    std::ofstream(path, std::ios::binary) << text;
    const gnomon::Result result = loadGltf(path, scene);
    std::filesystem::remove(path);
    return result;
}

// What every loaded scene promises.
inline void expectSound(const Scene& scene) {
    ASSERT_FALSE(scene.materials.empty());
    EXPECT_TRUE(!scene.instances.empty() || !scene.lights.empty());
    for (const Instance& instance : scene.instances) {
        ASSERT_LT(instance.mesh, scene.meshes.size());
        EXPECT_FALSE(scene.meshes[instance.mesh].primitives.empty());
        ASSERT_TRUE(instance.node == kNone || instance.node < scene.nodes.size());
        if (instance.skin == kNone) continue;
        ASSERT_LT(instance.skin, scene.skins.size());
        for (const Primitive& p : scene.meshes[instance.mesh].primitives) {
            ASSERT_FALSE(p.joints.empty());
            for (const glm::u16vec4& j : p.joints)
                for (int c = 0; c < 4; ++c) ASSERT_LT(j[c], scene.skins[instance.skin].joints.size());
        }
    }
    for (std::size_t n = 0; n < scene.nodes.size(); ++n)
        ASSERT_TRUE(scene.nodes[n].parent == kNone || scene.nodes[n].parent < n);
    for (const Skin& skin : scene.skins) {
        ASSERT_FALSE(skin.joints.empty());
        ASSERT_EQ(skin.joints.size(), skin.jointFromMesh.size());
        for (std::uint32_t joint : skin.joints) ASSERT_LT(joint, scene.nodes.size());
    }
    for (const Animation& animation : scene.animations) {
        ASSERT_FALSE(animation.channels.empty());
        for (const AnimationChannel& c : animation.channels) {
            ASSERT_LT(c.node, scene.nodes.size());
            ASSERT_FALSE(c.times.empty());
            ASSERT_LE(c.times.back(), animation.durationSeconds);
            ASSERT_EQ(c.values.size() % c.times.size(), 0u);
        }
    }
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& p : mesh.primitives) {
            const std::size_t count = p.positions.size();
            ASSERT_LT(p.material, scene.materials.size());
            ASSERT_EQ(p.indices.size() % 3, 0u);
            ASSERT_FALSE(p.indices.empty());
            for (std::uint32_t index : p.indices) ASSERT_LT(index, count);
            for (const glm::vec3& v : p.positions) ASSERT_TRUE(std::isfinite(v.x + v.y + v.z));
            for (std::size_t size :
                 {p.normals.size(), p.tangents.size(), p.texcoords[0].size(), p.texcoords[1].size(), p.colours.size()})
                ASSERT_TRUE(size == 0 || size == count);
            ASSERT_TRUE(p.joints.size() == p.weights.size() && (p.joints.empty() || p.joints.size() == count));
            for (const MorphTarget& t : p.targets)
                for (std::size_t size : {t.positions.size(), t.normals.size(), t.tangents.size()})
                    ASSERT_TRUE(size == 0 || size == count);
            ASSERT_EQ(p.targets.size(), mesh.primitives.front().targets.size());
            ASSERT_TRUE(mesh.weights.empty() || mesh.weights.size() == p.targets.size());
            for (const glm::vec3& n : p.normals) ASSERT_NEAR(glm::length(n), 1.0f, 1.0e-3f);
        }
    for (const Material& m : scene.materials)
        for (const TextureUse* use :
             {&m.baseColourTexture, &m.metallicRoughnessTexture, &m.normalTexture, &m.emissiveTexture})
            ASSERT_TRUE(use->image == kNone || use->image < scene.images.size());
    for (const Image& image : scene.images) ASSERT_EQ(image.rgba8.size(), std::size_t(image.width) * image.height * 4);
    for (const SceneLight& light : scene.lights) ASSERT_NEAR(glm::length(light.direction), 1.0f, 1.0e-3f);
}

}  // namespace scene_tests
