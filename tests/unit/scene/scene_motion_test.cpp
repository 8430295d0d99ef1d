// Skins, morph targets and animations of files: what they become, what is refused, what is passed over.
#include <cmath>
#include <limits>
#include <random>

#include "gltf_files.h"
#include "scene/pose.h"

using namespace scene_tests;

namespace {

// A file put together from typed accessors.
class File {
public:
    int add(const std::string& type, const std::vector<float>& values, std::size_t components) {
        const std::size_t offset = bytes_.size();
        for (float v : values) append<float>(bytes_, {v});
        return accessor(type, 5126, offset, values.size() * 4, values.size() / components);
    }
    int addBytes(const std::string& type, const std::vector<std::uint8_t>& values, std::size_t components) {
        const std::size_t offset = bytes_.size();
        bytes_.insert(bytes_.end(), values.begin(), values.end());
        while (bytes_.size() % 4 != 0) bytes_.push_back(0);
        return accessor(type, 5121, offset, values.size(), values.size() / components);
    }
    std::string json(const std::string& rest) const {
        return R"({"asset":{"version":"2.0"},"accessors":[)" + accessors_ + R"(],"bufferViews":[)" + views_ +
               R"(],"buffers":[)" + dataBuffer(bytes_) + "]," + rest + "}";
    }

private:
    int accessor(const std::string& type, int componentType, std::size_t offset, std::size_t length,
                 std::size_t count) {
        const std::string comma = count_ == 0 ? "" : ",";
        accessors_ += comma + R"({"bufferView":)" + std::to_string(count_) + R"(,"componentType":)" +
                      std::to_string(componentType) + R"(,"count":)" + std::to_string(count) + R"(,"type":")" + type +
                      "\"}";
        views_ += comma + R"({"buffer":0,"byteOffset":)" + std::to_string(offset) + R"(,"byteLength":)" +
                  std::to_string(length) + "}";
        return count_++;
    }
    std::vector<std::uint8_t> bytes_;
    std::string accessors_, views_;
    int count_ = 0;
};

// Accessors of the file below.
enum : int { kPositions, kJoints, kWeights, kTarget, kTimes, kMoves, kTurns, kMorphs, kSplines };

struct Parts {
    std::string nodes = R"([{"children":[1,2,5]},{"name":"figure","mesh":0,"skin":0},{"name":"root","children":[3]},)"
                        R"({"name":"hand","translation":[0,1,0]},{"name":"idle"},{"name":"face","mesh":1}])";
    std::string skin = R"({"joints":[2,3]})";
    std::string sampler = R"({"input":4,"output":5})";
    std::string channels = R"({"sampler":0,"target":{"node":2,"path":"translation"}},)"
                           R"({"sampler":1,"target":{"node":3,"path":"rotation"}},)"
                           R"({"sampler":2,"target":{"node":5,"path":"weights"}})";
    std::string figure = R"({"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}})";
    std::string face = R"({"attributes":{"POSITION":0},"targets":[{"POSITION":3},{}]})";
    std::string faceMore;
    std::string moreAnimations;
    std::vector<float> times = {0, 1, 2};
    std::vector<float> moves = {0, 0, 0, 4, 0, 0, 0, 0, 0};
    std::vector<float> turns = {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 0, 1};
    std::vector<std::uint8_t> joints = {0, 9, 9, 9, 1, 0, 0, 0, 1, 0, 0, 0};

    std::string text() const {
        File file;
        file.add("VEC3", {0, 0, 0, 1, 1, 0, 0, 2, 0}, 3);
        file.addBytes("VEC4", joints, 4);
        file.add("VEC4", {1, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0}, 4);
        file.add("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
        file.add("SCALAR", times, 1);
        file.add("VEC3", moves, 3);
        file.add("VEC4", turns, 4);
        file.addBytes("SCALAR", {0, 0, 255, 0, 0, 255}, 1);
        file.add("VEC3", std::vector<float>(27, 1.0f), 3);
        std::string json =
            file.json(R"("nodes":)" + nodes + R"(,"scenes":[{"nodes":[0]}],"meshes":[{"primitives":[)" + figure +
                      R"(]},{"primitives":[)" + face + "]" + faceMore + R"(}],"skins":[)" + skin +
                      R"(],"animations":[{"name":"walk","samplers":[)" + sampler +
                      R"(,{"input":4,"output":6,"interpolation":"STEP"},{"input":4,"output":7}],"channels":[)" +
                      channels + "]}" + moreAnimations + "]");
        const std::string morphs = R"("bufferView":7,"componentType":5121)";
        return replaced(json, morphs, morphs + R"(,"normalized":true)");
    }
};

