#pragma once
// Every Vulkan device of the machine, with validation where its layer is installed, and the contexts that tests share.

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gnomon/gnomon.h"
#include "renderer/gpu/device.h"

namespace gnomon::test {

/// What a Context is made with; tests that agree on all of it share one.
struct ContextSetup {
    std::uint32_t maxShadowAtlases = 4;
    std::uint32_t subgroupSize = 0;
    bool hostProvider = false;  ///< phase 4 with host_provider/gnomon_host_provider.glsl
};

/// A logical device and its contexts, alive until the program ends.
class TestDevice {
public:
    TestDevice(const renderer::VulkanInstance& instance, const renderer::DeviceInfo& info);
    [[nodiscard]] const renderer::Device& vulkan() const { return *device_; }
    /// Fails the test and returns null where the context cannot be made.
    const Context* context(const ContextSetup& setup);
    /// A description that works, to be spoilt by tests of misuse.
    [[nodiscard]] ContextDesc contextDesc(const ContextSetup& setup) const;

private:
    std::unique_ptr<renderer::Device> device_;  // outlives the contexts
    std::map<std::string, std::unique_ptr<Context>> contexts_;
};

[[nodiscard]] renderer::VulkanInstance& testInstance();
/// Indices of all suitable devices.
[[nodiscard]] std::vector<std::size_t> deviceIndices();
[[nodiscard]] std::string deviceName(const ::testing::TestParamInfo<std::size_t>& info);
/// Longer runs were asked for, by the environment: GNOMON_FULL=1.
[[nodiscard]] bool fullRun();

/// One test on one device. Any validation message fails it.
class GpuTest : public ::testing::TestWithParam<std::size_t> {
protected:
    void SetUp() override;
    void TearDown() override;
    [[nodiscard]] static TestDevice& device();
};

#define GNOMON_ON_EVERY_DEVICE(suite)                                                              \
    INSTANTIATE_TEST_SUITE_P(Devices, suite, ::testing::ValuesIn(::gnomon::test::deviceIndices()), \
                             ::gnomon::test::deviceName)

}  // namespace gnomon::test
