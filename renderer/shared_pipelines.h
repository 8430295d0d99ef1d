#pragma once
// What compiles slowly, apart from the renderers that use it.

#include <cstdint>
#include <memory>

#include "gnomon/context.h"
#include "renderer/gpu/device.h"
#include "renderer/lighting/light_visibility.h"
#include "renderer/lighting/lighting_pipelines.h"

namespace gnomon::renderer {

/// For a context of the library on this device, which must outlive the description.
ContextDesc contextDescOf(const Device& device);

/// The library's context and the pipelines that shade. Renderers that share them make none twice. Not thread safe: one
/// thread at a time may use such renderers.
class SharedPipelines {
public:
    /// `subgroupSize`: 0, the device's own, or as Context wants it. The device must outlive this. Throws GpuError.
    explicit SharedPipelines(const Device& device, std::uint32_t subgroupSize = 0);

    [[nodiscard]] const Device& device() const { return device_; }
    [[nodiscard]] std::uint32_t wantedSubgroupSize() const { return wantedSubgroupSize_; }
    [[nodiscard]] Context& context() { return *context_; }
    [[nodiscard]] LightingPipelines& lighting() { return lighting_; }
    [[nodiscard]] LightVisibilityPipelines& lightVisibility() { return lightVisibility_; }

private:
    const Device& device_;
    std::uint32_t wantedSubgroupSize_;
    std::unique_ptr<Context> context_;
    LightingPipelines lighting_;
    LightVisibilityPipelines lightVisibility_;
};

}  // namespace gnomon::renderer
