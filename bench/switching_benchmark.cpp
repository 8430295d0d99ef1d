// What a change of settings costs in a running renderer: the first frame after it, when its pipelines do not exist yet
// (cold) and when they do (warm), beside an ordinary frame of the new settings.
//
// A frame counts from Renderer::set() until the device has finished it. The first row is what every change would cost
// if it made the renderer anew: the scene's upload, the views, the pipelines, one frame.
//
// switching_benchmark [SCENE [DEVICE]], a built-in scene; drivers may keep compiled pipelines on disk: the cold times
// hold for an empty cache (Mesa: MESA_SHADER_CACHE_DISABLE=true; NVIDIA: __GL_SHADER_DISK_CACHE=0).

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "renderer/renderer.h"
#include "scene/builtin/builtin.h"

namespace gnomon::renderer {
namespace {

struct Change {
    const char* name;
    std::function<void(FrameSettings&)> apply;
};

std::vector<Change> changes() {
    return {
        {"filter: pcf", [](FrameSettings& s) { s.filters = {Filter::Pcf}; }},
        {"filter: hard", [](FrameSettings& s) { s.filters = {Filter::Hard}; }},
        {"filter: all three",
         [](FrameSettings& s) {
             s.filters = {Filter::Hard, Filter::Pcf, Filter::Pcss};
         }},
        {"taps: 32+64", [](FrameSettings& s) { s.shadows.pcssPresets[0] = kPcssHigh; }},
        {"bias: 4 mm", [](FrameSettings& s) { s.biasMetres = 0.004f; }},
        {"bias mode: one depth", [](FrameSettings& s) { s.shadows.depthBias = DepthBias::OrientedConstant; }},
        {"slots of 4 bits", [](FrameSettings& s) { s.shadows.visibilityBits = 4; }},
        {"no shadow bounds", [](FrameSettings& s) { s.shadows.shadowBounds = false; }},
        {"lists: approximate", [](FrameSettings& s) { s.shadows.listReservation = ListReservation::Approximate; }},
        {"extent: smaller", [](FrameSettings& s) { s.widthPx = s.widthPx * 2 / 3, s.heightPx = s.heightPx * 2 / 3; }},
        {"extent: larger", [](FrameSettings& s) { s.widthPx = s.widthPx * 4 / 3, s.heightPx = s.heightPx * 4 / 3; }},
    };
}

double millisecondsOf(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

class Bench {
public:
    Bench(const Device& device, const std::string& name) {
        std::optional<Scene> scene = makeBuiltinScene(name);
        if (!scene) throw std::runtime_error(fmt::format("There is no built-in scene '{}'.", name));
        scene_ = std::move(*scene);
        completeLights(scene_);
        camera_ = defaultCamera(scene_);
        RendererDesc desc;
        desc.frame.widthPx = 1920;
        desc.frame.heightPx = 1080;
        anew_ = millisecondsOf([&] {
            renderer_ = std::make_unique<Renderer>(device, scene_, desc);
            frame();
        });
    }

    void print() {
        fmt::print(
            "| change | first frame, cold | first frame, warm | ordinary frame | pipelines made | views | resizes |\n");
        fmt::print("|---|--:|--:|--:|--:|--:|--:|\n");
        fmt::print("| (all anew) | {:.1f} ms | | {:.1f} ms | | | |\n", anew_, ordinary());
        for (const Change& change : changes()) printRow(change);
    }

private:
    void frame() {
        renderer_->renderFrame(camera_, ShadowMode::Deferred);
        renderer_->wait();
    }

    double first(const FrameSettings& settings) {
        return millisecondsOf([&] {
            renderer_->set(settings);
            frame();
        });
    }

    double ordinary() {
        std::vector<double> times;
        for (int i = 0; i < 9; ++i) times.push_back(millisecondsOf([&] { frame(); }));
        std::ranges::nth_element(times, times.begin() + 4);
        return times[4];
    }

    void printRow(const Change& change) {
        const FrameSettings before = renderer_->settings();
        FrameSettings after = before;
        change.apply(after);
        const RendererCounts had = renderer_->counts();
        const double cold = first(after);
        const RendererCounts has = renderer_->counts();
        const double usual = ordinary();
        first(before);
        ordinary();
        const double warm = first(after);
        first(before);
        ordinary();
        fmt::print("| {} | {:.1f} ms | {:.1f} ms | {:.1f} ms | {} | {} | {} |\n", change.name, cold, warm, usual,
                   has.libraryPipelines - had.libraryPipelines + has.lightingPipelines - had.lightingPipelines,
                   has.views - had.views, has.resizes - had.resizes);
    }

    Scene scene_;
    SceneCamera camera_;
    double anew_ = 0.0;
    std::unique_ptr<Renderer> renderer_;
};

}  // namespace
}  // namespace gnomon::renderer

int main(int argc, char** argv) {
    try {
        if (argc > 3)
            throw std::runtime_error("Give a scene and a device at most: switching_benchmark [SCENE [DEVICE]].");
        const gnomon::renderer::VulkanInstance instance({.debugLabels = false});
        const gnomon::renderer::Device device(instance, instance.chooseDevice(argc > 2 ? argv[2] : ""));
        fmt::print("{}, {}, 1920x1080\n\n", device.info().name, device.info().driver);
        gnomon::renderer::Bench(device, argc > 1 ? argv[1] : "courtyard-bench").print();
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "switching_benchmark: {}\n", error.what());
        return 1;
    }
}
