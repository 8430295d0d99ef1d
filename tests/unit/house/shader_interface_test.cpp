// CPU and GPU agree: the compiled shaders' structures, bindings, work group sizes, specialization constants and
// capabilities against the C++ that fills them.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <type_traits>

#include "core/context.h"
#include "core/passes.h"
#include "gpu_interface/numbers.h"
#include "gpu_interface/structs.h"
#include "renderer/lighting/lighting_data.h"
#include "unit/house/fake_vulkan.h"
#include "unit/house/reflection.h"

namespace gnomon::house {
namespace {

namespace fs = std::filesystem;
using namespace gpu;
using renderer::HostLight;
using renderer::SceneConstants;

constexpr std::uint32_t kHostSet = kSetWorking;  // in lighting shaders, which have no working buffers

// --- What C++ says ---------------------------------------------------------------------------------------------------

template <typename T>
MemberLayout memberAt(std::size_t offset) {
    constexpr bool unsignedWords = std::is_same_v<T, uint> || std::is_same_v<T, uvec2>;
    return {offset, sizeof(T), unsignedWords ? 'u' : 'f'};
}
#define MEMBER(type, name) memberAt<decltype(type::name)>(offsetof(type, name))

std::vector<MemberLayout> gpuLight() {
    return {MEMBER(GpuLight, positionWs),        MEMBER(GpuLight, rangeMetres),  MEMBER(GpuLight, directionWs),
            MEMBER(GpuLight, cosOuter),          MEMBER(GpuLight, positionVs),   MEMBER(GpuLight, sinOuter),
            MEMBER(GpuLight, directionVs),       MEMBER(GpuLight, sourceRadius), MEMBER(GpuLight, typeAndFlags),
            MEMBER(GpuLight, lightMask),         MEMBER(GpuLight, shadowView),   MEMBER(GpuLight, hostIndex),
            MEMBER(GpuLight, lightFade),         MEMBER(GpuLight, shadowFade),   MEMBER(GpuLight, biasMetres),
            MEMBER(GpuLight, shadowFadePerMetre)};
}

std::vector<MemberLayout> gpuShadowView() {
    return {MEMBER(GpuShadowView, clipFromWorld),    MEMBER(GpuShadowView, pxFromNdcScale),
            MEMBER(GpuShadowView, pxFromNdcOffset),  MEMBER(GpuShadowView, rectMinPx),
            MEMBER(GpuShadowView, rectMaxPx),        MEMBER(GpuShadowView, depthFromLinearA),
            MEMBER(GpuShadowView, depthFromLinearB), MEMBER(GpuShadowView, flags),
            MEMBER(GpuShadowView, atlasAndLayer),    MEMBER(GpuShadowView, pxPerMetre),
            MEMBER(GpuShadowView, atlasPerTexel),    MEMBER(GpuShadowView, boundsFirst),
            MEMBER(GpuShadowView, boundsRow),        MEMBER(GpuShadowView, boundsBlocks),
            MEMBER(GpuShadowView, reserved),         MEMBER(GpuShadowView, planeX),
            MEMBER(GpuShadowView, planeSlopePerPxX), MEMBER(GpuShadowView, planeY),
            MEMBER(GpuShadowView, planeSlopePerPxY), MEMBER(GpuShadowView, planeZ),
            MEMBER(GpuShadowView, depthStep),        MEMBER(GpuShadowView, tangentPerNdc),
            MEMBER(GpuShadowView, mostBias),         MEMBER(GpuShadowView, leastBias)};
}

std::vector<MemberLayout> gpuShadowBoundsCell() {
    return {MEMBER(GpuShadowBoundsCell, atlasAndLayer),
            MEMBER(GpuShadowBoundsCell, cellX),
            MEMBER(GpuShadowBoundsCell, cellY),
            MEMBER(GpuShadowBoundsCell, first),
            MEMBER(GpuShadowBoundsCell, row),
            MEMBER(GpuShadowBoundsCell, blocks),
            MEMBER(GpuShadowBoundsCell, atlasPerTexelX),
            MEMBER(GpuShadowBoundsCell, atlasPerTexelY)};
}

std::vector<MemberLayout> gpuPcssTaps() {
    return {MEMBER(GpuPcssTaps, searchTaps), MEMBER(GpuPcssTaps, filterTaps), MEMBER(GpuPcssTaps, perSearchTapSquared),
            MEMBER(GpuPcssTaps, perFilterTap)};
}

std::vector<MemberLayout> gpuPcssTap() {
    return {MEMBER(GpuPcssTap, filtered),  MEMBER(GpuPcssTap, searched),  MEMBER(GpuPcssTap, squared),
            MEMBER(GpuPcssTap, reserved0), MEMBER(GpuPcssTap, reserved1), MEMBER(GpuPcssTap, reserved2)};
}

// Members of an array's elements, behind each other.
void appendArray(std::vector<MemberLayout>& out, std::size_t offset, std::size_t count, std::size_t stride,
                 const std::vector<MemberLayout>& members) {
    for (std::size_t i = 0; i < count; ++i) {
        for (MemberLayout member : members) {
            member.offset += offset + i * stride;
            out.push_back(member);
        }
    }
}

std::vector<MemberLayout> gpuFrame() {
    std::vector<MemberLayout> out = {MEMBER(GpuFrame, eyeWs),
                                     MEMBER(GpuFrame, backgroundDepth),
                                     MEMBER(GpuFrame, axisXWs),
                                     MEMBER(GpuFrame, zBinNearDepth),
                                     MEMBER(GpuFrame, axisYWs),
                                     MEMBER(GpuFrame, zBinsPerMetre),
                                     MEMBER(GpuFrame, axisZWs),
                                     MEMBER(GpuFrame, farthestReach),
                                     MEMBER(GpuFrame, viewXyPerPixel),
                                     MEMBER(GpuFrame, viewXyAtPixel0),
                                     MEMBER(GpuFrame, viewDepthNumerator),
                                     MEMBER(GpuFrame, viewDepthDenominator),
                                     MEMBER(GpuFrame, extentPx),
                                     MEMBER(GpuFrame, viewportPx),
                                     MEMBER(GpuFrame, tileCounts),
                                     MEMBER(GpuFrame, tileGroupCounts),
                                     MEMBER(GpuFrame, lightCount),
                                     MEMBER(GpuFrame, directionalLightCount),
                                     MEMBER(GpuFrame, maskTileColumns),
                                     MEMBER(GpuFrame, maskTileRows),
                                     MEMBER(GpuFrame, listCapacity),
                                     MEMBER(GpuFrame, slotCapacity),
                                     MEMBER(GpuFrame, fixedListEntries),
                                     MEMBER(GpuFrame, flags),
                                     MEMBER(GpuFrame, subsurfaceBiasMetres),
                                     MEMBER(GpuFrame, hostDepthStep),
                                     MEMBER(GpuFrame, largestCoordinate),
                                     MEMBER(GpuFrame, reserved0),
                                     MEMBER(GpuFrame, frameNumber),
                                     MEMBER(GpuFrame, patternTurn),
                                     MEMBER(GpuFrame, reserved1),
                                     MEMBER(GpuFrame, reserved2)};
    appendArray(out, offsetof(GpuFrame, pcssTaps), gpu::kMaxPcssPresets, sizeof(GpuPcssTaps), gpuPcssTaps());
    appendArray(out, offsetof(GpuFrame, pcssPattern), gpu::kMaxPcssTaps, sizeof(GpuPcssTap), gpuPcssTap());
    return out;
}

std::vector<MemberLayout> gpuCounters() {
    return {MEMBER(GpuCounters, listEntries),
            MEMBER(GpuCounters, visibilitySlots),
            MEMBER(GpuCounters, listOverflowTiles),
            MEMBER(GpuCounters, slotOverflowEntries),
            MEMBER(GpuCounters, accurateExceedsApproximate),
            MEMBER(GpuCounters, tilesWithGeometry),
            MEMBER(GpuCounters, approximateEntries),
            MEMBER(GpuCounters, earlyEntries),
            MEMBER(GpuCounters, earlyCastingEntries),
            MEMBER(GpuCounters, finalEntries),
            MEMBER(GpuCounters, finalSlotEntries),
            MEMBER(GpuCounters, maxLightsInTile),
            MEMBER(GpuCounters, frameStamp)};
}

std::vector<MemberLayout> gpuPairQueue() {
    return {MEMBER(GpuPairQueue, searchGroupCountX),
            MEMBER(GpuPairQueue, searchGroupCountY),
            MEMBER(GpuPairQueue, searchGroupCountZ),
            MEMBER(GpuPairQueue, searchCount),
            MEMBER(GpuPairQueue, filterGroupCountX),
            MEMBER(GpuPairQueue, filterGroupCountY),
            MEMBER(GpuPairQueue, filterGroupCountZ),
            MEMBER(GpuPairQueue, filterCount),
            MEMBER(GpuPairQueue, listed),
            MEMBER(GpuPairQueue, first),
            MEMBER(GpuPairQueue, reserved0),
            MEMBER(GpuPairQueue, reserved1)};
}

std::vector<MemberLayout> gpuPairHead() {
    std::vector<MemberLayout> out = {MEMBER(GpuPairHead, classifyGroupCountX), MEMBER(GpuPairHead, classifyGroupCountY),
                                     MEMBER(GpuPairHead, classifyGroupCountZ), MEMBER(GpuPairHead, reserved0)};
    appendArray(out, offsetof(GpuPairHead, queues), kPairQueueCount, sizeof(GpuPairQueue), gpuPairQueue());
    return out;
}

std::vector<MemberLayout> gpuEvaluateHead() {
    return {MEMBER(GpuEvaluateHead, groupCountX), MEMBER(GpuEvaluateHead, groupCountY),
            MEMBER(GpuEvaluateHead, groupCountZ), MEMBER(GpuEvaluateHead, tileCount)};
}

std::vector<MemberLayout> hostLight() {
    return {MEMBER(HostLight, intensity), MEMBER(HostLight, coneVersine),
            MEMBER(HostLight, coneScale), MEMBER(HostLight, windowPerSquareMetre),
            MEMBER(HostLight, reserved0), MEMBER(HostLight, reserved1)};
}

std::vector<MemberLayout> sceneConstants() {
    return {MEMBER(SceneConstants, skyRadiance), MEMBER(SceneConstants, groundRadiance)};
}

PartLayout structAt(std::size_t offset, std::vector<MemberLayout> members) {
    return {offset, 0, false, std::move(members)};
}
PartLayout arrayAt(std::size_t offset, std::size_t stride, std::vector<MemberLayout> members) {
    return {offset, stride, true, std::move(members)};
}

using Key = std::pair<std::uint32_t, std::uint32_t>;  // set, binding

using Blocks = std::map<Key, std::vector<PartLayout>>;

// The blocks of the sets that library and hosts share, as C++ fills them.
Blocks sharedBlocks() {
    const PartLayout words = arrayAt(0, 4, {memberAt<uint>(0)});
    return {
        {{kSetLists, kBindFrame}, {structAt(0, gpuFrame())}},
        {{kSetLists, kBindLights}, {arrayAt(0, sizeof(GpuLight), gpuLight())}},
        {{kSetLists, kBindZBins}, {words}},
        {{kSetLists, kBindTileLightMasks}, {words}},
        {{kSetLists, kBindTileGroupLightMasks}, {words}},
        {{kSetLists, kBindTileDepthRanges}, {arrayAt(0, 8, {memberAt<vec2>(0)})}},
        {{kSetLists, kBindTileLightSlotIds}, {words}},
        {{kSetLists, kBindEarlyList}, {words}},
        {{kSetLists, kBindEarlyCounts}, {words}},
        {{kSetLists, kBindFinalList}, {words}},
        {{kSetLists, kBindFinalCounts}, {words}},
        {{kSetLists, kBindVisibility}, {words}},
        {{kSetLists, kBindEvaluateTiles},
         {structAt(0, gpuEvaluateHead()), arrayAt(sizeof(GpuEvaluateHead), 4, {memberAt<uint>(0)})}},
        {{kSetShadowmaps, kBindShadowViews}, {arrayAt(0, sizeof(GpuShadowView), gpuShadowView())}},
        {{kSetShadowmaps, kBindShadowBounds}, {arrayAt(0, 8, {memberAt<vec2>(0)})}},
    };
}

// With those of the working set.
const Blocks& libraryBlocks() {
    static const Blocks all = [] {
        Blocks blocks = sharedBlocks();
        blocks[{kSetWorking, kBindCounters}] = {structAt(0, gpuCounters())};
        blocks[{kSetWorking, kBindApproximateCounts}] = {arrayAt(0, 4, {memberAt<uint>(0)})};
        blocks[{kSetWorking, kBindTileDepthSlices}] = {arrayAt(0, 4, {memberAt<uint>(0)})};
        blocks[{kSetWorking, kBindShadowBoundsCells}] = {
            arrayAt(0, sizeof(GpuShadowBoundsCell), gpuShadowBoundsCell())};
        blocks[{kSetWorking, kBindListTiles}] = {arrayAt(0, 4, {memberAt<uint>(0)})};
        blocks[{kSetWorking, kBindPairQueues}] = {structAt(0, gpuPairHead())};
        blocks[{kSetWorking, kBindQueuedPairs}] = {arrayAt(0, 4, {memberAt<uint>(0)})};
        return blocks;
    }();
    return all;
}

// With those of the renderer's own set.
const Blocks& lightingBlocks() {
    static const Blocks all = [] {
        Blocks blocks = sharedBlocks();
        blocks[{kHostSet, 5}] = {arrayAt(0, sizeof(HostLight), hostLight())};
        blocks[{kHostSet, 6}] = {structAt(0, sceneConstants())};
        return blocks;
    }();
    return all;
}

// --- What the shaders say --------------------------------------------------------------------------------------------

std::vector<ShaderLayout> shadersIn(const char* directory, const std::string& prefix = {}) {
    std::vector<ShaderLayout> out;
    for (const auto& entry : fs::directory_iterator(fs::path(GNOMON_BINARY_DIR) / directory)) {
        const std::string name = entry.path().filename().string();
        if (name.ends_with(".spv") && name.starts_with(prefix)) out.push_back(reflect(entry.path()));
    }
    std::ranges::sort(out, {}, &ShaderLayout::name);
    return out;
}

const std::vector<ShaderLayout>& libraryShaders() {
    static const std::vector<ShaderLayout> all = shadersIn("src/shaders");
    return all;
}

const std::vector<ShaderLayout>& lightingShaders() {
    static const std::vector<ShaderLayout> all = shadersIn("renderer/shaders", "lighting_");
    return all;
}

std::vector<ShaderLayout> libraryAndLighting() {
    std::vector<ShaderLayout> all = libraryShaders();
    all.insert(all.end(), lightingShaders().begin(), lightingShaders().end());
    return all;
}

std::optional<ShaderLayout> shaderNamed(const std::string& name) {
    for (const ShaderLayout& shader : libraryAndLighting()) {
        if (shader.name == name) return shader;
    }
    return std::nullopt;
}

std::string whereIs(const ShaderLayout& shader, const ResourceLayout& resource) {
    return shader.name + ", set " + std::to_string(resource.set) + ", binding " + std::to_string(resource.binding);
}

// Every difference between a shader's block and C++, in words; empty if there is none.
std::string differences(const std::vector<PartLayout>& shader, const std::vector<PartLayout>& cpp) {
    if (shader.size() != cpp.size()) return "another number of parts; ";
    std::string out;
    for (std::size_t i = 0; i < cpp.size(); ++i) {
        const std::string part = "part " + std::to_string(i);
        if (shader[i].offset != cpp[i].offset) out += part + ": offset; ";
        if (shader[i].arrayStride != cpp[i].arrayStride) out += part + ": array stride; ";
        if (shader[i].runtimeArray != cpp[i].runtimeArray) out += part + ": array; ";
        if (shader[i].members.size() != cpp[i].members.size()) {
            out += part + ": number of members; ";
            continue;
        }
        for (std::size_t m = 0; m < cpp[i].members.size(); ++m) {
            if (shader[i].members[m] != cpp[i].members[m]) out += part + ", member " + std::to_string(m) + "; ";
        }
    }
    return out;
}

TEST(ShaderInterface, AllShadersAreSeen) {
    std::vector<std::string> names;
    for (const ShaderLayout& shader : libraryAndLighting()) names.push_back(shader.name);
    for (const char* name : {"hierarchical_depth", "find_lights_approximate", "find_lights_accurate", "shadow_bounds",
                             "filter_tiles", "classify_pairs", "search_pairs", "filter_pairs", "gather_statistics",
                             "lighting_deferred", "lighting_evaluate", "lighting_inline", "lighting_deferred_float",
                             "lighting_evaluate_float", "lighting_inline_float"}) {
        EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
    }
}

void checkBlocks(const std::vector<ShaderLayout>& shaders, const Blocks& blocks, std::map<Key, int>& seen) {
    for (const ShaderLayout& shader : shaders) {
        for (const ResourceLayout& resource : shader.resources) {
            if (resource.parts.empty()) continue;
            const auto expected = blocks.find({resource.set, resource.binding});
            ASSERT_NE(expected, blocks.end()) << whereIs(shader, resource) << ": C++ knows no such buffer";
            EXPECT_EQ(differences(resource.parts, expected->second), "") << whereIs(shader, resource);
            ++seen[expected->first];
        }
    }
}

TEST(ShaderInterface, MembersStandWhereCppPutsThem) {
    std::map<Key, int> library, lighting;
    checkBlocks(libraryShaders(), libraryBlocks(), library);
    checkBlocks(lightingShaders(), lightingBlocks(), lighting);
    for (const auto& [key, parts] : libraryBlocks()) {
        EXPECT_GT(library[key], 0) << "no pass uses set " << key.first << ", binding " << key.second;
    }
    for (const auto& [key, parts] : lightingBlocks()) {
        if (key.first == kHostSet) {
            EXPECT_GT(lighting[key], 0) << "no shader uses binding " << key.second;
        }
    }
}

// The whole of a structure is in its members: no byte is left out of the tables above.
TEST(ShaderInterface, TablesCoverTheStructures) {
    const auto bytes = [](const std::vector<MemberLayout>& members) {
        std::size_t sum = 0;
        for (const MemberLayout& m : members) sum += m.bytes;
        return sum;
    };
    EXPECT_EQ(bytes(gpuLight()), sizeof(GpuLight));
    EXPECT_EQ(bytes(gpuShadowView()), sizeof(GpuShadowView));
    EXPECT_EQ(bytes(gpuShadowBoundsCell()), sizeof(GpuShadowBoundsCell));
    EXPECT_EQ(bytes(gpuPcssTaps()), sizeof(GpuPcssTaps));
    EXPECT_EQ(bytes(gpuPcssTap()), sizeof(GpuPcssTap));
    EXPECT_EQ(bytes(gpuFrame()), sizeof(GpuFrame));
    EXPECT_EQ(bytes(gpuCounters()), sizeof(GpuCounters));
    EXPECT_EQ(bytes(gpuPairQueue()), sizeof(GpuPairQueue));
    EXPECT_EQ(bytes(gpuPairHead()), sizeof(GpuPairHead));
    EXPECT_EQ(bytes(gpuEvaluateHead()), sizeof(GpuEvaluateHead));
    EXPECT_EQ(bytes(hostLight()), sizeof(HostLight));
    EXPECT_EQ(bytes(sceneConstants()), sizeof(SceneConstants));
}

// The comparison above can fail: each difference planted into a real shader's layout is told.
TEST(ShaderInterface, DifferencesAreTold) {
    const std::optional<ShaderLayout> shader = shaderNamed("filter_pairs");
    ASSERT_TRUE(shader);
    const auto lights = std::ranges::find_if(
        shader->resources, [](const ResourceLayout& r) { return r.set == kSetLists && r.binding == kBindLights; });
    ASSERT_NE(lights, shader->resources.end());
    const std::vector<PartLayout>& cpp = libraryBlocks().at({kSetLists, kBindLights});
    const auto planted = [&](const std::function<void(PartLayout&)>& change) {
        std::vector<PartLayout> parts = lights->parts;
        change(parts[0]);
        return differences(parts, cpp);
    };
    EXPECT_EQ(planted([](PartLayout&) {}), "");
    EXPECT_NE(planted([](PartLayout& p) { p.offset += 4; }), "");
    EXPECT_NE(planted([](PartLayout& p) { p.arrayStride = 112; }), "");
    EXPECT_NE(planted([](PartLayout& p) { p.members.pop_back(); }), "");
    EXPECT_NE(planted([](PartLayout& p) { std::swap(p.members[1], p.members[2]); }), "");
    EXPECT_NE(planted([](PartLayout& p) { p.members[8].kind = 'f'; }), "");
    EXPECT_NE(planted([](PartLayout& p) { p.members[0].bytes = 16; }), "");
}

// Sets and bindings exist in the layouts that Context really creates, with the same type of descriptor.
TEST(ShaderInterface, BindingsAreThoseOfTheContext) {
    FakeVulkan vulkan;
    std::unique_ptr<Context> context;
    ASSERT_TRUE(Context::create(vulkan.desc(), context));
    const FakeVulkan::SetLayout* layouts[] = {
        vulkan.find(context->listsSetLayout()), vulkan.find(context->receiversSetLayout()),
        vulkan.find(context->shadowmapsSetLayout()), vulkan.find(context->state().setLayouts[kSetWorking])};
    const std::size_t counts[] = {kListsBindingCount, kReceiversBindingCount, kShadowmapsBindingCount,
                                  kWorkingBindingCount};
    for (std::size_t set = 0; set < kSetCount; ++set) {
        ASSERT_NE(layouts[set], nullptr);
        EXPECT_EQ(layouts[set]->bindings.size(), counts[set]);
    }
    for (const ShaderLayout& shader : libraryAndLighting()) {
        const bool lighting = shader.name.starts_with("lighting_");
        for (const ResourceLayout& resource : shader.resources) {
            ASSERT_LT(resource.set, kSetCount) << whereIs(shader, resource);
            if (lighting && resource.set == kHostSet) continue;
            const auto& bindings = layouts[resource.set]->bindings;
            const auto found = std::ranges::find(bindings, resource.binding, &FakeVulkan::Binding::binding);
            ASSERT_NE(found, bindings.end()) << whereIs(shader, resource);
            EXPECT_EQ(found->type, resource.type) << whereIs(shader, resource);
            EXPECT_EQ(found->count, resource.count) << whereIs(shader, resource);
        }
    }
}

TEST(ShaderInterface, PassesPushNoConstants) {
    for (const ShaderLayout& shader : libraryShaders()) EXPECT_EQ(shader.pushConstantBlocks, 0u) << shader.name;
}

// Whoever includes the sets without saying more may read, and no more: a host's shader never writes the lists.
TEST(ShaderInterface, LightingWritesNoListAndReadsNoWorkingBuffer) {
    for (const ShaderLayout& shader : lightingShaders()) {
        for (const ResourceLayout& resource : shader.resources) {
            if (resource.set != kHostSet) {
                EXPECT_FALSE(resource.written) << whereIs(shader, resource);
            }
        }
    }
}

std::size_t resourcesIn(const ShaderLayout& shader, std::uint32_t set) {
    return static_cast<std::size_t>(std::ranges::count(shader.resources, set, &ResourceLayout::set));
}

// The registers that the technique saves are saved only if the main lighting pipeline cannot sample a shadowmap.
TEST(ShaderInterface, MainLightingSeesNoShadowmap) {
    for (const char* name : {"lighting_deferred", "lighting_deferred_float"}) {
        const std::optional<ShaderLayout> deferred = shaderNamed(name);
        ASSERT_TRUE(deferred) << name;
        EXPECT_EQ(resourcesIn(*deferred, kSetShadowmaps), 0u) << name;
        EXPECT_GT(resourcesIn(*deferred, kSetLists), 0u) << name;
    }
    for (const char* name : {"lighting_evaluate", "lighting_inline", "lighting_evaluate_float", "lighting_inline_float",
                             "filter_tiles", "search_pairs", "filter_pairs"}) {
        const std::optional<ShaderLayout> shader = shaderNamed(name);
        ASSERT_TRUE(shader) << name;
        EXPECT_EQ(resourcesIn(*shader, kSetShadowmaps), kShadowmapsBindingCount) << name;
    }
    for (const char* name : {"hierarchical_depth", "find_lights_approximate", "find_lights_accurate", "classify_pairs",
                             "gather_statistics"}) {
        const std::optional<ShaderLayout> shader = shaderNamed(name);
        ASSERT_TRUE(shader) << name;
        EXPECT_EQ(resourcesIn(*shader, kSetShadowmaps), 0u) << name;
    }
}

TEST(ShaderInterface, WorkGroupsAre64Lanes) {
    for (const ShaderLayout& shader : libraryAndLighting()) {
        ASSERT_TRUE(shader.compute) << shader.name;
        EXPECT_EQ(shader.workGroup[0], kWorkGroupSize) << shader.name;
        EXPECT_EQ(shader.workGroup[1], 1u) << shader.name;
        EXPECT_EQ(shader.workGroup[2], 1u) << shader.name;
    }
}

// Passes say theirs themselves; see passes_test.cpp. Lighting takes what the context gives, and two of its own.
TEST(ShaderInterface, ConstantsAreKnown) {
    static_assert(SpecializationValues::kCount == kSpecCount);
    const std::uint32_t ofTheRenderer = kSpecFirstFree + 2;
    for (const ShaderLayout& shader : lightingShaders()) {
        for (std::uint32_t id : shader.constantIds)
            EXPECT_TRUE(id < kSpecCount || (id >= kSpecFirstFree && id < ofTheRenderer)) << shader.name << " " << id;
    }
    for (const ShaderLayout& shader : libraryAndLighting()) {
        EXPECT_EQ(std::ranges::count(shader.constantIds, kSpecSubgroupSize), 1) << shader.name;
    }
}

// A pipeline and the values of all constants that it is asked for with.
struct Made {
    PassId pass;
    std::vector<std::uint32_t> values;
};

// With hard, pcss and pcss-shared, in the order in which they are made: those of the tiles have the tiles' filters
// alone, and those of a queue its filter and its kind of shadow views.
std::vector<Made> madeFor(const std::vector<std::uint32_t>& values) {
    std::vector<Made> out;
    for (std::uint32_t id = 0; id < kPassCount; ++id) {
        if (id == kPassSearchPairs || id == kPassFilterPairs) continue;
        out.push_back({static_cast<PassId>(id), values});
        if (id == kPassFilterTiles) {
            out.back().values[kSpecFilters] = 1u << kFilterPcf;
            out.back().values[kSpecPcssPresets] = 1;  // no filter of this pass asks it
        }
    }
    for (const std::uint32_t filter : {kFilterPcss, kFilterPcssShared}) {
        for (const std::uint32_t kind : {kShadowViewsOne, kShadowViewsSixFaces, kShadowViewsCascades}) {
            for (const PassId pass : {kPassFilterPairs, kPassSearchPairs}) {
                if (pass == kPassSearchPairs && filter != kFilterPcssShared) continue;
                out.push_back({pass, values});
                out.back().values[kSpecFilters] = 1u << filter;
                out.back().values[kSpecPcfRadius] = 1;  // likewise
                out.back().values[kSpecShadowViews] = kind;
            }
        }
    }
    return out;
}

// Constants reach every pipeline by their ids, those alone that its pass declares; full subgroups are asked for.
TEST(ShaderInterface, PipelinesGetTheConstants) {
    FakeVulkan vulkan;
    ContextDesc desc = vulkan.desc();
    desc.subgroupSize = 64;
    desc.maxShadowAtlases = 2;
    std::unique_ptr<Context> context;
    ASSERT_TRUE(Context::create(desc, context));
    ShadowSettings settings;
    settings.filters = only(Filter::Pcf) | only(Filter::Pcss) | only(Filter::PcssShared);
    settings.lightLists = LightLists::Pixel;
    settings.listReservation = ListReservation::Approximate;
    settings.pcfRadius = 3;
    settings.hostDepthPyramid = true;
    settings.pcssPresetCount = 3;
    settings.visibilityBits = 4;
    settings.depthBias = DepthBias::Unbiased;
    settings.facedAwayIsDark = true;
    std::vector<std::uint32_t> expected(kSpecCount);
    expected[kSpecSubgroupSize] = 64;
    expected[kSpecFilters] = 1u << kFilterPcf | 1u << kFilterPcss | 1u << kFilterPcssShared;
    expected[kSpecListReservation] = kReserveApproximate;
    expected[kSpecPcfRadius] = 3;
    expected[kSpecHostDepthPyramid] = 1;
    expected[kSpecPcssPresets] = 3;
    expected[kSpecVisibilityBits] = 4;
    expected[kSpecShadowAtlases] = 2;
    expected[kSpecDepthBias] = kDepthBiasUnbiased;
    expected[kSpecFacedAwayIsDark] = 1;
    expected[kSpecLightLists] = kListsByPixel;
    expected[kSpecShadowViews] = kShadowViewsAny;
    EXPECT_TRUE(std::ranges::equal(context->specialization(settings).values, expected));
    ASSERT_TRUE(context->prepare(settings));
    const std::vector<Made> made = madeFor(expected);
    ASSERT_EQ(vulkan.pipelines.size(), made.size());
    for (std::size_t i = 0; i < made.size(); ++i) {
        const Pass& pass = passOf(made[i].pass);
        SCOPED_TRACE(pass.name);
        std::map<std::uint32_t, std::uint32_t> values;
        for (const std::uint32_t constant : pass.specialization) values[constant] = made[i].values[constant];
        EXPECT_EQ(vulkan.pipelines[i].constants, values);
        EXPECT_EQ(vulkan.pipelines[i].spirvBytes, pass.spirv.size_bytes());
        EXPECT_EQ(vulkan.pipelines[i].requiredSubgroupSize, 64u);
        EXPECT_NE(vulkan.pipelines[i].stageFlags & VK_PIPELINE_SHADER_STAGE_CREATE_REQUIRE_FULL_SUBGROUPS_BIT, 0u);
    }
}

// Software devices and older hardware have no 8-, 16- or 64-bit types, no indexing of descriptors, no maintenance4.
// docs/limits.md states this list.
TEST(ShaderInterface, CapabilitiesAreFew) {
    constexpr std::uint32_t kShader = 1, kGroupNonUniform = 61, kGroupNonUniformArithmetic = 63;
    const std::vector<std::uint32_t> allowed = {kShader, kGroupNonUniform, kGroupNonUniformArithmetic};
    for (const ShaderLayout& shader : libraryAndLighting()) {
        for (std::uint32_t capability : shader.capabilities) {
            EXPECT_NE(std::ranges::find(allowed, capability), allowed.end()) << shader.name << " needs " << capability;
        }
        EXPECT_FALSE(shader.capabilities.empty()) << shader.name;
        EXPECT_LE(shader.spirvVersion, 0x00010500u) << shader.name;
    }
    for (const ShaderLayout& shader : shadersIn("renderer/shaders")) {
        for (std::uint32_t capability : shader.capabilities) {
            EXPECT_NE(std::ranges::find(allowed, capability), allowed.end()) << shader.name << " needs " << capability;
        }
    }
}

// What the widest shaders bind together: docs/limits.md states these numbers.
TEST(ShaderInterface, DescriptorsAreFew) {
    for (const ShaderLayout& shader : libraryAndLighting()) {
        const auto count = [&](VkDescriptorType type) {
            return std::ranges::count(shader.resources, type, &ResourceLayout::type);
        };
        EXPECT_LE(count(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER), 17) << shader.name;
        EXPECT_LE(count(VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER), 2) << shader.name;
        EXPECT_LE(count(VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE), 12) << shader.name;
        EXPECT_LE(count(VK_DESCRIPTOR_TYPE_SAMPLER), 1) << shader.name;
    }
}

}  // namespace
}  // namespace gnomon::house
