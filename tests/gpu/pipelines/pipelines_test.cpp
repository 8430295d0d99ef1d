// Every variant of the library's pipelines, and the reference renderer's lighting pipelines with them, are made on
// every Vulkan device found, with validation and without a message.
//
// Run a second time (see tests/CMakeLists.txt) on RADV's null device, which compiles for AMD hardware that is not
// there: so the 64-wide variants are proven to compile. Nothing is executed here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "gnomon/gnomon.h"
#include "gpu_interface/numbers.h"
#include "renderer/lighting/lighting_pipelines.h"
#include "renderer/shared_pipelines.h"

namespace gnomon::renderer {
namespace {

using ::testing::HasSubstr;

bool onNullDevice() {
    return std::getenv("RADV_FORCE_FAMILY") != nullptr;
}

// Waiting crashes in RADV's null device (docs/driver-ledger.md), and nothing is ever submitted here.
VKAPI_ATTR VkResult VKAPI_CALL doNotWait(VkDevice) {
    return VK_SUCCESS;
}

std::unique_ptr<VulkanInstance> makeInstance(const InstanceDesc& desc) {
    auto instance = std::make_unique<VulkanInstance>(desc);
    if (onNullDevice()) vkDeviceWaitIdle = doNotWait;
    return instance;
}

class PipelinesTest : public ::testing::Test {
protected:
    // One for all tests, and gone before static objects are.
    static void SetUpTestSuite() {
        for (const bool validation : {true, false}) {
            try {
                shared_ = makeInstance({.validation = validation});
                return;
            } catch (const GpuError& error) {
                std::printf("skipped%s: %s\n", validation ? " validation" : "", error.what());
            }
        }
    }
    static void TearDownTestSuite() { shared_.reset(); }
    // Null, with a printed reason, where no instance can be made.
    static VulkanInstance* instance() { return shared_.get(); }

    void SetUp() override {
        if (instance() == nullptr) GTEST_SKIP() << "skipped: no Vulkan instance";
        for (const DeviceInfo& device : instance()->listDevices()) {
            if (device.suitable) {
                devices_.push_back(device);
            } else {
                std::printf("skipped: %s\n", device.missing.c_str());
            }
        }
        if (devices_.empty()) GTEST_SKIP() << "skipped: no Vulkan device";
        instance()->messages().clear();
    }
    void TearDown() override {
        if (instance() == nullptr) return;
        EXPECT_EQ(instance()->messages().count(), 0u);
        instance()->messages().clear();
    }

