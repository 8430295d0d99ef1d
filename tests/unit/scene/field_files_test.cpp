// Files that engineers had, and on which the loader was wrong. Where GNOMON_SCENES_DIR has them, in its folder field.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "scene/flatness.h"
#include "scene/load_gltf.h"
#include "scene/pose.h"

namespace gnomon::renderer {
namespace {

constexpr const char* kNoField = "GNOMON_SCENES_DIR has no field scenes";

std::optional<std::filesystem::path> fieldFile(const std::string& name) {
    const char* folder = std::getenv("GNOMON_SCENES_DIR");
    if (folder == nullptr) return std::nullopt;
    const std::filesystem::path file = std::filesystem::path(folder) / "field" / name;
    return std::filesystem::is_regular_file(file) ? std::optional(file) : std::nullopt;
}

TEST(FieldFiles, AccessorsWithoutABufferViewAreZeros) {
    const auto file = fieldFile("04-accessor-without-bufferview/zerom.gltf");
    if (!file) GTEST_SKIP() << kNoField;
    Scene scene;
    const Result result = loadGltf(*file, scene);
    ASSERT_TRUE(result.ok()) << result.message();
    ASSERT_EQ(scene.instances.size(), 2u);
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& p : mesh.primitives)
            for (const MorphTarget& target : p.targets)
                for (const glm::vec3& d : target.positions) EXPECT_EQ(d, glm::vec3(0.0f));
}

// Flat, but there: it has an area.
TEST(FieldFiles, WhatIsSquashedToAPlaneIsDrawn) {
    const auto file = fieldFile("05-squashed-to-a-plane/squash.gltf");
    if (!file) GTEST_SKIP() << kNoField;
    Scene scene;
    ASSERT_TRUE(loadGltf(*file, scene).ok());
    const Pose pose = restPose(scene);
    std::size_t flat = 0;
    for (const glm::dmat4& world : pose.worldFromObject) {
        EXPECT_TRUE(hasArea(glm::dmat3(world)));
        flat += glm::determinant(glm::dmat3(world)) == 0.0 ? 1 : 0;
    }
    EXPECT_EQ(flat, 1u);
}

// One sentence that names the part.
TEST(FieldFiles, ValuesOfAWrongTypeAreRefused) {
    const std::pair<const char*, const char*> cases[] = {{"ty_alphaMode_lower", "alphaMode"},
                                                         {"ty_baseColor_3", "baseColorFactor"},
                                                         {"ty_range_string", "range"},
                                                         {"ty_translation_string", "translation"}};
    for (const auto& [name, part] : cases) {
        const auto file = fieldFile("13-wrong-types-become-defaults/" + std::string(name) + ".gltf");
        if (!file) GTEST_SKIP() << kNoField;
        Scene scene;
        const Result result = loadGltf(*file, scene);
        EXPECT_FALSE(result.ok()) << name;
        const std::string sentence = result.message();
        EXPECT_NE(sentence.find(part), std::string::npos) << sentence;
        EXPECT_EQ(sentence.back(), '.') << sentence;
        EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
    }
}

TEST(FieldFiles, BlendIsAMaskWithANote) {
    for (const char* name : {"blend0.49.gltf", "blend0.5.gltf"}) {
        const auto file = fieldFile(std::string("09-blend-is-a-silent-mask/") + name);
        if (!file) GTEST_SKIP() << kNoField;
        Scene scene;
        ASSERT_TRUE(loadGltf(*file, scene).ok());
        EXPECT_TRUE(std::ranges::any_of(scene.notes, [](const std::string& note) {
            return note.find("BLEND") != std::string::npos || note.find("blend") != std::string::npos;
        })) << name;
    }
}

TEST(FieldFiles, CamerasKeepTheirShape) {
    const auto file = fieldFile("22-camera-aspect-and-xmag/cameras.glb");
    if (!file) GTEST_SKIP() << kNoField;
    Scene scene;
    ASSERT_TRUE(loadGltf(*file, scene).ok());
    SceneCamera wide, ortho;
    ASSERT_TRUE(parseCamera("wide", scene, wide).ok());
    ASSERT_TRUE(parseCamera("ortho", scene, ortho).ok());
    EXPECT_NEAR(wide.widthOverHeight, 3.0f, 1e-4f);
    EXPECT_TRUE(ortho.orthographic);
    EXPECT_GT(ortho.widthOverHeight, 0.0f);
    // 16:9 shows all of 3:1: more above and below.
    const float before = std::tan(0.5f * wide.verticalFieldOfView);
    const SceneCamera fitted = fittedCamera(wide, 1600, 900);
    EXPECT_NEAR(std::tan(0.5f * fitted.verticalFieldOfView), before * 3.0f * 9.0f / 16.0f, 1e-4f);
}

}  // namespace
}  // namespace gnomon::renderer
