// What a driver's compiler makes of every compute pipeline of the technique: registers, spills, shared memory, code
// size and occupancy, as a Markdown table.
//
//     pipeline_report [DEVICE]      DEVICE: index or part of a name, as for `gnomon --device`
//
// Needs VK_KHR_pipeline_executable_properties. Mesa's RADV has it and compiles for AMD hardware that is not there:
// scripts/register_pressure.sh. What the table says about the technique: docs/register-pressure.md.
//
// The pipelines are those that the library and the reference renderer make for themselves: their calls of
// vkCreateComputePipelines are led through a function that asks for statistics as well.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "core/passes.h"
#include "gnomon/gnomon.h"
#include "gpu_interface/numbers.h"
#include "renderer/gpu/device.h"
#include "renderer/lighting/lighting_pipelines.h"
#include "renderer/shared_pipelines.h"
#include "scene/filter_names.h"

namespace gnomon {
namespace {

using renderer::Device;
using renderer::DeviceInfo;
using renderer::GpuError;

// The visibility providers that are compared: a row for each wherever shadows are evaluated. The last one has all.
struct Provider {
    const char* name;
    FilterSet filters;
    std::uint32_t pcfRadius;
};
constexpr Provider kProviders[] = {
    {"hard", only(Filter::Hard), 1},
    {"pcf, radius 1", only(Filter::Pcf), 1},
    {"pcf, radius 3", only(Filter::Pcf), 3},
    {"pcss", only(Filter::Pcss), 1},
    {"pcss-shared", only(Filter::PcssShared), 1},
    {"hard, pcf and both pcss", kAllBuiltInFilters, 1},
};
constexpr const char* kShadowViewsNames[gpu::kShadowViewsKinds + 1] = {"any", "one view", "six faces", "cascades"};

// A figure of a pipeline, under the names that drivers give it.
struct Column {
    const char* title;
    std::vector<std::string> names;
};
const std::vector<Column>& columns() {
    static const std::vector<Column> all = {
        {"VGPRs", {"VGPRs", "Register Count"}},  // RADV, as allocated; NVIDIA
        {"needed", {"Pre-Sched VGPRs"}},
        {"SGPRs", {"SGPRs"}},
        {"spilled VGPRs", {"Spilled VGPRs"}},
        {"spilled SGPRs", {"Spilled SGPRs"}},
        {"LDS B", {"LDS size", "Shared Memory Size"}},
        {"code B", {"Code size", "Binary Size"}},
        {"instructions", {"Instructions"}},
    };
    return all;
}

struct Statistics {
    std::vector<std::pair<std::string, std::uint64_t>> values;

