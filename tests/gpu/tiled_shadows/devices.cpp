#include "devices.h"

#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "renderer/shared_pipelines.h"

#ifdef __SANITIZE_ADDRESS__
/// Lavapipe (Mesa 22.3) never frees the shaders that it compiles for a uniform's value; and the instance is kept to the
/// end (see Teardown), with what the validation layer holds for it.
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libvulkan_lvp\nleak:libLLVM\nleak:libVkLayer_khronos_validation\n";
}
#endif

namespace gnomon::test {
namespace {

constexpr std::uint32_t kHostProviderSpirv[] = {
#include "filter_pairs_host_provider.spv.h"
};

/// SwiftShader comes with Debian's chromium and is known to no loader by itself.
void addSoftwareDrivers() {
    const char* swiftShader = "/usr/lib/chromium/vk_swiftshader_icd.json";
    if (std::filesystem::exists(swiftShader)) setenv("VK_ADD_DRIVER_FILES", swiftShader, 0);
}

struct Session {
    std::optional<renderer::VulkanInstance> instance;
    std::vector<renderer::DeviceInfo> infos;
    std::vector<std::unique_ptr<TestDevice>> devices;  // made when first used
};

/// Frees devices before the program's exit, when drivers may have taken down their own statics. The instance stays: its
/// drivers would be unloaded with it, and what they never free would look like leaks of ours.
class Teardown : public ::testing::Environment {
public:
    explicit Teardown(Session& session) : session_(session) {}
    void TearDown() override {
        session_.devices.clear();
        EXPECT_EQ(session_.instance->messages().count(), 0u);  // nothing was left undestroyed
    }

private:
    Session& session_;
};

Session& session() {
    static Session& s = *new Session;
    if (s.instance) return s;
    ::testing::AddGlobalTestEnvironment(new Teardown(s));  // owned by GoogleTest
    addSoftwareDrivers();
    try {
        s.instance.emplace(renderer::InstanceDesc{.validation = true});
    } catch (const renderer::GpuError& error) {
        std::printf("without validation: %s\n", error.what());
        s.instance.emplace(renderer::InstanceDesc{.validation = false});
    }
    for (const renderer::DeviceInfo& info : s.instance->listDevices()) {
        if (info.suitable)
            s.infos.push_back(info);
        else
            std::printf("skipped: %s\n", info.missing.c_str());
    }
    s.devices.resize(s.infos.size());
    return s;
}

}  // namespace

renderer::VulkanInstance& testInstance() {
    return *session().instance;
}

bool fullRun() {
    const char* value = std::getenv("GNOMON_FULL");
    return value != nullptr && *value != '\0' && *value != '0';
}

std::vector<std::size_t> deviceIndices() {
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < session().infos.size(); ++i) indices.push_back(i);
    return indices;
}

std::string deviceName(const ::testing::TestParamInfo<std::size_t>& info) {
    std::string name;
    for (const char c : session().infos[info.param].name) {
        if (c == '(') break;
        if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
    }
    return name + std::to_string(info.param);
}

TestDevice::TestDevice(const renderer::VulkanInstance& instance, const renderer::DeviceInfo& info)
    : device_(std::make_unique<renderer::Device>(instance, info)) {
    std::printf("device: %s, %s, subgroups of %u (%u to %u)\n", info.name.c_str(), info.driver.c_str(),
                info.subgroupSize, info.minSubgroupSize, info.maxSubgroupSize);
}

ContextDesc TestDevice::contextDesc(const ContextSetup& setup) const {
    ContextDesc desc = renderer::contextDescOf(*device_);
    desc.subgroupSize = setup.subgroupSize;
    desc.maxShadowAtlases = setup.maxShadowAtlases;
    if (setup.hostProvider) desc.filterPairsSpirv = kHostProviderSpirv;
    return desc;
}

const Context* TestDevice::context(const ContextSetup& setup) {
    char key[48];
    std::snprintf(key, sizeof(key), "%u %u %d", setup.subgroupSize, setup.maxShadowAtlases, int(setup.hostProvider));
    std::unique_ptr<Context>& context = contexts_[key];
    if (context == nullptr) {
        const Result made = Context::create(contextDesc(setup), context);
        EXPECT_TRUE(made.ok()) << made.message();
    }
    return context.get();
}

TestDevice& GpuTest::device() {
    std::unique_ptr<TestDevice>& slot = session().devices[GetParam()];
    if (slot == nullptr) slot = std::make_unique<TestDevice>(testInstance(), session().infos[GetParam()]);
    return *slot;
}

void GpuTest::SetUp() {
    testInstance().messages().clear();
}

void GpuTest::TearDown() {
    for (const std::string& message : testInstance().messages().messages()) ADD_FAILURE() << message;
    testInstance().messages().clear();
}

TEST(Devices, AtLeastOneIsFound) {
    EXPECT_FALSE(deviceIndices().empty());
}

}  // namespace gnomon::test