Scene loaded(const Parts& parts) {
    Scene scene;
    const gnomon::Result result = loadText(parts.text(), scene);
    EXPECT_TRUE(result.ok()) << result.message();
    if (result.ok()) expectSound(scene);
    return scene;
}

void expectRefused(const Parts& parts, const std::string& part) {
    Scene scene;
    const gnomon::Result result = loadText(parts.text(), scene);
    ASSERT_FALSE(result.ok()) << "accepted, not refused for: " << part;
    EXPECT_NE(std::string(result.message()).find(part), std::string::npos) << result.message();
}

void expectNoted(const Parts& parts, const std::string& part) {
    std::string notes;
    for (const std::string& note : loaded(parts).notes) notes += note + "\n";
    EXPECT_NE(notes.find(part), std::string::npos) << notes;
}

void expectAt(const Pose& pose, std::size_t deformed, std::size_t vertex, const glm::vec3& expected) {
    const glm::vec3 got = pose.deformed.at(deformed).positions.at(vertex);
    EXPECT_LT(glm::length(got - expected), 1e-5f) << got.x << " " << got.y << " " << got.z;
}

}  // namespace

TEST(SceneMotion, SkinsTargetsAndAnimationsMove) {
    const Scene scene = loaded(Parts{});
    ASSERT_EQ(scene.skins.size(), 1u);
    ASSERT_EQ(scene.animations.size(), 1u);
    EXPECT_EQ(scene.animations[0].name, "walk");
    EXPECT_EQ(scene.animations[0].durationSeconds, 2.0f);
    ASSERT_EQ(scene.animations[0].channels.size(), 3u);
    for (const Node& node : scene.nodes) EXPECT_NE(node.name, "idle");  // nothing hangs on it
    ASSERT_EQ(scene.instances.size(), 2u);
    EXPECT_NE(scene.instances[0].skin, kNone);
    EXPECT_EQ(scene.instances[0].node, kNone);
    const Primitive& figure = scene.meshes[scene.instances[0].mesh].primitives[0];
    EXPECT_EQ(figure.joints[0], glm::u16vec4(0));  // joints without weight are no joints
    EXPECT_EQ(figure.weights[1], glm::vec4(1, 0, 0, 0));
    ASSERT_EQ(scene.meshes[scene.instances[1].mesh].primitives[0].targets.size(), 2u);

    const Pose rest = restPose(scene);
    expectAt(rest, 0, 1, {1, 2, 0});  // moved by its joint's rest
    expectAt(rest, 1, 0, {0, 0, 0});
    const Pose pose = poseAt(scene, 1.5);
    expectAt(pose, 0, 0, {2, 0, 0});
    expectAt(pose, 0, 1, {2 - 1, 1 - 1, 0});  // turned by 180 degrees about the hand, a step at 1 s
    expectAt(pose, 1, 0, {0, 0, 0.5f});       // halfway down from 1, by bytes
}

TEST(SceneMotion, WhatStandsStillHasNoNodes) {
    Parts parts;
    parts.channels = R"({"sampler":0,"target":{"node":4,"path":"translation"}})";
    parts.nodes = R"([{"children":[5]},{},{},{},{"name":"idle"},{"name":"face","mesh":1}])";
    Scene scene = loaded(parts);
    EXPECT_TRUE(scene.nodes.empty());
    EXPECT_TRUE(scene.skins.empty());
    EXPECT_TRUE(scene.animations.empty());
    EXPECT_TRUE(scene.meshes[0].primitives[0].targets.empty());  // their weights are zero for ever
    parts.nodes = replaced(parts.nodes, R"("mesh":1)", R"("mesh":1,"weights":[0.5,0])");
    scene = loaded(parts);
    ASSERT_EQ(scene.meshes[0].primitives[0].targets.size(), 2u);
    expectAt(restPose(scene), 0, 0, {0, 0, 0.5f});
    parts.nodes = replaced(parts.nodes, R"("weights":[0.5,0])", R"("translation":[0,0,0])");
    parts.faceMore = R"(,"weights":[0.25,1])";
    scene = loaded(parts);
    EXPECT_TRUE(scene.nodes.empty());
    expectAt(restPose(scene), 0, 0, {0, 0, 0.25f});
    // A node above moves: the instance follows it.
    parts.channels = R"({"sampler":0,"target":{"node":0,"path":"translation"}})";
    scene = loaded(parts);
    ASSERT_EQ(scene.nodes.size(), 2u);
    EXPECT_EQ(poseAt(scene, 1.0).worldFromObject[0][3], glm::dvec4(4, 0, 0, 1));
}

