// How Context::create() refuses a device or a description: with a status and a sentence that says what to do, and with
// everything destroyed that it had made. No device is needed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/house/fake_vulkan.h"

namespace gnomon::house {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

void expectRefused(const FakeVulkan& vulkan, const ContextDesc& desc, Status status, const char* part) {
    std::unique_ptr<Context> context;
    const Result result = Context::create(desc, context);
    EXPECT_EQ(result.status(), status) << result.message();
    EXPECT_THAT(result.message(), HasSubstr(part));
    EXPECT_THAT(result.message(), MatchesRegex("^.+\\.$")) << "not a sentence";
    EXPECT_EQ(context, nullptr);
    EXPECT_EQ(vulkan.made, vulkan.destroyed);
    EXPECT_EQ(vulkan.callsWithoutDevice, 0u);
}

TEST(Refusal, TheFakeIsAccepted) {
    FakeVulkan vulkan;
    std::unique_ptr<Context> context;
    const Result result = Context::create(vulkan.desc(), context);
    ASSERT_TRUE(result) << result.message();
    EXPECT_EQ(context->subgroupSize(), 32u);
    EXPECT_EQ(context->pipelineCount(), 0u);
    EXPECT_GT(vulkan.made, vulkan.destroyed);
    context.reset();
    EXPECT_EQ(vulkan.made, vulkan.destroyed);
}

TEST(Refusal, MissingHandles) {
    FakeVulkan vulkan;
    for (int i = 0; i < 3; ++i) {
        ContextDesc desc = vulkan.desc();
        if (i == 0) desc.instance = VK_NULL_HANDLE;
        if (i == 1) desc.physicalDevice = VK_NULL_HANDLE;
        if (i == 2) desc.device = VK_NULL_HANDLE;
        expectRefused(vulkan, desc, Status::BadArgument, "needs an instance, a physical device and a device");
    }
    ContextDesc desc = vulkan.desc();
    desc.getInstanceProcAddr = nullptr;
    expectRefused(vulkan, desc, Status::BadArgument, "getInstanceProcAddr is null");
}

TEST(Refusal, BadDescriptions) {
    FakeVulkan vulkan;
    ContextDesc desc = vulkan.desc();
    desc.queueFamilies = {};
    expectRefused(vulkan, desc, Status::BadArgument, "queueFamilies");
    const std::uint32_t many[9] = {};
    desc.queueFamilies = many;
    expectRefused(vulkan, desc, Status::BadArgument, "queueFamilies");
    for (std::uint32_t atlases : {0u, 5u, ~0u}) {
        desc = vulkan.desc();
        desc.maxShadowAtlases = atlases;
        expectRefused(vulkan, desc, Status::BadArgument, "maxShadowAtlases");
    }
}

TEST(Refusal, MissingFunctions) {
    for (const char* name : {"vkGetPhysicalDeviceProperties2", "vkGetDeviceProcAddr", "vkDestroySampler"}) {
        FakeVulkan vulkan;
        vulkan.hidden = {name};
        expectRefused(vulkan, vulkan.desc(), Status::UnsupportedDevice, name);
    }
    // What a device without Vulkan 1.3, or without synchronization2, does not have.
    for (const char* name : {"vkCmdPipelineBarrier2", "vkCmdWriteTimestamp2"}) {
        FakeVulkan vulkan;
        vulkan.hidden = {name};
        expectRefused(vulkan, vulkan.desc(), Status::UnsupportedDevice, name);
        expectRefused(vulkan, vulkan.desc(), Status::UnsupportedDevice, "synchronization2");
    }
    FakeVulkan vulkan;
    vulkan.hidden = {"vkCmdBeginDebugUtilsLabelEXT"};
    ContextDesc desc = vulkan.desc();
    std::unique_ptr<Context> context;
    EXPECT_TRUE(Context::create(desc, context));
    context.reset();
    desc.debugLabels = true;
    expectRefused(vulkan, desc, Status::BadArgument, "VK_EXT_debug_utils");
}

TEST(Refusal, OldVulkan) {
    FakeVulkan vulkan;
    vulkan.properties.apiVersion = VK_API_VERSION_1_2;
    expectRefused(vulkan, vulkan.desc(), Status::UnsupportedDevice, "needs Vulkan 1.3; 'Fake device' has 1.2");
}

TEST(Refusal, MissingSubgroupOperations) {
    for (VkSubgroupFeatureFlagBits bit : {VK_SUBGROUP_FEATURE_BASIC_BIT, VK_SUBGROUP_FEATURE_ARITHMETIC_BIT}) {
        FakeVulkan vulkan;
        vulkan.subgroupOperations &= ~static_cast<VkSubgroupFeatureFlags>(bit);
        expectRefused(vulkan, vulkan.desc(), Status::UnsupportedDevice, "subgroup operations");
    }
    FakeVulkan vulkan;
    vulkan.subgroupStages = VK_SHADER_STAGE_FRAGMENT_BIT;
    expectRefused(vulkan, vulkan.desc(), Status::UnsupportedDevice, "compute");
}

TEST(Refusal, TooFewStorageBuffers) {
    FakeVulkan vulkan;
    vulkan.storageBuffersPerStage = 20;
    expectRefused(vulkan, vulkan.desc(), Status::UnsupportedDevice, "storage buffers");
    vulkan.storageBuffersPerStage = 21;
    std::unique_ptr<Context> context;
    EXPECT_TRUE(Context::create(vulkan.desc(), context));
}

TEST(Refusal, SubgroupSizes) {
    FakeVulkan vulkan;
    for (std::uint32_t size : {1u, 2u, 3u, 8u, 16u, 48u, 128u, ~0u}) {
        ContextDesc desc = vulkan.desc();
        desc.subgroupSize = size;
        expectRefused(vulkan, desc, Status::UnsupportedDevice, "has 32 to 64");
    }
    // A device that cannot be asked runs its own size alone.
    vulkan.requiredSubgroupSizeStages = 0;
    ContextDesc desc = vulkan.desc();
    desc.subgroupSize = 64;
    expectRefused(vulkan, desc, Status::UnsupportedDevice, "64 lanes");
}

// Wider than a work group: nothing fits, unless the device can be asked for less.
TEST(Refusal, WideSubgroups) {
    FakeVulkan vulkan;
    vulkan.subgroupSize = vulkan.minSubgroupSize = vulkan.maxSubgroupSize = 128;
    expectRefused(vulkan, vulkan.desc(), Status::UnsupportedDevice, "128");
}

// Whichever call runs out of memory, what was made before is given back.
TEST(Refusal, OutOfMemoryLeaksNothing) {
    std::uint32_t whole = 0;
    {
        FakeVulkan vulkan;
        std::unique_ptr<Context> context;
        ASSERT_TRUE(Context::create(vulkan.desc(), context));
        whole = vulkan.made;
    }
    EXPECT_GT(whole, 0u);
    for (std::uint32_t count = 0; count < whole; ++count) {
        FakeVulkan vulkan;
        vulkan.failAfter = count;
        expectRefused(vulkan, vulkan.desc(), Status::OutOfMemory, "ran out of memory");
    }
}

// Likewise while pipelines are made; those that were are kept, and the rest follow when there is memory again.
TEST(Refusal, OutOfMemoryWhilePreparing) {
    std::uint32_t begin = 0, end = 0;
    {
        FakeVulkan vulkan;
        std::unique_ptr<Context> context;
        ASSERT_TRUE(Context::create(vulkan.desc(), context));
        begin = vulkan.made;
        ASSERT_TRUE(context->prepare({}));
        end = vulkan.made;
        EXPECT_EQ(context->pipelineCount(), 8u);
    }
    ASSERT_EQ(end, begin + 16);  // a module and a pipeline each
    for (std::uint32_t count = begin; count < end; ++count) {
        FakeVulkan vulkan;
        std::unique_ptr<Context> context;
        ASSERT_TRUE(Context::create(vulkan.desc(), context));
        vulkan.failAfter = count;
        const Result result = context->prepare({});
        EXPECT_EQ(result.status(), Status::OutOfMemory);
        EXPECT_THAT(result.message(), HasSubstr("ran out of memory"));
        EXPECT_EQ(context->pipelineCount(), (count - begin) / 2);
        vulkan.failAfter = ~0u;
        EXPECT_TRUE(context->prepare({}));
        EXPECT_EQ(context->pipelineCount(), 8u);
        context.reset();
        EXPECT_EQ(vulkan.made, vulkan.destroyed);
    }
}

TEST(Refusal, Timelines) {
    FakeVulkan vulkan;
    std::unique_ptr<Context> context;
    ASSERT_TRUE(Context::create(vulkan.desc(), context));
    const std::uint32_t before = vulkan.made;
    std::unique_ptr<Timeline> timeline;
    for (const std::uint32_t frames : {0u, 5u, ~0u}) {
        const Result result = Timeline::create(*context, {.framesInFlight = frames}, timeline);
        EXPECT_EQ(result.status(), Status::BadArgument);
        EXPECT_THAT(result.message(), MatchesRegex("^TimelineDesc::framesInFlight is .+ 1 to 4\\.$"));
    }
    for (const std::uint32_t rows : {0u, 1025u, ~0u}) {
        const Result result = Timeline::create(*context, {.maxRows = rows}, timeline);
        EXPECT_EQ(result.status(), Status::BadArgument);
        EXPECT_THAT(result.message(), MatchesRegex("^TimelineDesc::maxRows is .+ 1 to 1024\\.$"));
    }
    EXPECT_EQ(timeline, nullptr);
    EXPECT_EQ(vulkan.made, before);
    for (const std::uint32_t frames : {1u, 4u}) {
        ASSERT_TRUE(Timeline::create(*context, {.framesInFlight = frames, .maxRows = 1024}, timeline));
        EXPECT_TRUE(timeline->records());
    }
    timeline.reset();
    vulkan.failAfter = vulkan.made;
    EXPECT_EQ(Timeline::create(*context, {}, timeline).status(), Status::OutOfMemory);
    EXPECT_EQ(timeline, nullptr);
    context.reset();
    EXPECT_EQ(vulkan.made, vulkan.destroyed);
}

// A queue without timestamps: a timeline that records nothing, and calls nothing.
TEST(Refusal, TimelinesWithoutTimestampsAreSilent) {
    FakeVulkan vulkan;
    vulkan.timestampBits = 0;
    std::unique_ptr<Context> context;
    ASSERT_TRUE(Context::create(vulkan.desc(), context));
    std::unique_ptr<Timeline> timeline;
    ASSERT_TRUE(Timeline::create(*context, {}, timeline));
    EXPECT_FALSE(timeline->records());
    timeline->beginFrame(VK_NULL_HANDLE, 1);
    const Timeline::Row row = timeline->begin(VK_NULL_HANDLE, "row", Phase::Host, RowKind::Compute);
    EXPECT_EQ(row, Timeline::kNone);
    timeline->end(VK_NULL_HANDLE, row);
    EXPECT_TRUE(timeline->rows(1).empty());
    EXPECT_EQ(timeline->lostRows(1), 0u);
}

}  // namespace
}  // namespace gnomon::house
