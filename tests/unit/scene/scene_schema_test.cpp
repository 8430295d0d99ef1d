// Values of a wrong type: each property that the loader reads gets each wrong kind of value, and must be named.
#include <nlohmann/json.hpp>

#include "gltf_files.h"

using namespace scene_tests;
using nlohmann::json;

namespace {

// One of everything, and all of it drawn.
json everything() {
    std::vector<std::uint8_t> bytes;
    append<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 2, 0});                  // 0: positions, the morph target's too
    append<std::uint16_t>(bytes, {0, 1, 2, 0});                         // 36: indices
    append<std::uint8_t>(bytes, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});  // 44: joints
    append<float>(bytes, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});         // 56: weights
    append<float>(bytes, {0, 1});                                       // 104: times
    append<float>(bytes, {0, 0, 0, 1, 0, 0});                           // 112: moves
    append<float>(bytes, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    json root = json::parse(R"({
      "asset":{"version":"2.0","minVersion":"2.0"},
      "extensionsUsed":["KHR_lights_punctual"],"extensionsRequired":["KHR_lights_punctual"],
      "scene":0,"scenes":[{"name":"s","nodes":[0]}],
      "nodes":[
        {"name":"top","children":[1,2,3,4,5],"translation":[0,0,0],"rotation":[0,0,0,1],"scale":[1,1,1]},
        {"mesh":0,"skin":0,"weights":[0.5]},{"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]},
        {"camera":0},{"camera":1},{"extensions":{"KHR_lights_punctual":{"light":0}}}],
      "meshes":[{"name":"m","weights":[0.25],"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3},
        "indices":1,"material":0,"mode":4,"targets":[{"POSITION":0}],"extensions":{}}]}],
      "skins":[{"name":"k","joints":[2],"inverseBindMatrices":6}],
      "animations":[{"name":"a","samplers":[{"input":4,"output":5,"interpolation":"LINEAR"}],
        "channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}],
      "cameras":[{"name":"c","type":"perspective","perspective":{"yfov":1,"znear":0.1,"zfar":9,"aspectRatio":2}},
        {"type":"orthographic","orthographic":{"xmag":1,"ymag":1,"znear":0,"zfar":9}}],
      "images":[{"name":"i","uri":"missing.png","mimeType":"image/png"},{"bufferView":0}],
      "samplers":[{"wrapS":10497,"wrapT":33071,"magFilter":9729}],
      "textures":[{"sampler":0,"source":0}],
      "materials":[{"name":"mat","alphaMode":"MASK","alphaCutoff":0.5,"doubleSided":true,"emissiveFactor":[0,0,0],"extras":{"subsurface":true,"theirs":null},
        "pbrMetallicRoughness":{"baseColorFactor":[1,1,1,1],"metallicFactor":1,"roughnessFactor":1,
          "baseColorTexture":{"index":0,"texCoord":0,"extensions":{"KHR_texture_transform":
            {"offset":[0,0],"scale":[1,1],"rotation":0,"texCoord":0}}},
          "metallicRoughnessTexture":{"index":0,"texCoord":0}},
        "normalTexture":{"index":0,"texCoord":0,"scale":1},"emissiveTexture":{"index":0,"texCoord":0},
        "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":1},"KHR_materials_transmission":{},
          "KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[1,1,1,1],"glossinessFactor":1,
            "diffuseTexture":{"index":0,"texCoord":0,"extensions":{"KHR_texture_transform":{"offset":[0,0]}}}}}}],
      "extensions":{"KHR_lights_punctual":{"lights":[{"name":"l","type":"spot","color":[1,1,1],"intensity":1,
        "range":5,"spot":{"innerConeAngle":0.1,"outerConeAngle":0.5},
        "extras":{"shadowBiasMetres":0.001,"shadowFilter":"pcf","sourceRadius":0.1}}]}},
      "accessors":[
        {"bufferView":0,"byteOffset":0,"componentType":5126,"normalized":false,"count":3,"type":"VEC3",
         "sparse":{"count":1,"indices":{"bufferView":0,"byteOffset":36,"componentType":5123},
                   "values":{"bufferView":0,"byteOffset":0}}},
        {"bufferView":0,"byteOffset":36,"componentType":5123,"count":3,"type":"SCALAR"},
        {"bufferView":0,"byteOffset":44,"componentType":5121,"count":3,"type":"VEC4"},
        {"bufferView":0,"byteOffset":56,"componentType":5126,"count":3,"type":"VEC4"},
        {"bufferView":0,"byteOffset":104,"componentType":5126,"count":2,"type":"SCALAR"},
        {"bufferView":0,"byteOffset":112,"componentType":5126,"count":2,"type":"VEC3"},
        {"bufferView":0,"byteOffset":136,"componentType":5126,"count":1,"type":"MAT4"}],
      "bufferViews":[{"buffer":0,"byteOffset":0},{"buffer":0,"byteLength":12,"byteStride":12}]})");
    root["bufferViews"][0]["byteLength"] = bytes.size();
    root["buffers"] = json::array({json::parse(dataBuffer(bytes))});
    return root;
}

