// What a good file becomes.

#include <glm/gtc/constants.hpp>

#include "gltf_files.h"
#include "scene/pose.h"

using namespace scene_tests;

namespace {

Scene loaded(const std::string& text) {
    Scene scene;
    const gnomon::Result result = loadText(text, scene);
    EXPECT_TRUE(result.ok()) << result.message();
    expectSound(scene);
    return scene;
}

// A buffer object and accessors of one's own around one mesh. `accessors` and `views` are JSON arrays.
std::string custom(const std::vector<std::uint8_t>& bytes, const std::string& primitive, const std::string& accessors,
                   const std::string& views, const std::string& more = "", const std::string& node = R"({"mesh":0})") {
    return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[)" + node +
           R"(],"meshes":[{"primitives":[)" + primitive + R"(]}],"accessors":)" + accessors + R"(,"bufferViews":)" +
           views + R"(,"buffers":[)" + dataBuffer(bytes) + "]" + more + "}";
}

const char* const kImage =
    R"("images":[{"uri":"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAADUlEQVR4nGP4zwAE/wEHAAH/4iOeWQAAAABJRU5ErkJggg=="}])";

}  // namespace

TEST(SceneLoad, Triangle) {
    for (const std::string& text : {triangleGltf(), triangleGlb()}) {
        const Scene scene = loaded(text);
        EXPECT_EQ(triangleCount(scene), 1u);
        const Primitive& p = scene.meshes.at(0).primitives.at(0);
        EXPECT_EQ(p.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}));
        EXPECT_EQ(p.indices, (std::vector<std::uint32_t>{0, 1, 2}));
        EXPECT_EQ(worldBounds(scene).max, glm::vec3(1, 2, 0));
        EXPECT_EQ(scene.materials.at(0).roughness, 1.0f);
        EXPECT_TRUE(scene.notes.empty());
    }
}

TEST(SceneLoad, HierarchySharedMeshAndMirror) {
    const Scene scene = loaded(triangleGltf("", "",
                                            R"([{"translation":[10,0,0],"children":[1,2]},{"mesh":0,"scale":[-1,1,1]},)"
                                            R"({"mesh":0,"rotation":[0,0,0.70710678,0.70710678]}])"));
    ASSERT_EQ(scene.instances.size(), 2u);
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(triangleCount(scene), 2u);
    EXPECT_TRUE(isMirrored(scene.instances[0]));
    EXPECT_FALSE(isMirrored(scene.instances[1]));
    EXPECT_NEAR(worldBounds(scene).min.x, 8.0f, 1.0e-5f);  // the turned one: y = 2 becomes x = -2
    EXPECT_NEAR(worldBounds(scene).max.x, 10.0f, 1.0e-5f);
}

TEST(SceneLoad, StripsFansAndNoIndices) {
    std::vector<std::uint8_t> bytes;
    append<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
    const std::string accessors = R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}])";
    const std::string views = R"([{"buffer":0,"byteLength":48}])";
    const auto indices = [&](const char* mode) {
        const Scene scene = loaded(
            custom(bytes, std::string(R"({"attributes":{"POSITION":0},"mode":)") + mode + "}", accessors, views));
        return scene.meshes.at(0).primitives.at(0).indices;
    };
    EXPECT_EQ(indices("5"), (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2}));
    EXPECT_EQ(indices("6"), (std::vector<std::uint32_t>{1, 2, 0, 2, 3, 0}));
    EXPECT_EQ(indices("4"), (std::vector<std::uint32_t>{0, 1, 2}));  // the incomplete second one is left out
}

TEST(SceneLoad, QuantisedStridedAndSparse) {
    std::vector<std::uint8_t>
        bytes;  // i16 normalised positions, 8 bytes apart; u8 indices; sparse override of vertex 2
    append<std::int16_t>(bytes, {0, 0, 0, 0, 32767, 0, 0, 0, 0, 0, 0, 0});
    append<std::uint8_t>(bytes, {2, 0, 1, 2});  // index list 2,0,1 then the sparse index 2
    append<std::int16_t>(bytes, {0, -32767, 0, 0});
    const Scene scene = loaded(
        custom(bytes, R"({"attributes":{"POSITION":0},"indices":1})",
               R"([{"bufferView":0,"componentType":5122,"normalized":true,"count":3,"type":"VEC3","sparse":{"count":1,)"
               R"("indices":{"bufferView":1,"byteOffset":3,"componentType":5121},"values":{"bufferView":2}}},)"
               R"({"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}])",
               R"([{"buffer":0,"byteLength":24,"byteStride":8},{"buffer":0,"byteOffset":24,"byteLength":4},)"
               R"({"buffer":0,"byteOffset":28,"byteLength":8}])",
               R"(,"extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"])"));
    const Primitive& p = scene.meshes.at(0).primitives.at(0);
    EXPECT_EQ(p.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, -1, 0}}));
    EXPECT_EQ(p.indices, (std::vector<std::uint32_t>{2, 0, 1}));
}

