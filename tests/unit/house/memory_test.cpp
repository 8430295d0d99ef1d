// Making and resizing a view while memory runs out, at every single allocation. No device is needed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "unit/house/fake_vulkan.h"

namespace gnomon::house {
namespace {

using ::testing::HasSubstr;

ViewDesc descOf(std::uint32_t widthPx, std::uint32_t heightPx) {
    ViewDesc desc;
    desc.maxWidthPx = widthPx;
    desc.maxHeightPx = heightPx;
    return desc;
}

// A view on a device that has as much memory as the test allows.
struct Made {
    FakeVulkan vulkan;
    std::unique_ptr<Context> context;
    std::unique_ptr<View> view;

    Made() { EXPECT_TRUE(Context::create(vulkan.desc(), context)); }
    void makeView() { ASSERT_TRUE(View::create(*context, descOf(64, 64), view)); }
};

std::vector<VkBuffer> buffersOf(const View& view) {
    std::vector<VkBuffer> out;
    for (const BufferMemory& buffer : view.memory().buffers()) out.push_back(view.buffer(buffer.name));
    return out;
}

bool takesFrames(View& view, std::uint32_t widthPx, std::uint32_t heightPx) {
    ViewInput input;
    input.widthPx = widthPx;
    input.heightPx = heightPx;
    // A camera that looks along -z, one metre to the near plane, reversed Z without end.
    constexpr std::array<float, 16> kClip = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0};
    std::ranges::copy(kClip, input.camera.clipFromView);
    PreparedLights prepared;
    const Result result = view.prepare(input, prepared);
    if (!result) {
        EXPECT_THAT(result.message(), HasSubstr("above the view's maximum")) << widthPx << "x" << heightPx;
    }
    return result.ok();
}

TEST(Memory, ViewsThatCannotBeMadeLeaveNothing) {
    std::uint32_t begin = 0, end = 0;
    {
        Made all;
        begin = all.vulkan.made;
        all.makeView();
        end = all.vulkan.made;
    }
    ASSERT_GT(end, begin + 20);
    for (std::uint32_t count = begin; count < end; ++count) {
        Made m;
        m.vulkan.failAfter = count;
        const Result result = View::create(*m.context, descOf(64, 64), m.view);
        EXPECT_EQ(result.status(), Status::OutOfMemory) << result.message();
        EXPECT_THAT(result.message(), HasSubstr("ran out of memory"));
        EXPECT_EQ(m.view, nullptr);
        m.context.reset();
        EXPECT_EQ(m.vulkan.made, m.vulkan.destroyed) << count;
        EXPECT_TRUE(m.vulkan.memory.empty());
    }
}

// The view goes on as it was, at the extent that it had; and grows when there is memory again.
TEST(Memory, AResizeThatFailsChangesNothing) {
    ViewDesc larger = descOf(200, 120);
    larger.maxShadowViews = 2000;
    larger.shadowBoundsTexels *= 2;
    std::uint32_t begin = 0, end = 0;
    {
        Made all;
        all.makeView();
        begin = all.vulkan.made;
        ASSERT_TRUE(all.view->resize(larger));
        end = all.vulkan.made;
    }
    ASSERT_GT(end, begin + 20);
    for (std::uint32_t count = begin; count < end; ++count) {
        SCOPED_TRACE(count);
        Made m;
        m.makeView();
        const std::vector<VkBuffer> buffers = buffersOf(*m.view);
        const std::uint64_t bytes = m.view->memory().totalBytes;
        const std::size_t allocations = m.vulkan.memory.size();
        m.vulkan.failAfter = count;
        const Result result = m.view->resize(larger);
        EXPECT_EQ(result.status(), Status::OutOfMemory) << result.message();
        EXPECT_EQ(buffersOf(*m.view), buffers);
        EXPECT_EQ(m.view->memory().totalBytes, bytes);
        EXPECT_EQ(m.vulkan.memory.size(), allocations);
        EXPECT_TRUE(takesFrames(*m.view, 64, 64));
        EXPECT_FALSE(takesFrames(*m.view, 200, 120));
        m.vulkan.failAfter = ~0u;
        EXPECT_TRUE(m.view->resize(larger));
        EXPECT_TRUE(takesFrames(*m.view, 200, 120));
        m.view.reset();
        m.context.reset();
        EXPECT_EQ(m.vulkan.made, m.vulkan.destroyed);
    }
}

}  // namespace
}  // namespace gnomon::house