// "/materials/0/alphaMode" as messages have it: "materials[0].alphaMode".
std::string named(const std::string& pointer) {
    std::string out;
    for (std::size_t at = 1; at < pointer.size();) {
        const std::size_t end = std::min(pointer.find('/', at), pointer.size());
        const std::string part = pointer.substr(at, end - at);
        const bool index = part.find_first_not_of("0123456789") == std::string::npos;
        out += index ? "[" + part + "]" : (out.empty() ? "" : ".") + part;
        at = end + 1;
    }
    return out;
}

void expectNamed(const std::string& pointer, const json& wrong) {
    json root = everything();
    root[json::json_pointer(pointer)] = wrong;
    Scene scene;
    const gnomon::Result result = loadText(root.dump(), scene);
    ASSERT_FALSE(result.ok()) << "accepted: " << pointer << " = " << wrong;
    const std::string message = result.message();
    EXPECT_NE(message.find(": " + named(pointer) + " is "), std::string::npos) << message << "\nnot " << named(pointer);
    EXPECT_TRUE(message.ends_with(".")) << message;
}

void expectWrong(const std::vector<const char*>& pointers, const std::vector<const char*>& values) {
    for (const char* pointer : pointers) {
        EXPECT_TRUE(everything().contains(json::json_pointer(pointer))) << "not in the good file: " << pointer;
        for (const char* value : values) expectNamed(pointer, json::parse(value));
    }
}

}  // namespace

TEST(SceneSchema, EverythingIsGood) {
    Scene scene;
    const gnomon::Result result = loadText(everything().dump(), scene);
    ASSERT_TRUE(result.ok()) << result.message();
    expectSound(scene);
    EXPECT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.skins.size(), 1u);
    EXPECT_EQ(scene.animations.size(), 1u);
}

TEST(SceneSchema, Indices) {
    expectWrong({"/scene",
                 "/scenes/0/nodes/0",
                 "/nodes/0/children/1",
                 "/nodes/1/mesh",
                 "/nodes/1/skin",
                 "/nodes/3/camera",
                 "/nodes/5/extensions/KHR_lights_punctual/light",
                 "/meshes/0/primitives/0/attributes/POSITION",
                 "/meshes/0/primitives/0/indices",
                 "/meshes/0/primitives/0/material",
                 "/meshes/0/primitives/0/targets/0/POSITION",
                 "/skins/0/joints/0",
                 "/skins/0/inverseBindMatrices",
                 "/animations/0/samplers/0/input",
                 "/animations/0/samplers/0/output",
                 "/animations/0/channels/0/sampler",
                 "/animations/0/channels/0/target/node",
                 "/images/1/bufferView",
                 "/textures/0/sampler",
                 "/textures/0/source",
                 "/materials/0/pbrMetallicRoughness/baseColorTexture/index",
                 "/materials/0/normalTexture/texCoord",
                 "/accessors/0/bufferView",
                 "/accessors/0/sparse/indices/bufferView",
                 "/accessors/0/sparse/values/bufferView",
                 "/bufferViews/0/buffer",
                 "/materials/0/emissiveTexture/index",
                 "/materials/0/pbrMetallicRoughness/metallicRoughnessTexture/index",
                 "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/texCoord",
                 "/materials/0/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture/index"},
                {R"("0")", "0.5", "0.0", "-1", "true", "null", "[0]", "{}", "4294967296"});
}

