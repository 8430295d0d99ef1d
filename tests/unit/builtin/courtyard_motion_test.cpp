// What moves in the courtyard: sound skins, loops without a seam, feet on the ground.

#include "scene/builtin/builtin.h"
#include "scene/builtin/courtyard_figure.h"
#include "scene/pose.h"

#include <gtest/gtest.h>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::renderer {
namespace {

using Path = AnimationChannel::Path;

const Scene& courtyardScene() {
    static const Scene scene = makeBuiltinScene("courtyard").value();
    return scene;
}

std::size_t widthOf(const AnimationChannel& channel) {
    return channel.path == Path::Rotation ? 4 : 3;
}

// Local transforms at a key of the channels that have one there.
glm::mat4 worldAt(const Scene& scene, std::uint32_t node, float seconds) {
    glm::dmat4 world(1.0);
    for (; node != kNone; node = scene.nodes[node].parent) {
        Node local = scene.nodes[node];
        for (const AnimationChannel& c : scene.animations.front().channels) {
            if (c.node != node) continue;
            const float step = c.times[1], at = std::min(seconds / step, static_cast<float>(c.times.size()) - 1.001f);
            const auto key = static_cast<std::size_t>(at);
            const float* a = &c.values[key * widthOf(c)];
            const float* b = a + widthOf(c);
            const float t = at - static_cast<float>(key);
            if (c.path == Path::Translation)
                local.translation = glm::mix(glm::vec3(a[0], a[1], a[2]), glm::vec3(b[0], b[1], b[2]), t);
            else
                local.rotation =
                    glm::dquat(glm::slerp(glm::quat(a[3], a[0], a[1], a[2]), glm::quat(b[3], b[0], b[1], b[2]), t));
        }
        world = localTransform(local) * world;
    }
    return glm::mat4(world);
}

std::uint32_t nodeNamed(const Scene& scene, const std::string& name) {
    for (std::uint32_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].name == name) return i;
    ADD_FAILURE() << "no node '" << name << "'";
    return 0;
}

TEST(CourtyardMotion, NodesHaveParentsBeforeThemAndEverythingThatHangsIsThere) {
    const Scene& scene = courtyardScene();
    ASSERT_FALSE(scene.nodes.empty());
    for (std::uint32_t i = 0; i < scene.nodes.size(); ++i) {
        ASSERT_TRUE(scene.nodes[i].parent == kNone || scene.nodes[i].parent < i);
        EXPECT_NEAR(glm::length(scene.nodes[i].rotation), 1.0, 1e-4) << scene.nodes[i].name;
    }
    for (const Instance& instance : scene.instances) {
        ASSERT_TRUE(instance.node == kNone || instance.node < scene.nodes.size());
        ASSERT_TRUE(instance.skin == kNone || instance.skin < scene.skins.size());
        if (instance.skin != kNone) {
            EXPECT_EQ(instance.worldFromObject, glm::dmat4(1.0));
        }
        if (instance.node == kNone) continue;
        const glm::mat4 rest = worldAt(scene, instance.node, 0.0f);
        for (int k = 0; k < 4; ++k)
            EXPECT_LT(glm::length(rest[k] - glm::vec4(instance.worldFromObject[k])), 1e-3f) << instance.name;
    }
    std::size_t carried = 0;
    for (const SceneLight& light : scene.lights) {
        ASSERT_TRUE(light.node == kNone || light.node < scene.nodes.size());
        carried += light.node != kNone ? 1 : 0;
    }
    EXPECT_GE(carried, 1u);
}

TEST(CourtyardMotion, WeightsSumToOneAndJointsAreInRange) {
    const Scene& scene = courtyardScene();
    EXPECT_GE(scene.skins.size(), 8u);
    std::vector<bool> used(scene.skins.size(), false);
    for (const Instance& instance : scene.instances) {
        if (instance.skin == kNone) continue;
        used[instance.skin] = true;
        const Skin& skin = scene.skins[instance.skin];
        ASSERT_EQ(skin.joints.size(), skin.jointFromMesh.size());
        for (const Primitive& p : scene.meshes[instance.mesh].primitives) {
            ASSERT_EQ(p.joints.size(), p.positions.size());
            ASSERT_EQ(p.weights.size(), p.positions.size());
            for (std::size_t v = 0; v < p.weights.size(); ++v) {
                EXPECT_NEAR(p.weights[v].x + p.weights[v].y + p.weights[v].z + p.weights[v].w, 1.0f, 1e-5f);
                for (int k = 0; k < 4; ++k) {
                    EXPECT_GE(p.weights[v][k], 0.0f);
                    ASSERT_LT(p.joints[v][k], skin.joints.size());
                }
            }
        }
    }
    for (std::size_t i = 0; i < used.size(); ++i) EXPECT_TRUE(used[i]) << scene.skins[i].name;
}