TEST(SceneMotion, LightsAndCamerasHangOnNodes) {
    Parts parts;
    parts.nodes = R"([{"children":[1,2,4]},{"mesh":1,"camera":0},{"camera":0},{},)"
                  R"({"extensions":{"KHR_lights_punctual":{"light":0}}}])";
    parts.channels = R"({"sampler":0,"target":{"node":2,"path":"translation"}},)"
                     R"({"sampler":0,"target":{"node":4,"path":"translation"}})";
    parts.moreAnimations = R"(],"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}],)"
                           R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}},"extras":[)";
    const Scene scene = loaded(parts);
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[0].node, kNone);
    EXPECT_NE(scene.cameras[1].node, kNone);
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(poseAt(scene, 1.0).lights[0].position, glm::vec3(4, 0, 0));
}

// A figure in earth coordinates is posed as at zero.
TEST(SceneMotion, AFigureFarFromZero) {
    Parts parts;
    const Scene near = loaded(parts);
    EXPECT_EQ(near.origin, glm::dvec3(0.0));
    parts.nodes =
        replaced(parts.nodes, R"({"children")", R"({"translation":[4510731.2537,-4510731.8731,0.333],"children")");
    const Scene far = loaded(parts);
    EXPECT_EQ(far.origin, glm::dvec3(4510731.2537, -4510731.8731, 0.333));
    for (const double seconds : {0.0, 0.3, 0.7, 1.5}) {
        const Pose expected = poseAt(near, seconds), pose = poseAt(far, seconds);
        ASSERT_EQ(pose.deformed.size(), expected.deformed.size());
        for (std::size_t d = 0; d < pose.deformed.size(); ++d)
            for (std::size_t v = 0; v < 3; ++v) {
                const auto place = [&](const Pose& p) {
                    return glm::dvec3(p.worldFromObject[p.deformed[d].instance] *
                                      glm::dvec4(glm::dvec3(p.deformed[d].positions[v]), 1.0));
                };
                EXPECT_LT(glm::length(place(pose) - place(expected)), 1e-6) << seconds << " s, " << d << " " << v;
            }
    }
}

// The keys of a root that moves in earth coordinates are floats. Between them it moves smoothly.
TEST(SceneMotion, ARootThatMovesFarFromZero) {
    Parts parts;
    parts.nodes = R"([{"children":[1]},{"mesh":1,"translation":[0,0,0.25]},{},{}])";
    parts.channels = R"({"sampler":0,"target":{"node":0,"path":"translation"}})";
    parts.moves = {4510732, 0, 0, 4510736, 0, 0, 4510732, 0, 0};
    const Scene scene = loaded(parts);
    EXPECT_GT(scene.origin.x, 4.5e6);
    for (const double seconds : {0.0, 0.1, 0.37, 0.99}) {
        const glm::dvec3 place = glm::dvec3(poseAt(scene, seconds).worldFromObject[0][3]) + scene.origin;
        EXPECT_LT(glm::length(place - glm::dvec3(4510732.0 + 4.0 * seconds, 0.0, 0.25)), 1e-6) << seconds << " s";
    }
}