TEST(SceneSchema, Counts) {
    expectWrong(
        {"/accessors/0/byteOffset", "/accessors/0/count", "/accessors/0/sparse/count",
         "/accessors/0/sparse/indices/byteOffset", "/accessors/0/sparse/values/byteOffset", "/bufferViews/0/byteOffset",
         "/bufferViews/0/byteLength", "/bufferViews/1/byteStride", "/buffers/0/byteLength"},
        {R"("4")", "0.5", "-4", "false", "null", "[0]", "{}"});
}

TEST(SceneSchema, Numbers) {
    expectWrong({"/cameras/0/perspective/yfov",
                 "/cameras/0/perspective/znear",
                 "/cameras/0/perspective/zfar",
                 "/cameras/0/perspective/aspectRatio",
                 "/cameras/1/orthographic/xmag",
                 "/cameras/1/orthographic/ymag",
                 "/cameras/1/orthographic/znear",
                 "/cameras/1/orthographic/zfar",
                 "/materials/0/alphaCutoff",
                 "/materials/0/pbrMetallicRoughness/metallicFactor",
                 "/materials/0/pbrMetallicRoughness/roughnessFactor",
                 "/materials/0/normalTexture/scale",
                 "/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength",
                 "/materials/0/extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor",
                 "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/rotation",
                 "/extensions/KHR_lights_punctual/lights/0/intensity",
                 "/extensions/KHR_lights_punctual/lights/0/range",
                 "/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle",
                 "/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle",
                 "/nodes/1/weights/0",
                 "/meshes/0/weights/0"},
                {R"("1")", "true", "null", "[1]", "{}"});
}

TEST(SceneSchema, NumbersOfAFixedCount) {
    expectWrong({"/nodes/0/translation", "/nodes/0/scale", "/materials/0/emissiveFactor",
                 "/extensions/KHR_lights_punctual/lights/0/color"},
                {R"("0 0 0")", "[]", "[1,1]", "[1,1,1,1]", R"([1,"1",1])", "[1,null,1]", "7", "null", R"({"x":1})"});
    expectWrong({"/nodes/0/rotation", "/materials/0/pbrMetallicRoughness/baseColorFactor",
                 "/materials/0/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor"},
                {R"("red")", "[]", "[1,1,1]", "[0,0,0,0,1]", R"([1,1,1,"1"])", "1", "null", "{}"});
    expectWrong({"/nodes/2/matrix"}, {R"("identity")", "[1,0,0,0]", "1", "null", "{}"});
    for (const char* name : {"offset", "scale"})
        expectWrong(
            {(std::string("/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/") +
              name)
                 .c_str()},
            {R"("1 1")", "[1]", "[1,1,1]", R"(["1",1])", "1", "null", "{}"});
}

// What is ours in `extras` has its type; what is not may be anything, and so may `extras` as a whole.
TEST(SceneSchema, Extras) {
    expectWrong({"/materials/0/extras/subsurface"}, {R"("true")", "1", "0.5", "null", "[true]", "{}"});
    expectWrong({"/extensions/KHR_lights_punctual/lights/0/extras/shadowBiasMetres"},
                {R"("2 mm")", "true", "null", "[0.002]", "{}"});
    expectWrong({"/extensions/KHR_lights_punctual/lights/0/extras/sourceRadius"},
                {R"("2 mm")", "true", "null", "[0.002]", "{}"});
    expectWrong({"/extensions/KHR_lights_punctual/lights/0/extras/shadowFilter"},
                {R"("PCF")", R"("")", "1", "null", "[]", "{}"});
    for (const char* any : {"7", R"("subsurface")", "null", "[1]", R"({"bias":"a"})"}) {
        json root = everything();
        root["materials"][0]["extras"] = json::parse(any);
        root["extensions"]["KHR_lights_punctual"]["lights"][0]["extras"] = json::parse(any);
        root["nodes"][0]["extras"] = json::parse(any);
        Scene scene;
        EXPECT_TRUE(loadText(root.dump(), scene).ok()) << any;
    }
}

