#include "renderer/shared_pipelines.h"

#include <span>

#include "renderer/gpu/error.h"

namespace gnomon::renderer {
namespace {

std::unique_ptr<Context> makeContext(const Device& device, std::uint32_t subgroupSize) {
    const std::uint32_t family = device.queueFamily();
    ContextDesc c;
    c.instance = device.instance().handle();
    c.physicalDevice = device.physical();
    c.device = device.handle();
    c.getInstanceProcAddr = vkGetInstanceProcAddr;
    c.pipelineCache = device.pipelineCache();
    c.queueFamilies = std::span(&family, 1);
    c.debugLabels = device.instance().debugLabels();
    c.subgroupSize = subgroupSize;
    c.maxShadowAtlases = 1;
    std::unique_ptr<Context> context;
    require(Context::create(c, context));
    return context;
}

}  // namespace

SharedPipelines::SharedPipelines(const Device& device, std::uint32_t subgroupSize)
    : device_(device),
      wantedSubgroupSize_(subgroupSize),
      context_(makeContext(device, subgroupSize)),
      lighting_(device, *context_),
      lightVisibility_(device, *context_) {}

}  // namespace gnomon::renderer
