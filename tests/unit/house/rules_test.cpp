// The house rules hold in this tree, and the checker sees what it is meant to see.
#include "unit/house/rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace gnomon::house {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const std::vector<TextFile>& project() {
    static const std::vector<TextFile> files = readProject(GNOMON_SOURCE_DIR);
    return files;
}

std::set<std::string> projectPaths() {
    std::set<std::string> paths;
    for (const TextFile& file : project()) paths.insert(file.path);
    return paths;
}

std::string joined(const Violations& violations) {
    std::string out;
    for (const std::string& v : violations) out += v + "\n";
    return out;
}

TEST(HouseRules, TreeHolds) {
    EXPECT_EQ(joined(checkProject(project())), "");
}

TEST(HouseRules, TreeIsReadWhole) {
    const std::set<std::string> paths = projectPaths();
    for (const char* path : {"include/gnomon/scene.h", "src/core/context.cpp", "src/gpu_interface/numbers.h",
                             "src/generate_shadows/filter_pairs.comp", "reference/prepare.cpp",
                             "renderer/lighting/lighting.comp", "app/main.cpp", "CMakeLists.txt"}) {
        EXPECT_TRUE(paths.contains(path)) << path;
    }
    std::size_t includes = 0;
    for (const TextFile& file : project()) includes += includesOf(file.text).size();
    EXPECT_GT(includes, 300u);
}

// An include line in a file of a room, and whether the house allows it.
struct Planted {
    const char* path;
    const char* line;
    bool allowed;
};

void PrintTo(const Planted& planted, std::ostream* out) {
    *out << planted.path << ": " << planted.line;
}

class HouseIncludes : public ::testing::TestWithParam<Planted> {};

TEST_P(HouseIncludes, IsJudged) {
    const Planted& planted = GetParam();
    const TextFile file = {planted.path, std::string("// Text.\n") + planted.line + "\n"};
    const Violations found = checkIncludes(file, projectPaths());
    EXPECT_EQ(found.empty(), planted.allowed) << joined(found);
    if (!planted.allowed && !found.empty()) {
        EXPECT_THAT(found.front(), HasSubstr(std::string(planted.path) + ":2: "));
    }
}