    std::vector<DeviceInfo> devices_;
    static std::unique_ptr<VulkanInstance> shared_;
};
std::unique_ptr<VulkanInstance> PipelinesTest::shared_;

std::vector<std::uint32_t> sizesOf(const DeviceInfo& info) {
    std::vector<std::uint32_t> sizes;
    for (std::uint32_t size = std::max(info.minSubgroupSize, 4u);
         size <= std::min(info.maxSubgroupSize, gpu::kWorkGroupSize); size *= 2) {
        sizes.push_back(size);
    }
    return sizes;
}

// Filters, with the PCF radius where it matters.
std::vector<ShadowSettings> filtersOf() {
    std::vector<ShadowSettings> out;
    ShadowSettings settings;
    for (const FilterSet filters : {only(Filter::Hard), FilterSet{0}, only(Filter::PcssShared), kAllBuiltInFilters}) {
        settings.filters = filters;
        out.push_back(settings);
    }
    settings.filters = only(Filter::Pcf);
    for (settings.pcfRadius = 1; settings.pcfRadius <= gpu::kMaxPcfRadius; ++settings.pcfRadius)
        out.push_back(settings);
    return out;
}

// Filters and reservations crossed, and lists with reservations; the host's pyramid, which one pass alone looks at,
// once.
std::vector<ShadowSettings> variantsOf() {
    std::vector<ShadowSettings> out;
    for (ShadowSettings settings : filtersOf()) {
        for (const ListReservation way :
             {ListReservation::Approximate, ListReservation::Accurate, ListReservation::Fixed}) {
            settings.listReservation = way;
            settings.fixedListEntriesPerTile = way == ListReservation::Fixed ? 16 : 0;
            out.push_back(settings);
        }
    }
    for (const ListReservation way :
         {ListReservation::Approximate, ListReservation::Accurate, ListReservation::Fixed}) {
        ShadowSettings& settings = out.emplace_back();
        settings.lightLists = LightLists::Pixel;
        settings.listReservation = way;
        settings.fixedListEntriesPerTile = 16;
    }
    out.emplace_back().hostDepthPyramid = true;
    return out;
}

TEST_F(PipelinesTest, EveryVariantOfTheLibrary) {
    for (const DeviceInfo& info : devices_) {
        const Device device(*instance(), info);
        for (const std::uint32_t size : sizesOf(info)) {
            ContextDesc desc = contextDescOf(device);
            desc.subgroupSize = size;
            std::unique_ptr<Context> context;
            const Result created = Context::create(desc, context);
            ASSERT_TRUE(created) << info.name << ", " << size << " lanes: " << created.message();
            EXPECT_EQ(context->subgroupSize(), size);
            for (const ShadowSettings& settings : variantsOf()) {
                const Result result = context->prepare(settings);
                ASSERT_TRUE(result) << info.name << ", " << size << " lanes: " << result.message();
            }
            std::printf("%s (%s), %u lanes: %zu settings, %u pipelines\n", info.name.c_str(), info.driver.c_str(), size,
                        variantsOf().size(), context->pipelineCount());
        }
    }
}

TEST_F(PipelinesTest, LightingOfTheRenderer) {
    using enum LightingKind;
    const bool quick = std::getenv("GNOMON_QUICK") != nullptr;
    for (const DeviceInfo& info : devices_) {
        const Device device(*instance(), info);
        for (const std::uint32_t size : sizesOf(info)) {
            ContextDesc desc = contextDescOf(device);
            desc.subgroupSize = size;
            std::unique_ptr<Context> context;
            const Result result = Context::create(desc, context);
            ASSERT_TRUE(result) << info.name << ": " << result.message();
            LightingPipelines pipelines(device, *context);
            for (const ShadowSettings& settings : filtersOf()) {
                // One radius is unrolled as another is: in a quick run the widest must do.
                const bool widest = settings.pcfRadius == gpu::kMaxPcfRadius;
                if (quick && settings.filters == only(Filter::Pcf) && !widest) continue;
                if (quick && settings.filters == only(Filter::PcssShared)) continue;  // the next one has its code
                // Pictures of floats differ in what the last line writes: the smallest pipelines must do.
                if (settings.filters == FilterSet{0}) {
                    for (const LightingKind kind : {Deferred, Evaluate, Inline})
                        EXPECT_NE(pipelines.get(kind, settings, {}, PictureFormat::Float), VK_NULL_HANDLE);
                    EXPECT_NE(pipelines.get(Deferred, settings, {}, PictureFormat::Float),
                              pipelines.get(Deferred, settings));
                }
                for (const LightingKind kind : {Deferred, Evaluate})
                    EXPECT_NE(pipelines.get(kind, settings), VK_NULL_HANDLE);
                for (const bool on : {false, true})
                    for (const LightingKind kind : {Inline, Unshadowed}) {
                        if (quick && kind == Inline && on && settings.filters != kAllBuiltInFilters) continue;
                        EXPECT_NE(pipelines.get(kind, settings, {.quantises = on, .walksMasks = on}), VK_NULL_HANDLE);
                    }
            }
        }
    }
}

// Without a wish, the device's own size is taken, and two contexts live side by side.
TEST_F(PipelinesTest, TwoContextsOfTheDevicesOwnChoice) {
    for (const DeviceInfo& info : devices_) {
        const Device device(*instance(), info);
        ContextDesc desc = contextDescOf(device);
        std::unique_ptr<Context> first, second;
        ASSERT_TRUE(Context::create(desc, first));
        desc.pipelineCache = VK_NULL_HANDLE;
        ASSERT_TRUE(Context::create(desc, second));
        EXPECT_EQ(first->subgroupSize(), std::min(info.subgroupSize, gpu::kWorkGroupSize));
        EXPECT_NE(first->listsSetLayout(), second->listsSetLayout());
        first.reset();
        EXPECT_EQ(second->subgroupSize(), std::min(info.subgroupSize, gpu::kWorkGroupSize));
    }
}

TEST_F(PipelinesTest, WhatADeviceCannotDoIsRefused) {
    for (const DeviceInfo& info : devices_) {
        const Device device(*instance(), info);
        const std::vector<std::uint32_t> sizes = sizesOf(info);
        for (std::uint32_t size : {2u, 4u, 8u, 16u, 32u, 64u, 128u}) {
            if (std::ranges::find(sizes, size) != sizes.end()) continue;
            ContextDesc desc = contextDescOf(device);
            desc.subgroupSize = size;
            std::unique_ptr<Context> context;
            const Result result = Context::create(desc, context);
            EXPECT_EQ(result.status(), Status::UnsupportedDevice) << info.name << ", " << size;
            EXPECT_THAT(result.message(), HasSubstr(info.name));
            EXPECT_THAT(result.message(), HasSubstr(std::to_string(size) + " lanes"));
            EXPECT_EQ(context, nullptr);
        }
        ContextDesc desc = contextDescOf(device);
        desc.getInstanceProcAddr = nullptr;
        std::unique_ptr<Context> context;
        EXPECT_EQ(Context::create(desc, context).status(), Status::BadArgument);
    }
}

// Debug labels that the instance does not offer are refused, not crashed on.
TEST(PipelinesWithoutLabels, AreRefused) {
    std::unique_ptr<VulkanInstance> plain;
    try {
        plain = makeInstance({.debugLabels = false});
    } catch (const GpuError& error) {
        GTEST_SKIP() << "skipped: " << error.what();
    }
    for (const DeviceInfo& info : plain->listDevices()) {
        if (!info.suitable) continue;
        const Device device(*plain, info);
        ContextDesc desc = contextDescOf(device);
        std::unique_ptr<Context> context;
        EXPECT_TRUE(Context::create(desc, context)) << info.name;
        desc.debugLabels = true;
        const Result result = Context::create(desc, context);
        EXPECT_EQ(result.status(), Status::BadArgument) << info.name;
        EXPECT_THAT(result.message(), HasSubstr("VK_EXT_debug_utils"));
    }
}

// On RADV's null device alone: both widths of AMD hardware were there to be compiled for.
TEST_F(PipelinesTest, RadvCompilesBothWidths) {
    if (!onNullDevice()) GTEST_SKIP() << "skipped: only with RADV_FORCE_FAMILY";
    const auto radv = std::ranges::find_if(
        devices_, [](const DeviceInfo& info) { return info.name.find("RADV") != std::string::npos; });
    ASSERT_NE(radv, devices_.end());
    EXPECT_EQ(sizesOf(*radv), (std::vector<std::uint32_t>{32, 64}));
}

}  // namespace
}  // namespace gnomon::renderer