TEST(SceneMotion, Interpolations) {
    Parts parts;
    parts.sampler = R"({"input":4,"output":8,"interpolation":"CUBICSPLINE"})";
    expectAt(poseAt(loaded(parts), 0.0), 0, 0, {1, 1, 1});
    parts.sampler = R"({"input":4,"output":5,"interpolation":"WAVES"})";
    expectRefused(parts, "WAVES");
    parts.sampler = R"({"input":4,"output":5,"interpolation":"CUBICSPLINE"})";
    expectRefused(parts, "3 for 3 times, 3 each");
    parts.sampler = R"({"input":4,"output":8})";
    expectRefused(parts, "9 for 3 times, 1 each");
}

TEST(SceneMotion, BrokenAnimationsAreRefused) {
    const auto sampler = [](const char* text) {
        Parts parts;
        parts.sampler = text;
        return parts;
    };
    expectRefused(sampler(R"({"output":5})"), "accessor -1");
    expectRefused(sampler(R"({"input":4})"), "accessor -1");
    expectRefused(sampler(R"({"input":4,"output":99})"), "accessor 99");
    expectRefused(sampler(R"({"input":4,"output":"5"})"), "samplers[0].output is");
    expectRefused(sampler(R"({"input":5,"output":5})"), "3 components");
    expectRefused(sampler(R"({"input":4,"output":6})"), "4 components, not 3");
    expectRefused(sampler(R"({"input":4,"output":4})"), "1 components, not 3");
    expectRefused(sampler("7"), "samplers[0] is 7");
    const auto times = [](std::vector<float> values) {
        Parts parts;
        parts.times = std::move(values);
        return parts;
    };
    expectRefused(times({0, 1, 1}), "do not ascend");
    expectRefused(times({0, 2, 1}), "do not ascend");
    expectRefused(times({-1, 0, 1}), "hold -1");
    expectRefused(times({0, 1, std::numeric_limits<float>::infinity()}), "hold inf");
    expectRefused(times({0, 1, std::numeric_limits<float>::quiet_NaN()}), "hold");
    expectRefused(times({0, 1}), "3 for 2 times");
    Parts parts;
    parts.turns[4] = std::numeric_limits<float>::quiet_NaN();
    expectRefused(parts, "not finite");
    parts.turns = {0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1};
    expectRefused(parts, "no quaternion");
    parts = {};
    parts.channels = R"({"sampler":3,"target":{"node":2,"path":"translation"}})";
    expectRefused(parts, "sampler 3");
    parts.channels = R"({"target":{"node":2,"path":"translation"}})";
    expectRefused(parts, "sampler -1");
    Scene scene;
    EXPECT_FALSE(loadText(triangleGltf(R"(,"animations":{})"), scene).ok());
    EXPECT_FALSE(loadText(triangleGltf(R"(,"animations":[3])"), scene).ok());
}

TEST(SceneMotion, WhatMovesNothingIsPassedOver) {
    for (const char* channel :
         {R"({"sampler":9,"target":{"path":"translation"}})", R"({"sampler":9,"target":{"node":4,"path":"scale"}})",
          R"({"sampler":9,"target":{"node":77,"path":"scale"}})",
          R"({"sampler":9,"target":{"node":2,"path":"weights"}})",
          R"({"sampler":9,"target":{"node":5,"path":"pointer"}})", R"({"sampler":9})"}) {
        Parts parts;
        parts.channels += std::string(",") + channel;
        EXPECT_EQ(loaded(parts).animations.at(0).channels.size(), 3u) << channel;
    }
    Parts parts;
    parts.moreAnimations = R"(,{},{"name":"bare"},{"name":"empty","channels":[],"samplers":[]})";
    EXPECT_EQ(loaded(parts).animations.size(), 1u);
    parts = {};
    parts.channels += R"(,{"sampler":0,"target":{"node":2,"path":"pointer"}})";
    expectNoted(parts, "'pointer' are not played");
    parts = {};
    parts.nodes = replaced(parts.nodes, R"("translation":[0,1,0])", R"("matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,1,0,1])");
    expectNoted(parts, "has a matrix");
    EXPECT_EQ(loaded(parts).animations.at(0).channels.size(), 2u);
    parts = {};
    parts.moreAnimations = R"(,{"name":"run","samplers":[{"input":4,"output":5}],"channels":[)"
                           R"({"sampler":0,"target":{"node":2,"path":"translation"}}]})";
    expectNoted(parts, "on demand");
    const Scene scene = loaded(parts);
    EXPECT_TRUE(scene.animations.at(0).playing);
    EXPECT_FALSE(scene.animations.at(1).playing);
}