TEST(SceneSchema, TextsAndWords) {
    expectWrong({"/scenes/0/name", "/nodes/0/name", "/meshes/0/name", "/skins/0/name", "/animations/0/name",
                 "/cameras/0/name", "/images/0/name", "/images/0/uri", "/materials/0/name", "/buffers/0/uri",
                 "/extensions/KHR_lights_punctual/lights/0/name", "/animations/0/channels/0/target/path",
                 "/extensionsUsed/0", "/extensionsRequired/0", "/asset/version", "/asset/minVersion"},
                {"7", "true", "null", "[]", "{}"});
    expectWrong({"/materials/0/alphaMode", "/cameras/0/type", "/animations/0/samplers/0/interpolation",
                 "/accessors/0/type", "/extensions/KHR_lights_punctual/lights/0/type"},
                {"7", "true", "null", "[]", "{}", R"("")", R"("mask")", R"("Linear")", R"("Perspective")", R"("vec3")",
                 R"("Spot")"});
}

TEST(SceneSchema, NumbersThatStandForWords) {
    expectWrong(
        {"/meshes/0/primitives/0/mode", "/accessors/0/componentType", "/accessors/0/sparse/indices/componentType",
         "/samplers/0/wrapS", "/samplers/0/wrapT", "/samplers/0/magFilter"},
        {"-1", "7777", "4.5", R"("4")", "null", "[]", "{}"});
    expectWrong({"/accessors/0/sparse/indices/componentType"}, {"5126"});
}

TEST(SceneSchema, Booleans) {
    expectWrong({"/materials/0/doubleSided", "/accessors/0/normalized"}, {"1", "0", R"("true")", "null", "[]", "{}"});
}

TEST(SceneSchema, ObjectsAndArrays) {
    expectWrong({"/asset",
                 "/materials/0/pbrMetallicRoughness",
                 "/materials/0/normalTexture",
                 "/materials/0/emissiveTexture",
                 "/materials/0/pbrMetallicRoughness/baseColorTexture",
                 "/materials/0/extensions",
                 "/materials/0/extensions/KHR_materials_emissive_strength",
                 "/materials/0/extensions/KHR_materials_transmission",
                 "/cameras/0/perspective",
                 "/cameras/1/orthographic",
                 "/nodes/5/extensions",
                 "/nodes/5/extensions/KHR_lights_punctual",
                 "/extensions",
                 "/extensions/KHR_lights_punctual",
                 "/extensions/KHR_lights_punctual/lights/0",
                 "/extensions/KHR_lights_punctual/lights/0/spot",
                 "/accessors/0/sparse",
                 "/accessors/0/sparse/indices",
                 "/accessors/0/sparse/values",
                 "/meshes/0/primitives/0",
                 "/meshes/0/primitives/0/attributes",
                 "/meshes/0/primitives/0/targets/0",
                 "/meshes/0/primitives/0/extensions",
                 "/animations/0/samplers/0",
                 "/animations/0/channels/0",
                 "/animations/0/channels/0/target",
                 "/nodes/1",
                 "/meshes/0",
                 "/accessors/0",
                 "/images/0",
                 "/scenes/0"},
                {"7", R"("x")", "true", "null", "[]"});
    expectWrong({"/nodes",
                 "/meshes",
                 "/accessors",
                 "/bufferViews",
                 "/buffers",
                 "/cameras",
                 "/images",
                 "/materials",
                 "/samplers",
                 "/scenes",
                 "/skins",
                 "/textures",
                 "/animations",
                 "/scenes/0/nodes",
                 "/nodes/0/children",
                 "/nodes/1/weights",
                 "/meshes/0/weights",
                 "/meshes/0/primitives",
                 "/meshes/0/primitives/0/targets",
                 "/skins/0/joints",
                 "/animations/0/samplers",
                 "/animations/0/channels",
                 "/extensionsUsed",
                 "/extensionsRequired",
                 "/extensions/KHR_lights_punctual/lights"},
                {"7", R"("x")", "false", "null", R"({"0":1})"});
}

