// Every pass declares what its shader does, neither less nor more: resources with their access, and specialization
// constants. Barriers and pipelines follow from the declarations, so a wrong one is a race or a constant that is lost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "core/passes.h"
#include "core/view_buffers.h"
#include "gpu_interface/numbers.h"
#include "unit/house/fake_vulkan.h"
#include "unit/house/reflection.h"

namespace gnomon::house {
namespace {

namespace fs = std::filesystem;
using namespace gpu;
using ::testing::AnyOf;
using ::testing::HasSubstr;

// A declaration that can be changed.
struct Declared {
    std::string name;
    std::vector<PassResource> resources;
    std::vector<std::uint32_t> specialization;
};

Declared declaredBy(const Pass& pass) {
    return {pass.name,
            {pass.resources.begin(), pass.resources.end()},
            {pass.specialization.begin(), pass.specialization.end()}};
}

const char* wordFor(Access access) {
    switch (access) {
        case Access::Uniform:
            return "Uniform";
        case Access::Streamed:
            return "Streamed";
        case Access::Sampled:
            return "Sampled";
        case Access::Read:
            return "Read";
        case Access::Write:
            return "Write";
        case Access::Indirect:
            return "Indirect";
    }
    return "?";
}

std::string placeOf(std::uint32_t set, std::uint32_t binding) {
    return "set " + std::to_string(set) + ", binding " + std::to_string(binding);
}

// The kind of the view's buffer at a place, if there is one.
const ViewBuffer* bufferAt(std::uint32_t set, std::uint32_t binding) {
    for (const ViewBuffer& buffer : viewBuffers()) {
        if (buffer.kind != BufferKind::Readback && buffer.set == set && buffer.binding == binding) return &buffer;
    }
    return nullptr;
}

// Whether two declarations may stand side by side: a storage buffer that also holds the command of the dispatch.
bool mayShareAPlace(Access a, Access b) {
    if (b == Access::Indirect) std::swap(a, b);
    return a == Access::Indirect && (b == Access::Read || b == Access::Write);
}

// What is wrong with this access for what the shader does, or nothing. `twin`: it has a second declaration that may
// stand beside it.
std::string wrongAccess(const PassResource& declared, bool twin, const ResourceLayout& used) {
    const ViewBuffer* const buffer = bufferAt(declared.set, declared.binding);
    const bool streamed = buffer != nullptr && buffer->kind == BufferKind::Streamed;
    const bool storage = used.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    switch (declared.access) {
        case Access::Uniform:
            if (used.type != VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER) return "the shader has no uniform block there";
            return streamed ? "" : "the host writes no such buffer";
        case Access::Sampled:
            return used.type == VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE || used.type == VK_DESCRIPTOR_TYPE_SAMPLER
                       ? ""
                       : "the shader has no image or sampler there";
        case Access::Indirect:
            return twin ? "" : "the shader uses it";
        case Access::Streamed:
        case Access::Read:
        case Access::Write:
            break;
    }
    if (!storage) return "the shader has no storage buffer there";
    if (declared.access == Access::Write) return used.written ? "" : "the shader does not write it";
    if (used.written) return "the shader writes it";
    if (declared.access == Access::Streamed) return streamed ? "" : "the host does not write it";
    return streamed ? "the host writes it, so that it is Streamed" : "";
}

// Every difference between a declaration and a shader, one line each; empty if there is none.
std::string differences(const Declared& pass, const ShaderLayout& shader) {
    std::string out;
    const auto say = [&](const std::string& what) { out += pass.name + ": " + what + "\n"; };
    for (std::size_t i = 0; i < pass.resources.size(); ++i) {
        const PassResource& r = pass.resources[i];
        const std::string place = placeOf(r.set, r.binding) + " is declared " + wordFor(r.access);
        const auto same = [&](const auto& other) { return other.set == r.set && other.binding == r.binding; };
        const auto isUsed = [&](const ResourceLayout& other) { return same(other) && (other.read || other.written); };
        bool twin = false;
        for (std::size_t other = 0; other < pass.resources.size(); ++other) {
            if (other == i || !same(pass.resources[other])) continue;
            const bool fits = mayShareAPlace(r.access, pass.resources[other].access);
            twin = twin || fits;
            if (!fits && other < i) say(place + ", and was declared before");
        }
        const auto used = std::ranges::find_if(shader.resources, isUsed);
        if (used != shader.resources.end()) {
            const std::string wrong = wrongAccess(r, twin, *used);
            if (!wrong.empty()) say(place + ", but " + wrong);
        } else if (r.access != Access::Indirect) {
            say(place + ", but the shader does not use it");
        }
    }
    for (const ResourceLayout& used : shader.resources) {
        const auto same = [&](const PassResource& r) { return r.set == used.set && r.binding == used.binding; };
        if (std::ranges::none_of(pass.resources, same))
            say(placeOf(used.set, used.binding) + " is in the shader, but not declared");
    }
    for (std::size_t i = 0; i < pass.specialization.size(); ++i) {
        const std::uint32_t id = pass.specialization[i];
        if (id >= kSpecCount) say("constant " + std::to_string(id) + " is declared, but is none of numbers.h");
        if (std::ranges::find(shader.constantIds, id) == shader.constantIds.end())
            say("constant " + std::to_string(id) + " is declared, but the shader does not have it");
        if (std::count(pass.specialization.begin(), pass.specialization.begin() + static_cast<std::ptrdiff_t>(i), id))
            say("constant " + std::to_string(id) + " is declared twice");
    }
    for (const std::uint32_t id : shader.constantIds) {
        if (std::ranges::find(pass.specialization, id) == pass.specialization.end())
            say("constant " + std::to_string(id) + " is in the shader, but not declared");
    }
    return out;
}

fs::path shaderFolder() {
    return fs::path(GNOMON_BINARY_DIR) / "src/shaders";
}

std::vector<const Pass*> allPasses() {
    std::vector<const Pass*> out;
    for (std::uint32_t id = 0; id < kPassCount; ++id) out.push_back(&passOf(static_cast<PassId>(id)));
    return out;
}

ShaderLayout shaderOf(const Pass& pass) {
    return reflect(shaderFolder() / (std::string(pass.name) + ".spv"));
}

class Passes : public ::testing::TestWithParam<const Pass*> {
protected:
    // Whether resource i stands beside another of the same place.
    static bool hasTwin(std::size_t i) {
        const PassResource& r = GetParam()->resources[i];
        return std::ranges::count_if(GetParam()->resources, [&](const PassResource& other) {
                   return other.set == r.set && other.binding == r.binding;
               }) == 2;
    }
};

TEST_P(Passes, DeclareWhatTheirShadersDo) {
    EXPECT_EQ(differences(declaredBy(*GetParam()), shaderOf(*GetParam())), "");
}

// What is reflected here is what the pass runs.
TEST_P(Passes, HoldTheBuiltShader) {
    const Pass& pass = *GetParam();
    std::ifstream in(shaderFolder() / (std::string(pass.name) + ".spv"), std::ios::binary);
    std::vector<std::uint32_t> words(pass.spirv.size());
    in.read(reinterpret_cast<char*>(words.data()), static_cast<std::streamsize>(words.size() * 4));
    EXPECT_TRUE(in);
    EXPECT_EQ(in.peek(), std::char_traits<char>::eof());
    EXPECT_TRUE(std::ranges::equal(words, pass.spirv));
}

TEST_P(Passes, NameBindingsOfTheSets) {
    constexpr std::uint32_t kCounts[kSetCount] = {kListsBindingCount, kReceiversBindingCount, kShadowmapsBindingCount,
                                                  kWorkingBindingCount};
    for (const PassResource& r : GetParam()->resources) {
        ASSERT_LT(r.set, kSetCount);
        EXPECT_LT(r.binding, kCounts[r.set]) << placeOf(r.set, r.binding);
    }
}

// --- The check can fail: each change of a real declaration is told, by its place -------------------------------------

TEST_P(Passes, AMissingResourceIsTold) {
    const ShaderLayout shader = shaderOf(*GetParam());
    for (std::size_t i = 0; i < GetParam()->resources.size(); ++i) {
        Declared pass = declaredBy(*GetParam());
        const PassResource gone = pass.resources[i];
        pass.resources.erase(pass.resources.begin() + static_cast<std::ptrdiff_t>(i));
        const std::string place = pass.name + ": " + placeOf(gone.set, gone.binding);
        if (!hasTwin(i)) {
            EXPECT_EQ(differences(pass, shader), place + " is in the shader, but not declared\n");
        } else if (gone.access != Access::Indirect) {
            EXPECT_EQ(differences(pass, shader), place + " is declared Indirect, but the shader uses it\n");
        }  // Reflection cannot see the dispatch: PassList.DispatchesAreIndirectWhereDeclared.
    }
}

TEST_P(Passes, AResourceTooManyIsTold) {
    const ShaderLayout shader = shaderOf(*GetParam());
    const std::vector<PassResource> own = declaredBy(*GetParam()).resources;
    std::size_t planted = 0;
    for (const Pass* other : allPasses()) {
        for (const PassResource& more : other->resources) {
            const auto same = [&](const PassResource& r) { return r.set == more.set && r.binding == more.binding; };
            if (std::ranges::any_of(own, same)) continue;
            if (more.access == Access::Indirect) continue;  // of the dispatch: a shader need not use it
            Declared pass = declaredBy(*GetParam());
            pass.resources.push_back(more);
            EXPECT_EQ(differences(pass, shader), pass.name + ": " + placeOf(more.set, more.binding) + " is declared " +
                                                     wordFor(more.access) + ", but the shader does not use it\n");
            ++planted;
        }
    }
    EXPECT_GT(planted, 0u);
    Declared twice = declaredBy(*GetParam());
    twice.resources.push_back(twice.resources.front());
    EXPECT_THAT(differences(twice, shader), HasSubstr("was declared before"));
}

TEST_P(Passes, AnotherAccessIsTold) {
    const ShaderLayout shader = shaderOf(*GetParam());
    for (std::size_t i = 0; i < GetParam()->resources.size(); ++i) {
        for (const Access access :
             {Access::Uniform, Access::Streamed, Access::Sampled, Access::Read, Access::Write, Access::Indirect}) {
            Declared pass = declaredBy(*GetParam());
            PassResource& r = pass.resources[i];
            if (r.access == access) continue;
            r.access = access;
            const std::string told = pass.name + ": " + placeOf(r.set, r.binding) + " is declared ";
            // Of the two, the command may not become a second access by the shader.
            const bool again = hasTwin(i) && GetParam()->resources[i].access == Access::Indirect;
            EXPECT_THAT(differences(pass, shader),
                        AnyOf(HasSubstr(told + wordFor(access) + ", but "),
                              HasSubstr(again ? told + wordFor(access) + ", and was declared before" : told + "?")));
        }
    }
}

TEST_P(Passes, OtherConstantsAreTold) {
    const ShaderLayout shader = shaderOf(*GetParam());
    const std::vector<std::uint32_t> own = declaredBy(*GetParam()).specialization;
    for (std::uint32_t id = 0; id <= kSpecCount; ++id) {
        Declared pass = declaredBy(*GetParam());
        const std::string constant = pass.name + ": constant " + std::to_string(id);
        if (std::erase(pass.specialization, id) != 0) {
            EXPECT_EQ(differences(pass, shader), constant + " is in the shader, but not declared\n");
        } else {
            pass.specialization.push_back(id);
            EXPECT_THAT(differences(pass, shader),
                        HasSubstr(constant + " is declared, but the shader does not have it"));
        }
    }
    Declared twice = declaredBy(*GetParam());
    twice.specialization.push_back(own.front());
    EXPECT_THAT(differences(twice, shader), HasSubstr("is declared twice"));
}

// A shader that writes what its pass says to read: the other side changes.
TEST_P(Passes, AnotherShaderIsTold) {
    const Declared pass = declaredBy(*GetParam());
    for (std::size_t i = 0; i < pass.resources.size(); ++i) {
        const PassResource& r = pass.resources[i];
        ShaderLayout shader = shaderOf(*GetParam());
        const auto used = std::ranges::find_if(
            shader.resources, [&](const ResourceLayout& l) { return l.set == r.set && l.binding == r.binding; });
        ASSERT_NE(used, shader.resources.end());
        if (r.access == Access::Read || r.access == Access::Streamed) {
            used->written = true;
            EXPECT_THAT(differences(pass, shader), HasSubstr("but the shader writes it"));
        }
        if (r.access == Access::Write) {
            used->written = false;
            used->read = true;
            EXPECT_THAT(differences(pass, shader), HasSubstr("but the shader does not write it"));
        }
        used->written = used->read = false;
        EXPECT_THAT(differences(pass, shader), HasSubstr("but the shader does not use it"));
    }
}

INSTANTIATE_TEST_SUITE_P(All, Passes, ::testing::ValuesIn(allPasses()),
                         [](const auto& info) { return std::string(info.param->name); });

TEST(PassList, HasAShaderEachAndEachOnce) {
    std::vector<std::string> names, files;
    for (const Pass* pass : allPasses()) names.emplace_back(pass->name);
    for (const auto& entry : fs::directory_iterator(shaderFolder())) {
        if (entry.path().extension() == ".spv") files.push_back(entry.path().stem().string());
    }
    EXPECT_THAT(names, ::testing::UnorderedElementsAreArray(files));
    EXPECT_THAT(names, ::testing::ElementsAre("hierarchical_depth", "find_lights_approximate", "find_lights_accurate",
                                              "shadow_bounds", "filter_tiles", "classify_pairs", "search_pairs",
                                              "filter_pairs", "gather_statistics"));
}

// What a shader does not show: which passes the GPU itself sizes. Recorder::dispatch() asserts that dispatches are
// indirect where a pass declares it, and only there. The command must lie in a buffer of the view, made for it.
TEST(PassList, DispatchesAreIndirectWhereDeclared) {
    FakeVulkan vulkan;
    std::unique_ptr<Context> context;
    ASSERT_TRUE(Context::create(vulkan.desc(), context));
    ViewDesc desc;
    desc.maxWidthPx = desc.maxHeightPx = 64;
    std::unique_ptr<View> view;
    ASSERT_TRUE(View::create(*context, desc, view));
    std::vector<std::string> indirect;
    for (const Pass* pass : allPasses()) {
        for (const PassResource& r : pass->resources) {
            if (r.access != Access::Indirect) continue;
            indirect.emplace_back(pass->name);
            const ViewBuffer* const buffer = bufferAt(r.set, r.binding);
            ASSERT_NE(buffer, nullptr) << pass->name;
            EXPECT_STREQ(buffer->name, "pair_queues") << pass->name;
            EXPECT_NE(vulkan.usages.at(view->buffer(buffer->name)) & VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, 0u);
        }
    }
    EXPECT_THAT(indirect, ::testing::ElementsAre("classify_pairs", "search_pairs", "filter_pairs"));
}

// Every buffer of the view is used by a pass, and every working buffer is written by one.
TEST(PassList, UsesEveryBufferOfTheView) {
    for (const ViewBuffer& buffer : viewBuffers()) {
        if (buffer.kind == BufferKind::Readback) continue;
        bool used = false, written = false;
        for (const Pass* pass : allPasses()) {
            for (const PassResource& r : pass->resources) {
                if (r.set != buffer.set || r.binding != buffer.binding) continue;
                used = true;
                written = written || r.access == Access::Write;
            }
        }
        EXPECT_TRUE(used) << buffer.name;
        EXPECT_EQ(written, buffer.kind == BufferKind::Device) << buffer.name;
    }
}

}  // namespace
}  // namespace gnomon::house
