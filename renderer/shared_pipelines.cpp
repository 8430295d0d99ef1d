#include "renderer/shared_pipelines.h"

#include <span>

#include "renderer/gpu/error.h"

namespace gnomon::renderer {
namespace {

std::unique_ptr<Context> makeContext(const Device& device, std::uint32_t subgroupSize) {
    ContextDesc desc = contextDescOf(device);
    desc.subgroupSize = subgroupSize;
    desc.maxShadowAtlases = 1;
    std::unique_ptr<Context> context;
    require(Context::create(desc, context));
    return context;
}

}  // namespace

ContextDesc contextDescOf(const Device& device) {
    ContextDesc desc;
    desc.instance = device.instance().handle();
    desc.physicalDevice = device.physical();
    desc.device = device.handle();
    desc.getInstanceProcAddr = vkGetInstanceProcAddr;
    desc.pipelineCache = device.pipelineCache();
    desc.queueFamilies = std::span(&device.info().queueFamily, 1);
    desc.debugLabels = device.instance().debugLabels();
    return desc;
}

SharedPipelines::SharedPipelines(const Device& device, std::uint32_t subgroupSize)
    : device_(device),
      wantedSubgroupSize_(subgroupSize),
      context_(makeContext(device, subgroupSize)),
      lighting_(device, *context_),
      lightVisibility_(device, *context_) {}

}  // namespace gnomon::renderer