constexpr Planted kPlanted[] = {
    {"include/gnomon/new.h", "#include <span>", true},
    {"include/gnomon/new.h", "#include <vulkan/vulkan_core.h>", true},
    {"include/gnomon/new.h", "#include \"gnomon/result.h\"", true},
    {"include/gnomon/new.h", "#include \"gpu_interface/numbers.h\"", false},
    {"include/gnomon/new.h", "#include \"vulkan/pass.h\"", false},
    {"include/gnomon/new.h", "#include \"../../src/core/context.h\"", false},
    {"include/gnomon/new.h", "#include \"filter_pairs.spv.h\"", false},
    {"include/gnomon/new.h", "#include <glm/glm.hpp>", false},

    // gpu_interface stands alone.
    {"src/gpu_interface/new.h", "#include \"gpu_interface/numbers.h\"", true},
    {"src/gpu_interface/new.h", "#include \"numbers.h\"", true},
    {"src/gpu_interface/new.h", "#include \"core/context.h\"", false},
    {"src/gpu_interface/new.h", "#include \"vulkan/pass.h\"", false},
    {"src/gpu_interface/new.h", "#include \"gnomon/scene.h\"", false},
    {"src/gpu_interface/new.h", "#include <vulkan/vulkan_core.h>", false},
    {"src/gpu_interface/new.glsl", "#include \"gpu_interface/packing.h\"", true},
    {"src/gpu_interface/new.glsl", "#include \"shading/frame.glsl\"", false},
    {"src/gpu_interface/new.glsl", "#include \"visibility/pcf.glsl\"", false},

    // Techniques see each other and what serves them, not who composes them.
    {"src/closeups/new.cpp", "#include \"gnomon/scene.h\"", true},
    {"src/closeups/new.cpp", "#include \"gnomon/view.h\"", true},
    {"src/closeups/new.cpp", "#include \"vulkan/pass.h\"", true},
    {"src/closeups/new.cpp", "#include \"shadow_bounds/cells.h\"", true},
    {"src/closeups/new.cpp", "#include \"filter_pairs.spv.h\"", true},
    {"src/closeups/new.cpp", "#include \"core/view.h\"", false},
    {"src/closeups/new.cpp", "#include \"../core/passes.h\"", false},
    {"src/closeups/new.cpp", "#include \"src/core/pipelines.h\"", false},
    {"src/closeups/new.cpp", "#  include <unistd.h>", false},
    {"src/closeups/new.cpp", "#include <sys/mman.h>", false},
    {"src/closeups/new.cpp", "#include <math.h>", false},
    {"src/closeups/new.cpp", "#include <volk.h>", false},
    {"src/closeups/new.cpp", "#include <glm/glm.hpp>", false},
    {"src/closeups/new.cpp", "#include \"renderer/gpu/device.h\"", false},
    {"src/closeups/new.cpp", "#include \"scene/scene.h\"", false},
    {"src/closeups/new.cpp", "#include \"../../reference/prepare.h\"", false},
    {"src/closeups/new.cpp", "#include \"reference/prepare.h\"", false},
    {"src/closeups/new.cpp", "#include SOME_MACRO", false},
    {"src/core/new.cpp", "#include \"core/view.h\"", true},
    {"src/core/new.cpp", "#include \"generate_shadows/filter_pairs.h\"", true},
    {"src/core/new.cpp", "#include \"prepare/camera.h\"", true},
    {"src/core/new.cpp", "#include \"vulkan/recorder.h\"", true},
    {"src/core/new.cpp", "#include \"renderer/renderer.h\"", false},
    {"src/vulkan/new.cpp", "#include \"vulkan/resources.h\"", true},
    {"src/vulkan/new.cpp", "#include \"gpu_interface/numbers.h\"", true},
    {"src/vulkan/new.cpp", "#include \"core/context.h\"", false},
    {"src/vulkan/new.cpp", "#include \"generate_shadows/filter_pairs.h\"", false},
    {"src/vulkan/new.glsl", "#include \"shading/frame.glsl\"", false},
    {"src/prepare/new.cpp", "#include \"prepare/camera.h\"", true},
    {"src/prepare/new.cpp", "#include \"gnomon/prepare.h\"", true},
    {"src/prepare/new.cpp", "#include \"gnomon/view.h\"", false},
    {"src/prepare/new.cpp", "#include \"vulkan/resources.h\"", false},
    {"src/prepare/new.cpp", "#include \"core/view.h\"", false},
    {"src/prepare/new.cpp", "#include <vulkan/vulkan_core.h>", false},
    {"src/generate_shadows/new.glsl", "#include \"gnomon_host_provider.glsl\"", true},
    {"src/generate_shadows/new.glsl", "#include \"visibility/hard.glsl\"", true},
    {"src/generate_shadows/new.comp", "#include \"shading/frame.glsl\"", true},
    {"src/generate_shadows/new.comp", "#include \"vulkan/work_group.glsl\"", true},
    {"src/generate_shadows/new.glsl", "#include \"renderer/lighting/shade.glsl\"", false},
    {"src/generate_shadows/new.glsl", "#include \"no/such/file.glsl\"", false},
    {"src/shading/new.glsl", "#include \"visibility/visibility.glsl\"", true},
    {"src/shading/new.glsl", "#include \"renderer/lighting/shade.glsl\"", false},

    // The oracle sees formats, and of the public headers those that know no Vulkan.
    {"reference/new.cpp", "#include \"gpu_interface/packing.h\"", true},
    {"reference/new.cpp", "#include \"gnomon/scene.h\"", true},
    {"reference/new.cpp", "#include \"gnomon/settings.h\"", true},
    {"reference/new.cpp", "#include \"gnomon/prepare.h\"", true},
    {"reference/new.cpp", "#include \"gnomon/view.h\"", false},
    {"reference/new.cpp", "#include \"gnomon/context.h\"", false},
    {"reference/new.cpp", "#include \"gnomon/timeline.h\"", false},
    {"reference/new.cpp", "#include \"gnomon/gnomon.h\"", false},
    {"reference/new.cpp", "#include \"prepare/camera.h\"", false},
    {"reference/new.cpp", "#include \"src/prepare/camera.h\"", false},
    {"reference/new.cpp", "#include \"shadow_bounds/cells.h\"", false},
    {"reference/new.cpp", "#include \"core/settings.h\"", false},
    {"reference/new.cpp", "#include \"filter_pairs.spv.h\"", false},
    {"reference/new.cpp", "#include \"renderer/renderer.h\"", false},
    {"reference/new.cpp", "#include \"scene/scene.h\"", false},
    {"reference/new.cpp", "#include <vulkan/vulkan.h>", false},
    {"reference/new.cpp", "#include <glm/glm.hpp>", false},

    // Scene, truth and picture know no Vulkan.
    {"scene/new.cpp", "#include <glm/glm.hpp>", true},
    {"scene/new.cpp", "#include \"gnomon/result.h\"", true},
    {"scene/new.cpp", "#include \"gnomon/settings.h\"", true},
    {"scene/new.cpp", "#include \"gnomon/view.h\"", false},
    {"scene/new.cpp", "#include \"gpu_interface/numbers.h\"", false},
    {"scene/new.cpp", "#include \"renderer/gpu/device.h\"", false},
    {"scene/new.cpp", "#include <vulkan/vulkan.h>", false},
    {"scene/builtin/new.cpp", "#include \"scene/scene.h\"", true},
    {"scene/builtin/new.cpp", "#include \"renderer/renderer.h\"", false},
    {"truth/new.cpp", "#include \"scene/scene.h\"", true},
    {"truth/new.cpp", "#include \"gnomon/scene.h\"", true},
    {"truth/new.cpp", "#include \"gnomon/context.h\"", false},
    {"truth/new.cpp", "#include \"reference/prepare.h\"", false},
    {"truth/new.cpp", "#include \"renderer/renderer.h\"", false},
    {"truth/new.cpp", "#include <vulkan/vulkan.h>", false},
    {"picture/new.cpp", "#include <tinyexr.h>", true},
    {"picture/new.cpp", "#include \"scene/scene.h\"", false},
    {"picture/new.cpp", "#include \"gnomon/scene.h\"", false},
    {"picture/new.cpp", "#include \"renderer/renderer.h\"", false},
    {"picture/new.cpp", "#include <vulkan/vulkan.h>", false},

    // What stands on the library, and what stands on that.
    {"visualize/new.cpp", "#include \"core/context.h\"", true},
    {"visualize/new.cpp", "#include \"renderer/renderer.h\"", false},
    {"visualize/new.cpp", "#include \"scene/scene.h\"", false},
    {"visualize/new.cpp", "#include <glm/glm.hpp>", false},
    {"visualize/new.comp", "#include \"shading/tile_lights.glsl\"", true},
    {"inspect/new.cpp", "#include \"gpu_interface/packing.h\"", true},
    {"inspect/new.cpp", "#include \"gnomon/view.h\"", true},
    {"inspect/new.cpp", "#include \"renderer/renderer.h\"", false},
    {"inspect/new.cpp", "#include \"app/session.h\"", false},
    {"inspect/new.cpp", "#include \"reference/prepare.h\"", false},
    {"renderer/new.cpp", "#include \"scene/scene.h\"", true},
    {"renderer/new.cpp", "#include \"gnomon/gnomon.h\"", true},
    {"renderer/new.cpp", "#include <glm/glm.hpp>", true},
    {"renderer/new.cpp", "#include \"truth/figures.h\"", false},
    {"renderer/new.cpp", "#include \"app/session.h\"", false},
    {"renderer/new.cpp", "#include \"reference/prepare.h\"", false},
    {"renderer/new.cpp", "#include <GLFW/glfw3.h>", false},
    {"renderer/lighting/new.glsl", "#include \"shading/frame.glsl\"", true},
    {"app/new.cpp", "#include \"renderer/renderer.h\"", true},
    {"app/new.cpp", "#include \"truth/figures.h\"", true},
    {"app/new.cpp", "#include \"tests/unit/house/rules.h\"", false},
    {"app/new.cpp", "#include <imgui.h>", false},
    {"app/new.cpp", "#include <SDL2/SDL.h>", false},
    {"app/view/new.cpp", "#include <imgui.h>", true},
    {"app/view/new.cpp", "#include \"app/session.h\"", true},
    {"examples/minimal_host/new.cpp", "#include \"gnomon/gnomon.h\"", true},
    {"examples/minimal_host/new.cpp", "#include <vulkan/vulkan.h>", true},
    {"examples/minimal_host/new.cpp", "#include \"renderer/renderer.h\"", false},
    {"examples/minimal_host/new.cpp", "#include \"core/context.h\"", false},
    {"examples/minimal_host/new.cpp", "#include \"gpu_interface/numbers.h\"", false},
    {"examples/minimal_host/new.cpp", "#include <glm/glm.hpp>", false},
    {"examples/minimal_host/new.comp", "#include \"shading/tile_lights.glsl\"", true},
    {"tests/unit/new.cpp", "#include <GLFW/glfw3.h>", false},
    {"tests/unit/new.cpp", "#include \"src/core/context.h\"", true},
};
INSTANTIATE_TEST_SUITE_P(Planted, HouseIncludes, ::testing::ValuesIn(kPlanted));