TEST(SceneLoad, UnusedVerticesAreDropped) {
    std::vector<std::uint8_t> bytes;
    append<float>(bytes, {9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0});
    append<std::uint32_t>(bytes, {3, 1, 2});
    const Scene scene =
        loaded(custom(bytes, R"({"attributes":{"POSITION":0},"indices":1})",
                      R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
                      R"({"bufferView":0,"byteOffset":48,"componentType":5125,"count":3,"type":"SCALAR"}])",
                      R"([{"buffer":0,"byteLength":60}])"));
    EXPECT_EQ(scene.meshes.at(0).primitives.at(0).positions.size(), 3u);
    EXPECT_EQ(scene.meshes.at(0).primitives.at(0).indices, (std::vector<std::uint32_t>{2, 0, 1}));
}

TEST(SceneLoad, Lights) {
    const Scene scene = loaded(
        R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0,1]}],"nodes":[)"
        R"({"name":"a","translation":[1,2,3],"rotation":[-0.70710678,0,0,0.70710678],"extensions":{"KHR_lights_punctual":{"light":0}}},)"
        R"({"extensions":{"KHR_lights_punctual":{"light":1}}}],)"
        R"("extensionsRequired":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[)"
        R"({"type":"spot","intensity":7,"range":5,"color":[1,0.5,0],"spot":{"innerConeAngle":0.1,"outerConeAngle":0.4}},)"
        R"({"type":"directional","intensity":0}]}}})");
    ASSERT_EQ(scene.lights.size(), 2u);
    const SceneLight& spot = scene.lights[0];
    EXPECT_EQ(spot.kind, LightKind::Spot);
    EXPECT_EQ(spot.position, glm::vec3(1, 2, 3));
    EXPECT_NEAR(spot.direction.y, -1.0f, 1.0e-5f);  // -z turned by -90 degrees around x points down
    EXPECT_EQ(spot.intensity, 7.0f);
    EXPECT_EQ(spot.rangeMetres, 5.0f);
    EXPECT_FLOAT_EQ(spot.outerConeAngle, 0.4f);
    EXPECT_EQ(scene.lights[1].kind, LightKind::Directional);
    EXPECT_EQ(scene.notes.size(), 1u);  // the dark light
}

TEST(SceneLoad, LightsMayStateTheirBias) {
    const auto biasOf = [](const std::string& extras) { return loaded(lightGltf(extras)).lights.at(0).biasMetres; };
    EXPECT_FLOAT_EQ(biasOf(R"(,"extras":{"shadowBiasMetres":0.005})"), 0.005f);
    EXPECT_EQ(biasOf(R"(,"extras":{"shadowBiasMetres":0})"), 0.0f);
    const auto sourceOf = [](const std::string& extras) { return loaded(lightGltf(extras)).lights.at(0).sourceRadius; };
    EXPECT_FLOAT_EQ(sourceOf(R"(,"extras":{"sourceRadius":0.04})"), 0.04f);
    EXPECT_EQ(sourceOf(""), 0.0f);
    const float renderersOwn = SceneLight().biasMetres;
    EXPECT_LT(renderersOwn, 0.0f);
    EXPECT_EQ(biasOf(""), renderersOwn);
    EXPECT_EQ(biasOf(R"(,"extras":{"bias":1})"), renderersOwn);
    EXPECT_EQ(biasOf(R"(,"extras":7)"), renderersOwn);
}

TEST(SceneLoad, MaterialTexturesAndTransform) {
    const Scene scene = loaded(triangleGltf(
        std::string(",") + kImage +
            R"(,"samplers":[{"wrapS":33648,"wrapT":33071,"magFilter":9728}],"textures":[{"source":0,"sampler":0},{"source":0}],)"
            R"("materials":[{"alphaMode":"MASK","alphaCutoff":0.25,"doubleSided":true,"extras":{"subsurface":true},)"
            R"("emissiveFactor":[1,0,0],"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":5}},)"
            R"("emissiveTexture":{"index":1,"extensions":{"KHR_texture_transform":{"offset":[0,1],"rotation":1.57079632679,)"
            R"("scale":[0.5,0.5],"texCoord":1}}},"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])",
        R"(,"material":0)"));
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(m.alphaMode, AlphaMode::Mask);
    EXPECT_EQ(m.alphaCutoff, 0.25f);
    EXPECT_TRUE(m.doubleSided && m.subsurface);
    EXPECT_EQ(m.emissive, glm::vec3(5, 0, 0));
    ASSERT_EQ(scene.images.size(), 2u);  // plain, and with its mirrored copy
    const Image& mirrored = scene.images[m.baseColourTexture.image];
    ASSERT_EQ(mirrored.width, 4u);
    const std::vector<std::uint8_t> red{255, 0, 0, 255}, blue{0, 0, 255, 255};
    const auto texel = [&](std::size_t x) {
        return std::vector<std::uint8_t>(&mirrored.rgba8[4 * x], &mirrored.rgba8[4 * x] + 4);
    };
    EXPECT_EQ(texel(0), red);
    EXPECT_EQ(texel(1), blue);
    EXPECT_EQ(texel(2), blue);
    EXPECT_EQ(texel(3), red);
    EXPECT_EQ(m.baseColourTexture.uvTransform * glm::vec2(1, 1), glm::vec2(0.5f, 1));
    EXPECT_FALSE(m.baseColourTexture.linear);
    EXPECT_TRUE(m.baseColourTexture.repeatU);
    EXPECT_FALSE(m.baseColourTexture.repeatV);
    // The extension's own example: the lower left quadrant (v points down), turned by 90 degrees.
    const TextureUse& e = m.emissiveTexture;
    EXPECT_EQ(e.texcoord, 1u);
    for (const glm::vec2 uv : {glm::vec2(0.1f, 0.2f), glm::vec2(0.9f, 0.8f)}) {
        const glm::vec2 at = e.uvTransform * uv + e.uvOffset;
        EXPECT_NEAR(at.x, 0.5f * uv.y, 1.0e-6f);
        EXPECT_NEAR(at.y, 1.0f - 0.5f * uv.x, 1.0e-6f);
    }
}

