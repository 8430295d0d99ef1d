#include "vulkan/functions.h"

namespace gnomon {

Result loadFunctions(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance, VkDevice device,
                     bool debugLabels, Functions& out) noexcept {
    if (getInstanceProcAddr == nullptr) {
        return Result::failure(Status::BadArgument,
                               "ContextDesc::getInstanceProcAddr is null: pass vkGetInstanceProcAddr.");
    }
#define GNOMON_LOAD(name)                                                                            \
    out.name = reinterpret_cast<PFN_vk##name>(getInstanceProcAddr(instance, "vk" #name));            \
    if (out.name == nullptr) {                                                                       \
        return Result::failure(Status::UnsupportedDevice, "The Vulkan instance lacks vk%s.", #name); \
    }
    GNOMON_INSTANCE_FUNCTIONS(GNOMON_LOAD)
#undef GNOMON_LOAD
#define GNOMON_LOAD(name)                                                                                        \
    out.name = reinterpret_cast<PFN_vk##name>(out.GetDeviceProcAddr(device, "vk" #name));                        \
    if (out.name == nullptr) {                                                                                   \
        return Result::failure(Status::UnsupportedDevice,                                                        \
                               "The device lacks vk%s: create it for Vulkan 1.3 with synchronization2.", #name); \
    }
    GNOMON_DEVICE_FUNCTIONS(GNOMON_LOAD)
#undef GNOMON_LOAD
    if (!debugLabels) return {};
#define GNOMON_LOAD(name)                                                                                            \
    out.name = reinterpret_cast<PFN_vk##name>(getInstanceProcAddr(instance, "vk" #name));                            \
    if (out.name == nullptr) {                                                                                       \
        return Result::failure(Status::BadArgument,                                                                  \
                               "Debug labels were asked for, but VK_EXT_debug_utils is not enabled (vk%s).", #name); \
    }
    GNOMON_DEBUG_FUNCTIONS(GNOMON_LOAD)
#undef GNOMON_LOAD
    return {};
}

}  // namespace gnomon