TEST(SceneMotion, BrokenSkinsAndTargetsAreRefused) {
    Parts parts;
    parts.skin = R"({"joints":[2,88]})";
    expectRefused(parts, "node 88");
    parts.skin = R"({"joints":[2]})";
    expectRefused(parts, "joint 1 of 1");
    parts.skin = R"({"joints":[2,3],"inverseBindMatrices":0})";
    expectRefused(parts, "4x4");
    parts = {};
    parts.nodes = replaced(parts.nodes, R"("skin":0)", R"("skin":4)");
    expectRefused(parts, "skin 4");
    parts = {};
    parts.joints[4] = 2;
    expectRefused(parts, "joint 2 of 2");
    parts = {};
    parts.nodes = replaced(parts.nodes, R"("translation":[0,1,0])", R"("translation":[0,1e20,0])");
    expectRefused(parts, "beyond 1e+15");
    parts = {};
    parts.face = R"({"attributes":{"POSITION":0},"targets":[{"POSITION":6},{}]})";
    expectRefused(parts, "components");
    parts.face = R"({"attributes":{"POSITION":0},"targets":[{"NORMAL":77},{}]})";
    expectRefused(parts, "accessor 77");
    parts.face = R"({"attributes":{"POSITION":0},"targets":[7]})";
    expectRefused(parts, "not an object");
    parts.face = R"({"attributes":{"POSITION":0},"targets":{}})";
    expectRefused(parts, "not an array");
    parts.face = R"({"attributes":{"POSITION":0},"targets":[{"POSITION":"x"}]})";
    expectRefused(parts, "not an index");
    parts.face = R"({"attributes":{"POSITION":0},"targets":[{"POSITION":3},{}]},{"attributes":{"POSITION":0}})";
    expectRefused(parts, "0 morph targets, the first primitive has 2");
    parts = {};
    parts.faceMore = R"(,"weights":[1])";
    expectRefused(parts, "1 weights for 2 morph targets");
    parts = {};
    parts.nodes = replaced(parts.nodes, R"("mesh":1)", R"("mesh":1,"weights":[1,2,3])");
    expectRefused(parts, "3 weights for 2 morph targets");
}

// Many channels and targets may share the same few bytes.
TEST(SceneMotion, SharedBytesDoNotMultiply) {
    std::string targets;
    for (int i = 0; i < 30000; ++i) targets += R"({"POSITION":0},)";
    targets.pop_back();
    File file;
    file.add("VEC3", std::vector<float>(9000, 1.0f), 3);
    Scene scene;
    const gnomon::Result result = loadText(
        file.json(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"targets":[)" + targets + "]}]}]"), scene);
    ASSERT_FALSE(result.ok());
    EXPECT_NE(std::string(result.message()).find("134217728 numbers"), std::string::npos) << result.message();
}

// A seeded storm of damaged files: whatever loads can be posed, or says why not.
TEST(SceneMotion, DamagedBytes) {
    const std::string whole = Parts().text();
    std::mt19937 random(77);
    int accepted = 0, animated = 0;
    for (int round = 0; round < 3000; ++round) {
        std::string text = whole;
        for (int i = 0; i < 2; ++i) {
            const char digits[] = "0123456789-,[]{}e.ABCDEFGabcdefg";
            text[random() % text.size()] = digits[random() % (sizeof(digits) - 1)];
        }
        Scene scene;
        if (!loadText(text, scene).ok()) continue;
        ++accepted;
        animated += isAnimated(scene) ? 1 : 0;
        expectSound(scene);
        completeLights(scene);
        for (double t : {0.0, 0.3, 1.7}) {
            try {
                const Pose pose = poseAt(scene, t);
                for (const PosedPrimitive& p : pose.deformed)
                    for (const glm::vec3& v : p.positions) ASSERT_TRUE(std::isfinite(v.x + v.y + v.z));
            } catch (const PoseError& error) {
                EXPECT_GT(std::strlen(error.what()), 10u);
            }
        }
    }
    EXPECT_GT(accepted, 300);
    EXPECT_GT(animated, 200);
}