TEST(SceneLoad, SkinAtItsStoredPose) {
    std::vector<std::uint8_t> bytes;
    append<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 1, 0});
    append<std::uint8_t>(bytes, {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
    append<float>(bytes, {1, 0, 0, 0, 0, 2, 0, 0, 0.5f, 0.5f, 0, 0});
    const Scene scene = loaded(custom(
        bytes, R"({"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}})",
        R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":0,"byteOffset":36,"componentType":5121,)"
        R"("count":3,"type":"VEC4"},{"bufferView":0,"byteOffset":48,"componentType":5126,"count":3,"type":"VEC4"}])",
        R"([{"buffer":0,"byteLength":96}])", R"(,"skins":[{"joints":[1,2]}])",
        R"({"mesh":0,"skin":0,"translation":[100,0,0]},{"translation":[0,0,1]},{"translation":[0,0,3]})"));
    const Pose rest = restPose(scene);
    EXPECT_EQ(rest.deformed.at(0).positions,
              (std::vector<glm::vec3>{{0, 0, 1}, {1, 0, 3}, {0, 1, 2}}));  // the node's own transform does not count
    EXPECT_EQ(scene.instances.at(0).worldFromObject, glm::dmat4(1.0));
}

TEST(SceneLoad, CamerasPerspectiveAndOrthographic) {
    const Scene scene = loaded(triangleGltf(
        R"(,"cameras":[{"type":"perspective","perspective":{"yfov":0.7,"znear":0.1}},)"
        R"({"type":"orthographic","orthographic":{"xmag":2,"ymag":3,"znear":0,"zfar":50}}])",
        "",
        R"([{"mesh":0,"children":[1,2]},{"name":"eye","camera":0,"translation":[0,0,9],"scale":[2,2,2]},{"camera":1}])"));
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[0].name, "eye");
    EXPECT_EQ(scene.cameras[0].worldFromCamera[0], glm::vec4(1, 0, 0, 0));  // the scale is gone
    EXPECT_TRUE(std::isinf(scene.cameras[0].farMetres));
    EXPECT_EQ(scene.cameras[0].widthOverHeight, 0.0f);  // none given
    EXPECT_TRUE(scene.cameras[1].orthographic);
    EXPECT_EQ(scene.cameras[1].orthographicHalfHeight, 3.0f);
    EXPECT_FLOAT_EQ(scene.cameras[1].widthOverHeight, 2.0f / 3.0f);
}

TEST(SceneLoad, CamerasKeepTheirAspect) {
    const auto cameraOf = [](const std::string& camera) {
        return loaded(triangleGltf(R"(,"cameras":[)" + camera + "]", "", R"([{"mesh":0,"camera":0}])"));
    };
    const Scene wide = cameraOf(R"({"type":"perspective","perspective":{"yfov":0.7,"znear":0.1,"aspectRatio":3}})");
    EXPECT_EQ(wide.cameras.at(0).widthOverHeight, 3.0f);
    const Scene flipped = cameraOf(R"({"type":"orthographic","orthographic":{"xmag":-4,"ymag":2,"znear":0,"zfar":5}})");
    EXPECT_EQ(flipped.cameras.at(0).widthOverHeight, 2.0f);
    for (const char* bad : {R"({"type":"perspective","perspective":{"yfov":0.7,"znear":0.1,"aspectRatio":-3}})",
                            R"({"type":"orthographic","orthographic":{"xmag":0,"ymag":2,"znear":0,"zfar":5}})"}) {
        const Scene scene = cameraOf(bad);
        EXPECT_TRUE(scene.cameras.empty()) << bad;
        EXPECT_EQ(scene.notes.size(), 1u) << bad;
    }
}