TEST(CourtyardMotion, SkinsChangeNothingAtRest) {
    const Scene& scene = courtyardScene();
    for (const Skin& skin : scene.skins) {
        for (std::size_t j = 0; j < skin.joints.size(); ++j) {
            const glm::mat4 same = worldAt(scene, skin.joints[j], 0.0f) * skin.jointFromMesh[j];
            for (int k = 0; k < 4; ++k) EXPECT_LT(glm::length(same[k] - glm::mat4(1.0f)[k]), 2e-3f) << skin.name;
        }
    }
}

TEST(CourtyardMotion, LoopsWithoutASeam) {
    const Scene& scene = courtyardScene();
    ASSERT_EQ(scene.animations.size(), 1u);
    const Animation& animation = scene.animations.front();
    EXPECT_FLOAT_EQ(animation.durationSeconds, courtyard::kLoopSeconds);
    for (const AnimationChannel& c : animation.channels) {
        const std::size_t width = widthOf(c), count = c.times.size();
        ASSERT_LT(c.node, scene.nodes.size());
        ASSERT_EQ(c.values.size(), width * count);
        EXPECT_EQ(c.times.front(), 0.0f);
        EXPECT_FLOAT_EQ(c.times.back(), animation.durationSeconds);
        for (std::size_t i = 1; i < count; ++i) ASSERT_GT(c.times[i], c.times[i - 1]);
        float dot = 0.0f, apart = 0.0f;
        for (std::size_t k = 0; k < width; ++k) {
            const float first = c.values[k], last = c.values[(count - 1) * width + k];
            dot += first * last;
            apart = std::max(apart, std::abs(first - last));
        }
        if (c.path == Path::Rotation)
            EXPECT_NEAR(std::abs(dot), 1.0f, 1e-5f) << scene.nodes[c.node].name;
        else
            EXPECT_LT(apart, 1e-5f) << scene.nodes[c.node].name;
        // No jump between keys either: nothing turns by more than 60 degrees or moves farther than 0.5 m from one
        // key to the next.
        for (std::size_t i = 1; i < count; ++i) {
            float cosine = 0.0f, squared = 0.0f;
            for (std::size_t k = 0; k < width; ++k) {
                const float a = c.values[(i - 1) * width + k], b = c.values[i * width + k];
                cosine += a * b;
                squared += (a - b) * (a - b);
            }
            if (c.path == Path::Rotation)
                EXPECT_GT(cosine, 0.866f) << scene.nodes[c.node].name << " at key " << i;
            else
                EXPECT_LT(squared, 0.25f) << scene.nodes[c.node].name << " at key " << i;
        }
    }
}

// While a foot carries it may not slide: the lower ankle of a walker moves slowly, and never sinks.
TEST(CourtyardMotion, WalkersDoNotSlide) {
    const Scene& scene = courtyardScene();
    for (const char* name : {"lantern bearer", "lady with a parasol"}) {
        const std::uint32_t root = nodeNamed(scene, name);
        const float floor = scene.nodes[root].translation.y;
        const auto ankle = [&](std::uint32_t joint, float t) { return glm::vec3(worldAt(scene, root + joint, t)[3]); };
        float slid = 0.0f, walked = 0.0f;
        constexpr float kStep = 0.05f;
        for (int i = 0; i < 220; ++i) {
            const float t = kStep * static_cast<float>(i);
            const glm::vec3 left = ankle(courtyard::kFootL, t), right = ankle(courtyard::kFootR, t);
            const bool onLeft = left.y < right.y;
            const std::uint32_t foot = onLeft ? courtyard::kFootL : courtyard::kFootR;
            const glm::vec3 moved = ankle(foot, t + kStep) - (onLeft ? left : right);
            slid += glm::length(glm::vec2(moved.x, moved.z));
            walked += glm::length(ankle(courtyard::kRoot, t + kStep) - ankle(courtyard::kRoot, t));
            EXPECT_GT(std::min(left.y, right.y), floor + 0.03f) << name << " at " << t;
            EXPECT_LT(std::min(left.y, right.y), floor + 0.15f) << name << " at " << t;
        }
        EXPECT_LT(slid, 0.3f * walked) << name;
    }
}

}  // namespace
}  // namespace gnomon::renderer
