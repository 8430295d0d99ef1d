#pragma once
// A device and a scene, ready for a Renderer.

#include "app/settings.h"
#include "renderer/renderer.h"

namespace gnomon::app {

/// Everything that can be wrong with the input is found here, before any long work. Throws UsageError or GpuError.
class Session {
public:
    /// The instance must outlive the session.
    Session(const renderer::VulkanInstance& instance, const Settings& settings);

    [[nodiscard]] const Settings& settings() const { return settings_; }
    [[nodiscard]] const renderer::RendererDesc& rendererDesc() const { return desc_; }
    [[nodiscard]] const renderer::Device& device() const { return device_; }
    [[nodiscard]] const renderer::Scene& scene() const { return scene_; }
    [[nodiscard]] const renderer::SceneCamera& camera() const { return camera_; }

private:
    Settings settings_;
    renderer::RendererDesc desc_;
    renderer::Device device_;
    renderer::Scene scene_;
    renderer::SceneCamera camera_;
};

/// Throws UsageError where the scene has no such light.
void checkLight(std::uint32_t light, const renderer::Scene& scene);

renderer::InstanceDesc instanceDescOf(const Settings& settings);

/// The exit code of work under validation: to be asked after everything on the device is gone.
int exitCodeOf(const renderer::VulkanInstance& instance, const Settings& settings);

}  // namespace gnomon::app
