#include "image/renderer/harness.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "renderer/gpu/error.h"
#include "scene/scatter/scatter_lights.h"

namespace gnomon::renderer::image_test {
namespace {

// Instance and devices live from the first question to the end of all tests.
class Devices : public ::testing::Environment {
public:
    static Devices& get() {
        static Devices* shared = static_cast<Devices*>(::testing::AddGlobalTestEnvironment(new Devices));
        return *shared;
    }

    [[nodiscard]] const std::vector<DeviceInfo>& infos() const { return infos_; }
    [[nodiscard]] MessageLog& messages() const { return instance_->messages(); }

    const Device& device(std::size_t index) {
        if (!devices_[index]) devices_[index] = std::make_unique<Device>(*instance_, infos_[index]);
        return *devices_[index];
    }

    const std::shared_ptr<SharedPipelines>& pipelinesOf(const Device& device, std::uint32_t subgroupSize) {
        std::shared_ptr<SharedPipelines>& pipelines = pipelines_[{&device, subgroupSize}];
        if (pipelines == nullptr) pipelines = std::make_shared<SharedPipelines>(device, subgroupSize);
        return pipelines;
    }

    void TearDown() override {
        pipelines_.clear();
        devices_.clear();
        EXPECT_EQ(instance_->messages().count(), 0u) << "while devices were destroyed";
        // The instance stays: with it the drivers would be unloaded, and the leak checker could not tell whose memory
        // is left (scripts/lsan.supp).
        static VulkanInstance* kept = nullptr;
        kept = instance_.release();
        EXPECT_NE(kept, nullptr);
    }

private:
    Devices() {
        try {
            instance_ = std::make_unique<VulkanInstance>(InstanceDesc{.validation = true});
        } catch (const GpuError& e) {
            std::printf("skipped: validation (%s)\n", e.what());
            instance_ = std::make_unique<VulkanInstance>();
        }
        for (const DeviceInfo& info : instance_->listDevices()) {
            if (info.suitable)
                infos_.push_back(info);
            else
                std::printf("skipped: %s: %s\n", info.name.c_str(), info.missing.c_str());
        }
        devices_.resize(infos_.size());
    }

    std::unique_ptr<VulkanInstance> instance_;
    std::vector<DeviceInfo> infos_;
    std::vector<std::unique_ptr<Device>> devices_;
    std::map<std::pair<const Device*, std::uint32_t>, std::shared_ptr<SharedPipelines>> pipelines_;
};

std::string plainName(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (std::isalnum(static_cast<unsigned char>(c)))
            out += c;
        else if (!out.empty() && out.back() != '_')
            out += '_';
    }
    while (!out.empty() && out.back() == '_') out.pop_back();
    return out;
}

bool isSet(const char* variable) {
    const char* value = std::getenv(variable);
    return value != nullptr && *value != '\0' && *value != '0';
}

TEST(Devices, AtLeastOneIsThere) {
    EXPECT_FALSE(Devices::get().infos().empty()) << "no image test has run";
}

}  // namespace

bool fullRun() {
    return isSet("GNOMON_FULL");
}

bool thorough() {
    return fullRun() || !isSet("GNOMON_QUICK");
}

std::shared_ptr<SharedPipelines> pipelinesOf(const Device& device, std::uint32_t subgroupSize) {
    return Devices::get().pipelinesOf(device, subgroupSize);
}

const Device& ImageTest::device() const {
    return Devices::get().device(GetParam());
}

void ImageTest::TearDown() {
    EXPECT_EQ(Devices::get().messages().count(), 0u) << "validation messages";
    Devices::get().messages().clear();
}

std::vector<std::size_t> deviceIndices() {
    std::vector<std::size_t> indices(Devices::get().infos().size());
    for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = i;
    return indices;
}

std::string deviceTestName(const ::testing::TestParamInfo<std::size_t>& info) {
    return std::to_string(info.param) + "_" + plainName(Devices::get().infos()[info.param].name);
}

View3d builtin(const std::string& name, std::uint32_t scattered) {
    View3d view;
    view.name = scattered == 0 ? name : name + "+" + std::to_string(scattered);
    view.scene = makeBuiltinScene(name).value();
    scatterLights(view.scene, scattered, 1);
    completeLights(view.scene);
    view.camera = defaultCamera(view.scene);
    return view;
}

View3d orthographic(View3d view, float focusMetres) {
    view.name += " orthographic";
    view.camera.orthographic = true;
    view.camera.orthographicHalfHeight = focusMetres * std::tan(0.5f * view.camera.verticalFieldOfView);
    return view;
}