TEST(SceneSchema, WhatIsNotReadMayBeAnything) {
    for (const char* pointer : {"/asset/generator", "/asset/extras", "/accessors/0/min", "/bufferViews/0/target",
                                "/materials/0/occlusionTexture", "/materials/0/extras", "/nodes/0/extras",
                                "/materials/0/something", "/nodes/0/extensions", "/skins/0/skeleton",
                                "/samplers/0/minFilter", "/extensions/VENDOR_thing", "/images/0/mimeType"}) {
        json root = everything();
        root[json::json_pointer(pointer)] =
            std::string(pointer).ends_with("extensions") ? json{{"VENDOR_thing", "x"}} : json("anything");
        Scene scene;
        const gnomon::Result result = loadText(root.dump(), scene);
        EXPECT_TRUE(result.ok()) << pointer << ": " << result.message();
    }
}

// Long values are cut short, and what is no UTF-8 does no harm.
TEST(SceneSchema, MessagesStayShort) {
    json root = everything();
    root["materials"][0]["alphaMode"] = std::string(5000, 'x');
    Scene scene;
    const gnomon::Result result = loadText(root.dump(), scene);
    ASSERT_FALSE(result.ok());
    EXPECT_LT(std::strlen(result.message()), 250u) << result.message();
}

TEST(SceneSchema, VersionsOfTheFormat) {
    const auto messageFor = [](const std::string& asset, const std::string& more = "") {
        Scene scene;
        const gnomon::Result result = loadText("{" + asset + more + "}", scene);
        EXPECT_FALSE(result.ok()) << asset;
        return std::string(result.message());
    };
    const auto expectSays = [](const std::string& message, const std::string& part) {
        EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks: " << part;
    };
    const std::string old = R"(,"accessors":{"a":{}},"meshes":{"m":{}},"programs":{},"techniques":{})";
    expectSays(messageFor(R"("asset":{"version":"1.0"})", old), "glTF version 1.0; only 2.0 is read.");
    expectSays(messageFor(R"("asset":{"version":"1.0.1"})", old), "glTF version 1.0.1; only 2.0 is read.");
    expectSays(messageFor(R"("asset":{"version":1})", old), "glTF version 1; only 2.0 is read.");
    expectSays(messageFor(R"("asset":{"version":0.8})", old), "glTF version 0.8; only 2.0 is read.");
    expectSays(messageFor(R"("asset":{"generator":"x"})", old), "glTF version 1.0; only 2.0 is read.");
    expectSays(messageFor(R"("accessors":{},"meshes":{},"techniques":{})"), "glTF version 1.0; only 2.0 is read.");
    expectSays(messageFor(R"("asset":{"version":"3.0"})"), "glTF version 3.0; only 2.0 is read.");
    expectSays(messageFor(R"("asset":{"version":"20.0"})"), "glTF version 20.0; only 2.0 is read.");
    for (const char* odd : {R"("2")", R"("2.")", R"("2.x")", R"("")", R"("two")", R"("2.0beta")", R"(" 2.0")"})
        expectSays(messageFor(std::string(R"("asset":{"version":)") + odd + "}"), "asset.version is ");
    expectSays(messageFor(R"("asset":{"version":2.0})"), "asset.version is 2.0, not a text");
    expectSays(messageFor(R"("asset":{})"), "gives no glTF version; only 2.0 is read.");
    expectSays(messageFor(R"("nodes":[])"), "gives no glTF version; only 2.0 is read.");
    expectSays(messageFor(R"("asset":{"version":"2.1","minVersion":"2.1"})"),
               "asks for glTF version 2.1 at least; only 2.0 is read.");
    expectSays(messageFor(R"("asset":{"version":"2.0","minVersion":"2.x"})"), "asset.minVersion is ");
    std::string container = triangleGlb();
    container[4] = 1;  // the binary form of glTF 1.0
    Scene scene;
    const gnomon::Result result = loadText(container, scene);
    ASSERT_FALSE(result.ok());
    expectSays(result.message(), "glTF version 1.0; only 2.0 is read.");
    for (const char* good : {R"({"version":"2.0"})", R"({"version":"2.1"})", R"({"version":"2.1","minVersion":"2.0"})"})
        EXPECT_TRUE(loadText(replaced(triangleGltf(), R"({"version":"2.0"})", good), scene).ok()) << good;
}