TEST(HouseRules, ShadingHoldsIncludesAlone) {
    EXPECT_TRUE(checkIncludes({"src/shading/new.glsl", "// Text.\n"}, projectPaths()).empty());
    for (const char* path : {"src/shading/new.comp", "src/shading/new.cpp", "src/shading/new.h"}) {
        EXPECT_EQ(checkIncludes({path, "// Text.\n"}, projectPaths()),
                  Violations{std::string(path) + ":1: src/shading holds shader includes for hosts, and nothing else."});
    }
}

TEST(HouseRules, IncludesAreRead) {
    const auto found =
        includesOf("#include \"a.h\"\n // #include \"b.h\"\n\t# include <c>\n#include D_E\nint include;\n#include<f>");
    ASSERT_EQ(found.size(), 4u);
    EXPECT_EQ(found[0].name, "a.h");
    EXPECT_EQ(found[1].name, "c");
    EXPECT_EQ(found[1].line, 3u);
    EXPECT_EQ(found[2].form, Include::Form::Macro);
    EXPECT_EQ(found[3].name, "f");
}

TEST(HouseRules, SizesAreSeen) {
    const auto lines = [](std::size_t n) {
        std::string text;
        for (std::size_t i = 0; i < n; ++i) text += "x\n";
        return text;
    };
    EXPECT_TRUE(checkSize({"src/a.cpp", lines(kMaxCppLines - 1)}).empty());
    EXPECT_EQ(checkSize({"src/a.cpp", lines(kMaxCppLines)}).size(), 1u);
    EXPECT_EQ(checkSize({"src/a.cpp", lines(kMaxCppLines - 1) + "x"}).size(), 1u);
    EXPECT_TRUE(checkSize({"src/a.comp", lines(kMaxShaderLines - 1)}).empty());
    EXPECT_EQ(checkSize({"src/a.comp", lines(kMaxShaderLines)}).size(), 1u);
    EXPECT_TRUE(checkSize({"docs/a.md", lines(5000)}).empty());
}