    [[nodiscard]] std::optional<std::uint64_t> of(const Column& column) const {
        for (const auto& [name, value] : values)
            if (std::ranges::find(column.names, name) != column.names.end()) return value;
        return std::nullopt;
    }
};

// --- Statistics of every compute pipeline that is created ------------------------------------------------------------

struct Capture {
    PFN_vkCreateComputePipelines create = nullptr;
    PFN_vkGetPipelineExecutableStatisticsKHR statistics = nullptr;
    std::vector<Statistics> captured;
} capture;  // NOLINT: Vulkan's functions carry no user data

Statistics statisticsOf(VkDevice device, VkPipeline pipeline) {
    const VkPipelineExecutableInfoKHR which = {VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, nullptr, pipeline, 0};
    std::uint32_t count = 0;
    capture.statistics(device, &which, &count, nullptr);
    std::vector<VkPipelineExecutableStatisticKHR> found(count, {VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR});
    capture.statistics(device, &which, &count, found.data());
    Statistics out;
    for (const VkPipelineExecutableStatisticKHR& s : found) {
        const bool real = s.format == VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_FLOAT64_KHR;
        out.values.emplace_back(s.name, real ? static_cast<std::uint64_t>(s.value.f64) : s.value.u64);
    }
    return out;
}

VKAPI_ATTR VkResult VKAPI_CALL createCaptured(VkDevice device, VkPipelineCache, std::uint32_t count,
                                              const VkComputePipelineCreateInfo* infos,
                                              const VkAllocationCallbacks* callbacks, VkPipeline* out) {
    std::vector<VkComputePipelineCreateInfo> changed(infos, infos + count);
    for (VkComputePipelineCreateInfo& info : changed) info.flags |= VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
    const VkResult result = capture.create(device, VK_NULL_HANDLE, count, changed.data(), callbacks, out);
    for (std::uint32_t i = 0; result == VK_SUCCESS && i < count; ++i)
        capture.captured.push_back(statisticsOf(device, out[i]));
    return result;
}

PFN_vkVoidFunction VKAPI_CALL deviceFunction(VkDevice device, const char* name) {
    if (std::strcmp(name, "vkCreateComputePipelines") == 0) return reinterpret_cast<PFN_vkVoidFunction>(createCaptured);
    return vkGetDeviceProcAddr(device, name);
}

// What the library is told to load its functions with.
PFN_vkVoidFunction VKAPI_CALL instanceFunction(VkInstance instance, const char* name) {
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(deviceFunction);
    return vkGetInstanceProcAddr(instance, name);
}

// Waiting crashes in RADV's null device (docs/driver-ledger.md), and nothing is ever submitted here.
VKAPI_ATTR VkResult VKAPI_CALL doNotWait(VkDevice) {
    return VK_SUCCESS;
}

void checkExtension(const DeviceInfo& info) {
    std::uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(info.handle, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> found(count);
    vkEnumerateDeviceExtensionProperties(info.handle, nullptr, &count, found.data());
    for (const VkExtensionProperties& extension : found)
        if (std::strcmp(extension.extensionName, VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME) == 0) return;
    throw GpuError(fmt::format("'{}' tells nothing about its pipelines: it lacks {}.", info.name,
                               VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME));
}

// --- The pipelines ---------------------------------------------------------------------------------------------------

struct Row {
    std::size_t place = 0;  // in the order of execution
    std::string name;
    std::uint32_t lanes = 0;
    Statistics statistics;
};

std::unique_ptr<Context> makeContext(const Device& device, std::uint32_t lanes) {
    ContextDesc desc = renderer::contextDescOf(device);
    desc.getInstanceProcAddr = instanceFunction;
    desc.pipelineCache = VK_NULL_HANDLE;  // every pipeline is to be compiled
    desc.subgroupSize = lanes;
    desc.maxShadowAtlases = 1;  // as the reference renderer has
    std::unique_ptr<Context> context;
    const Result made = Context::create(desc, context);
    if (!made) throw GpuError(made.message());
    return context;
}

constexpr const char* kLightingNames[] = {"lighting_deferred", "lighting_evaluate", "lighting_inline",
                                          "lighting_unshadowed", "lighting_inline, lists alone"};

bool evaluatesShadows(const std::string& pipeline) {
    return pipeline == "filter_tiles" || pipeline == "lighting_evaluate" || pipeline.starts_with("lighting_inline");
}

Row rowOf(std::size_t place, const std::string& pipeline, const Provider& provider) {
    const std::string suffix = evaluatesShadows(pipeline) ? fmt::format(" ({})", provider.name) : "";
    return {place, pipeline + suffix};
}

// A pass that has a pipeline per queue: its filter and its kind of shadow views say which.
Row rowOf(PassId pass, Filter filter, std::uint32_t kind) {
    return {pass, fmt::format("{} ({}, {})", passOf(pass).name, nameOf(filter), kShadowViewsNames[kind])};
}

// What Context::prepare() makes, in the order in which it does.
std::vector<Row> libraryRows(const Provider& provider) {
    std::vector<Row> rows;
    for (std::uint32_t id = 0; id < kPassCount; ++id) {
        if (id == kPassSearchPairs || id == kPassFilterPairs || id == kPassFindLightsAccurate) continue;
        if (id == kPassFilterTiles && (provider.filters & gpu::kFiltersByTile) == 0) continue;
        if (id == kPassClassifyPairs && (provider.filters & ~gpu::kFiltersByTile) == 0) continue;
        rows.push_back(rowOf(id, passOf(static_cast<PassId>(id)).name, provider));
    }
    for (const Filter filter : {Filter::Pcss, Filter::PcssShared}) {
        if ((provider.filters & only(filter)) == 0) continue;
        for (std::uint32_t kind = 1; kind <= gpu::kShadowViewsKinds; ++kind) {
            rows.push_back(rowOf(kPassFilterPairs, filter, kind));
            if (filter == Filter::PcssShared) rows.push_back(rowOf(kPassSearchPairs, filter, kind));
        }
    }
    return rows;
}

// All pipelines of one provider and width, in the order in which they are created.
std::vector<Row> rowsOf(const Device& device, const Provider& provider, std::uint32_t lanes) {
    capture.captured.clear();
    const std::unique_ptr<Context> context = makeContext(device, lanes);
    ShadowSettings settings;
    settings.filters = provider.filters;
    settings.pcfRadius = provider.pcfRadius;
    if (const Result made = context->prepare(settings); !made) throw GpuError(made.message());
    std::vector<Row> rows = libraryRows(provider);
    ShadowSettings byPixel = settings;
    byPixel.lightLists = LightLists::Pixel;
    if (const Result made = context->prepare(byPixel); !made) throw GpuError(made.message());
    rows.push_back({kPassFindLightsApproximate, "find_lights_approximate, lists by pixel"});
    rows.push_back({kPassFindLightsAccurate, passOf(kPassFindLightsAccurate).name});
    using enum renderer::LightingKind;
    renderer::LightingPipelines lighting(device, *context);
    for (const renderer::LightingKind kind : {Deferred, Evaluate, Inline, Unshadowed}) lighting.get(kind, settings);
    // The reference renderer's inline pipeline as it is measured: without the way out for tiles that got no list space.
    lighting.get(Inline, settings, {.walksMasks = false});
    for (std::size_t i = 0; i < std::size(kLightingNames); ++i)
        rows.push_back(rowOf(kPassCount + i, kLightingNames[i], provider));
    if (rows.size() != capture.captured.size())
        throw GpuError(
            fmt::format("{} pipelines were made where {} were expected.", capture.captured.size(), rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].lanes = lanes;
        rows[i].statistics = capture.captured[i];
    }
    return rows;
}

// Every pipeline once, in the order of execution. Of the same name, that of the last provider.
std::vector<Row> rowsOf(const Device& device, std::uint32_t lanes) {
    std::vector<Row> all;
    for (const Provider& provider : kProviders) {
        for (const Row& row : rowsOf(device, provider, lanes)) {
            const auto same = std::ranges::find(all, row.name, &Row::name);
            if (same == all.end())
                all.push_back(row);
            else
                *same = row;
        }
    }
    std::ranges::stable_sort(all, {}, &Row::place);
    return all;
}

// --- Occupancy -------------------------------------------------------------------------------------------------------

// How many waves an RDNA2 SIMD holds at once. RADV's own "Subgroups per SIMD" counts in units of 32 lanes, whatever the
// wave's width, and knows no upper bound on the null device. So it is computed here from AMD's figures for RDNA2 ("RDNA
// 2" instruction set reference; Mesa's ac_gpu_info.c):
// - Registers: 1024 per lane of a 32-wide SIMD, given out by 16 to waves of 32. A register of a wave of 64 takes two of
//   them. So waves of 64 have 512, given out by 8.
// - Waves: 16 per SIMD of either width.
// - LDS: 128 KiB per work group processor of 4 SIMDs, given out by 1 KiB to a work group (of 64 lanes here).
std::uint32_t rdna2WavesPerSimd(std::uint64_t vgprs, std::uint64_t ldsBytes, std::uint32_t lanes) {
    const std::uint64_t registers = lanes == 32 ? 1024 : 512, granule = lanes == 32 ? 16 : 8;
    const std::uint64_t allocated = std::max<std::uint64_t>((vgprs + granule - 1) / granule, 1) * granule;
    std::uint64_t waves = std::min<std::uint64_t>(16, registers / allocated);
    if (ldsBytes != 0) {
        const std::uint64_t groups = 128 / ((ldsBytes + 1023) / 1024);
        waves = std::min(waves, groups * (gpu::kWorkGroupSize / lanes) / 4);
    }
    return static_cast<std::uint32_t>(waves);
}

bool isRdna2(const DeviceInfo& info) {
    return info.name.find("NAVI2") != std::string::npos;
}

// --- The table -------------------------------------------------------------------------------------------------------

void printRow(const Row& row, const std::vector<const Column*>& known, bool rdna2) {
    fmt::print("| {} | {} |", row.name, row.lanes);
    for (const Column* column : known) fmt::print(" {} |", row.statistics.of(*column).value_or(0));
    if (rdna2) {
        const auto figure = [&](const char* title) {
            const auto column = std::ranges::find(columns(), std::string_view(title), &Column::title);
            return row.statistics.of(*column).value_or(0);
        };
        const std::uint32_t waves = rdna2WavesPerSimd(figure("VGPRs"), figure("LDS B"), row.lanes);
        fmt::print(" {} | {} |", waves, waves * row.lanes);
    }
    fmt::print("\n");
}

// What all pipelines have alike stands above the table, and the rest in its columns.
std::vector<const Column*> printAlike(const std::vector<Row>& rows) {
    std::vector<const Column*> different;
    std::string alike;
    for (const Column& column : columns()) {
        const std::optional<std::uint64_t> first = rows.front().statistics.of(column);
        if (!first) continue;
        if (std::ranges::all_of(rows, [&](const Row& row) { return row.statistics.of(column) == first; }))
            alike += fmt::format("{}{} {}", alike.empty() ? "" : ", ", column.title, *first);
        else
            different.push_back(&column);
    }
    if (!alike.empty()) fmt::print("All alike: {}.\n\n", alike);
    return different;
}

void print(const DeviceInfo& info, const std::vector<Row>& rows) {
    fmt::print("{}, {}\n\n", info.name, info.driver);
    const std::vector<const Column*> different = printAlike(rows);
    std::string head = "| pipeline | lanes |", line = "|---|--:|";
    for (const Column* column : different) {
        head += fmt::format(" {} |", column->title);
        line += "--:|";
    }
    if (isRdna2(info)) {
        head += " waves per SIMD | pixels per SIMD |";
        line += "--:|--:|";
    }
    fmt::print("{}\n{}\n", head, line);
    for (const Row& row : rows) printRow(row, different, isRdna2(info));
}

void report(const std::string& wanted) {
    const renderer::VulkanInstance instance({.debugLabels = false});
    const DeviceInfo info = instance.chooseDevice(wanted);
    checkExtension(info);
    VkPhysicalDeviceMemoryProperties memory = {};
    vkGetPhysicalDeviceMemoryProperties(info.handle, &memory);
    if (memory.memoryTypeCount == 0) vkDeviceWaitIdle = doNotWait;
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR feature = {
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR, nullptr, VK_TRUE};
    const Device device(instance, info, {VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME}, &feature);
    capture.create = vkCreateComputePipelines;
    capture.statistics = reinterpret_cast<PFN_vkGetPipelineExecutableStatisticsKHR>(
        vkGetDeviceProcAddr(device.handle(), "vkGetPipelineExecutableStatisticsKHR"));
    vkCreateComputePipelines = createCaptured;
    std::vector<Row> rows;
    for (std::uint32_t lanes = std::max(info.minSubgroupSize, 4u);
         lanes <= std::min(info.maxSubgroupSize, gpu::kWorkGroupSize); lanes *= 2) {
        const std::vector<Row> more = rowsOf(device, lanes);
        rows.insert(rows.end(), more.begin(), more.end());
    }
    for (const Row& row : rows)
        if (row.statistics.values.empty())
            throw GpuError(fmt::format("'{}' gave no statistics of {}.", info.name, row.name));
    print(info, rows);
}

}  // namespace
}  // namespace gnomon

int main(int argc, char** argv) {
    try {
        if (argc > 2) throw std::runtime_error("Give one device at most: pipeline_report [DEVICE].");
        gnomon::report(argc > 1 ? argv[1] : "");
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "pipeline_report: %s\n", error.what());
        return 1;
    }
}