RendererDesc smallDesc(std::uint32_t widthPx, std::uint32_t heightPx) {
    RendererDesc desc;
    desc.frame.widthPx = widthPx;
    desc.frame.heightPx = heightPx;
    desc.atlasSizePx = thorough() ? 2048 : 1024;
    desc.frame.shadows.pcssPresets[0] = kFewTaps;
    return desc;
}

Frame draw(Renderer& renderer, const SceneCamera& camera, ShadowMode mode) {
    const std::uint64_t number = renderer.renderFrame(camera, mode);
    renderer.wait();
    Frame frame{renderer.readPicture(), renderer.report(number)};
    EXPECT_EQ(frame.report.statistics.accurateExceedsApproximate, 0u);
    EXPECT_TRUE(std::ranges::all_of(frame.linear.rgba, [](float v) { return std::isfinite(v) && v >= 0.0f; }));
    return frame;
}

Frame drawOnce(const Device& device, const View3d& view, const RendererDesc& desc, ShadowMode mode) {
    Renderer renderer(device, view.scene, desc, pipelinesOf(device, desc.subgroupSize));
    return draw(renderer, view.camera, mode);
}

void Worst::add(const Difference& difference, const std::string& name) {
    ++comparisons;
    pixels += difference.pixels;
    if (difference.largest > largest) {
        largest = difference.largest;
        where = name;
    }
}

void Worst::report(const Device& device, const std::string& key) const {
    std::printf("[ figure   ] %s: %s: largest difference %u/255 over %llu comparisons, %llu pixels differ%s%s\n",
                device.info().name.c_str(), key.c_str(), largest, static_cast<unsigned long long>(comparisons),
                static_cast<unsigned long long>(pixels), where.empty() ? "" : "; worst: ", where.c_str());
    ::testing::Test::RecordProperty(plainName(key) + "_largest", std::to_string(largest));
    ::testing::Test::RecordProperty(plainName(key) + "_pixels", std::to_string(pixels));
}

void writeFailure(const Device& device, const std::string& name, const Picture& expected, const Picture& actual) {
    const std::filesystem::path folder = std::filesystem::path(GNOMON_BINARY_DIR) / "image_failures";
    std::filesystem::create_directories(folder);
    const std::string stem = plainName(device.info().name) + "-" + plainName(name);
    writePng(expected, folder / (stem + "-expected.png"));
    writePng(actual, folder / (stem + "-actual.png"));
    const std::filesystem::path difference = folder / (stem + "-difference.png");
    writePng(differencePicture(expected, actual), difference);
    std::printf("[ picture  ] %s\n", difference.c_str());
}

Difference expectEqual(const Device& device, const std::string& name, const Picture& expected, const Picture& actual,
                       std::uint32_t tolerance) {
    const Difference difference = compare(expected, actual);
    EXPECT_LE(difference.largest, tolerance) << name << ": " << difference.pixels << " pixels differ";
    if (difference.largest > tolerance) writeFailure(device, name, expected, actual);
    return difference;
}

Difference expectEqual(const Device& device, const std::string& name, const HdrPicture& expected,
                       const HdrPicture& actual, std::uint32_t tolerance) {
    const float exposure = automaticExposure(expected);
    return expectEqual(device, name, toneMap(expected, exposure), toneMap(actual, exposure), tolerance);
}

Frame expectDeferredIsInline(const Device& device, const std::string& name, const View3d& view,
                             const RendererDesc& desc, Worst& worst, bool shadows) {
    Renderer renderer(device, view.scene, desc, pipelinesOf(device, desc.subgroupSize));
    return expectDeferredIsInline(device, name, renderer, view.camera, worst, shadows);
}

Frame expectDeferredIsInline(const Device& device, const std::string& name, Renderer& renderer,
                             const SceneCamera& camera, Worst& worst, bool shadows) {
    SCOPED_TRACE(name);
    const Frame inlined = draw(renderer, camera, ShadowMode::Inline);
    Frame deferred = draw(renderer, camera, ShadowMode::Deferred);
    worst.add(expectEqual(device, name, inlined.linear, deferred.linear, 1), name);
    if (shadows) {
        const Frame off = draw(renderer, camera, ShadowMode::Off);
        const float exposure = automaticExposure(off.linear);
        const Difference seen = compare(toneMap(off.linear, exposure), toneMap(deferred.linear, exposure));
        EXPECT_GT(seen.largest, 8u) << "no shadow is to be seen";
    }
    return deferred;
}

}  // namespace gnomon::renderer::image_test