TEST(HouseRules, GuardsAreSeen) {
    EXPECT_TRUE(checkGuard({"src/a.h", "// Text.\n#pragma once\n"}).empty());
    EXPECT_TRUE(checkGuard({"src/a.glsl", "#ifndef GNOMON_A_GLSL\n#define GNOMON_A_GLSL\n#endif\n"}).empty());
    EXPECT_EQ(checkGuard({"src/a.glsl", "// #pragma once\n"}).size(), 1u);
    EXPECT_EQ(checkGuard({"src/a.glsl", "#ifndef GNOMON_A_GLSL\n#define GNOMON_B_GLSL\n#endif\n"}).size(), 1u);
    EXPECT_EQ(checkGuard({"src/a.h", ""}).size(), 1u);
    EXPECT_TRUE(checkGuard({"src/a.cpp", ""}).empty());
    EXPECT_TRUE(checkGuard({"src/a.comp", ""}).empty());
}

TEST(HouseRules, WordsAndTabsAreSeen) {
    EXPECT_EQ(checkText({"src/a.cpp", "int a;\n\tint b;\n"}), Violations{"src/a.cpp:2: has a tab."});
    EXPECT_TRUE(checkText({"tests/data.txt", "a\tb\n"}).empty());
    EXPECT_EQ(checkText({"docs/a.md", std::string("one\ntwo\nKeep in") + " sync with b.\n"}).size(), 1u);
    EXPECT_EQ(checkText({"scripts/a.sh", std::string("cd /wo") + "rk/main\n"}).size(), 1u);
    EXPECT_EQ(checkText({"scripts/a.sh", std::string("pip --index") + "-url x\n"}).size(), 1u);
    EXPECT_TRUE(checkText({"src/a.cpp", "// a sync, a network/path, internal use\n"}).empty());
}

// The whole way, over a copy of the tree with one line planted into it.
TEST(HouseRules, PlantedIncludeInACopyIsFound) {
    const fs::path copy = fs::temp_directory_path() /
                          ("gnomon_house_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" +
                           std::to_string(reinterpret_cast<std::uintptr_t>(&project())));
    for (const TextFile& file : project()) {
        fs::create_directories((copy / file.path).parent_path());
        std::ofstream(copy / file.path, std::ios::binary) << file.text;
    }
    const Violations before = checkProject(readProject(copy));
    std::ofstream(copy / "src/core/view.cpp", std::ios::app) << "#include \"renderer/renderer.h\"\n";
    const Violations after = checkProject(readProject(copy));
    fs::remove_all(copy);
    EXPECT_EQ(before, checkProject(project()));
    ASSERT_EQ(after.size(), before.size() + 1);
    EXPECT_THAT(joined(after), HasSubstr("includes 'renderer/renderer.h': 'src/core' must not see 'renderer'."));
}

}  // namespace
}  // namespace gnomon::house
