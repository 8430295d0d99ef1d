#include "app/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/errors.h"
#include "app/option_checks.h"
#include "app/progress.h"
#include "scene/builtin/builtin.h"
#include "scene/load_gltf.h"
#include "scene/play_animation.h"
#include "scene/pose.h"
#include "scene/scatter/scatter_lights.h"

namespace gnomon::app {
namespace {

using renderer::Scene;

constexpr std::size_t kMostNotes = 10;
constexpr std::uintmax_t kLongLoadBytes = 8u << 20;  // below, a file is loaded before anybody wonders

renderer::DeviceInfo chooseDevice(const renderer::VulkanInstance& instance, const Settings& settings) {
    if (settings.device.empty()) return instance.chooseDevice();
    try {
        return instance.chooseDevice(settings.device);
    } catch (const renderer::GpuError& error) {
        throw UsageError(error.what());
    }
}

const renderer::DeviceInfo& fitting(const renderer::DeviceInfo& info, const renderer::RendererDesc& desc) {
    const VkPhysicalDeviceLimits& limits = info.properties.limits;
    const std::uint32_t most =
        std::min({limits.maxImageDimension2D, limits.maxFramebufferWidth, limits.maxFramebufferHeight});
    if (std::max({desc.frame.widthPx, desc.frame.heightPx, desc.atlasSizePx}) > most)
        throw UsageError(fmt::format("'{}' draws pictures of at most {} pixels across.", info.name, most));
    if (desc.subgroupSize != 0 &&
        (desc.subgroupSize < info.minSubgroupSize || desc.subgroupSize > info.maxSubgroupSize))
        throw UsageError(fmt::format("'{}' has subgroups of {} to {} lanes, not {}.", info.name, info.minSubgroupSize,
                                     info.maxSubgroupSize, desc.subgroupSize));
    return info;
}

Scene loadFile(const std::string& name) {
    const std::filesystem::path path(name);
    std::error_code error;
    if (const auto bytes = std::filesystem::file_size(path, error); !error && bytes > kLongLoadBytes)
        sayProgress(fmt::format("Loading {}, {:.0f} MiB.", name, static_cast<double>(bytes) / (1u << 20)));
    Scene scene;
    const Result loaded = renderer::loadGltf(path, scene);
    if (loaded.status() == Status::OutOfMemory) throw std::runtime_error(loaded.message());
    if (!loaded.ok()) throw UsageError(loaded.message());
    return scene;
}

renderer::SceneCamera cameraOf(const Settings& settings, const Scene& scene) {
    renderer::SceneCamera camera;
    const Result parsed = renderer::parseCamera(settings.camera, scene, camera);
    if (!parsed.ok()) throw UsageError(parsed.message());
    return camera;
}

// The others stay, so that numbers and statistics name the same lights, but give no light.
void turnOffOthers(Scene& scene, const std::vector<std::uint32_t>& only) {
    if (only.empty()) return;
    for (const std::uint32_t light : only) checkLight(light, scene);
    for (std::uint32_t i = 0; i < scene.lights.size(); ++i)
        if (std::ranges::find(only, i) == only.end()) {
            scene.lights[i].intensity = 0.0f;
            scene.lights[i].casts = false;  // nor is a shadowmap drawn for it
        }
}

Scene loadScene(const Settings& settings, const renderer::RendererDesc& desc) {
    renderer::BuiltinOptions options;
    options.seed = settings.seed;
    options.lightCount = settings.lights;
    Scene scene;
    const std::string extension = extensionOf(settings.scene);
    if (std::optional<Scene> builtin = renderer::makeBuiltinScene(settings.scene, options))
        scene = std::move(*builtin);
    else if (extension == ".gltf" || extension == ".glb")
        scene = loadFile(settings.scene);
    else
        throw UsageError(
            fmt::format("There is no scene '{}': give a name that 'gnomon scenes' lists, or a .gltf or .glb file.",
                        settings.scene));
    if (const Result played = renderer::playAnimation(scene, settings.animation); !played.ok())
        throw UsageError(played.message());
    renderer::TileDensity density;
    if (settings.lightDensity > 0.0f) {
        if (settings.lights == 0) throw UsageError("--light-density needs at least one light: give --lights.");
        density = {settings.lightDensity, cameraOf(settings, scene), desc.frame.widthPx, desc.frame.heightPx};
        renderer::scatterLights(scene, settings.lights, settings.seed, &density);
    } else if (settings.lights != 0 && settings.scene != "columns") {
        // The columns have places of their own for their lights.
        renderer::scatterLights(scene, settings.lights, settings.seed);
    }
    // Scenes of our own have the lights that they are meant to have.
    if (!extension.empty()) renderer::lightIfDark(scene);
    for (renderer::SceneLight& light : scene.lights)
        if (light.kind != renderer::LightKind::Directional && !(light.sourceRadius > 0.0f))
            light.sourceRadius = settings.sourceRadius;
    renderer::completeLights(scene);
    turnOffOthers(scene, settings.onlyLights);
    if (settings.ambient == "off") scene.skyColour = scene.groundColour = glm::vec3(0.0f);
    return scene;
}

bool tooFar(const glm::vec3& p) {
    return !(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= renderer::kFarthestMetres);
}

void checkReachable(const Scene& scene, const renderer::SceneCamera& camera) {
    if (tooFar(glm::vec3(camera.worldFromCamera[3])))
        throw UsageError(
            fmt::format("The camera is farther than {:g} m from the scene's origin.", renderer::kFarthestMetres));
    for (const renderer::SceneLight& light : scene.lights) {
        const glm::vec3 candela = light.colour * light.intensity;
        const bool finite = std::isfinite(candela.x) && std::isfinite(candela.y) && std::isfinite(candela.z) &&
                            std::isfinite(light.rangeMetres);
        if (!finite) throw UsageError(fmt::format("The light '{}' is too bright to be computed.", light.name));
        if (light.kind != renderer::LightKind::Directional && tooFar(light.position))
            throw UsageError(fmt::format("The light '{}' is farther than {:g} m from the scene's origin.", light.name,
                                         renderer::kFarthestMetres));
    }
}

}  // namespace

void checkLight(std::uint32_t light, const renderer::Scene& scene) {
    if (light >= scene.lights.size())
        throw UsageError(
            fmt::format("There is no light #{}: the scene has {}, counted from 0.", light, scene.lights.size()));
}

Session::Session(const renderer::VulkanInstance& instance, const Settings& settings)
    : settings_(settings),
      desc_(rendererDescOf(settings)),
      device_(instance, fitting(chooseDevice(instance, settings), desc_)),
      scene_(loadScene(settings, desc_)),
      camera_(cameraOf(settings, scene_)) {
    checkReachable(scene_, camera_);
    if (!camera_.note.empty()) scene_.notes.push_back(camera_.note);
    sayProgress(fmt::format("Scene {}: {} triangles, {} lights.", settings.scene, renderer::triangleCount(scene_),
                            scene_.lights.size()));
    for (std::size_t i = 0; i < std::min(scene_.notes.size(), kMostNotes); ++i) sayWarning(scene_.notes[i]);
    if (scene_.notes.size() > kMostNotes) sayWarning(fmt::format("{} more notes.", scene_.notes.size() - kMostNotes));
    sayProgress(fmt::format("Device {} ({}).", device_.info().name, device_.info().driver));
}

renderer::InstanceDesc instanceDescOf(const Settings& settings) {
    renderer::InstanceDesc desc;
    desc.validation = settings.validate;
    return desc;
}

int exitCodeOf(const renderer::VulkanInstance& instance, const Settings& settings) {
    const std::size_t count = instance.messages().count();
    if (!settings.validate) return kGood;
    sayProgress(fmt::format("Validation messages: {}.", count));
    return count == 0 ? kGood : kFailed;
}

}  // namespace gnomon::app
