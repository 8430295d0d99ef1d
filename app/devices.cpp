#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/errors.h"
#include "renderer/gpu/instance.h"

namespace gnomon::app {
namespace {

using renderer::DeviceInfo;

std::string apiVersionOf(const DeviceInfo& info) {
    return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(info.apiVersion), VK_API_VERSION_MINOR(info.apiVersion),
                       VK_API_VERSION_PATCH(info.apiVersion));
}

void printJson(const std::vector<DeviceInfo>& devices) {
    nlohmann::ordered_json out = nlohmann::ordered_json::array();
    for (const DeviceInfo& info : devices) {
        const VkPhysicalDeviceLimits& limits = info.properties.limits;
        out.push_back({{"index", out.size()},
                       {"name", info.name},
                       {"type", info.typeName},
                       {"driver", info.driver},
                       {"vulkan", apiVersionOf(info)},
                       {"subgroupSize", info.subgroupSize},
                       {"minSubgroupSize", info.minSubgroupSize},
                       {"maxSubgroupSize", info.maxSubgroupSize},
                       {"maxImageDimension2D", limits.maxImageDimension2D},
                       {"maxStorageBufferRange", limits.maxStorageBufferRange},
                       {"suitable", info.suitable},
                       {"missing", info.missing}});
    }
    fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

void printList(const std::vector<DeviceInfo>& devices) {
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const DeviceInfo& info = devices[i];
        fmt::print("{}  {}\n   {}, {}, Vulkan {}, subgroups of {} ({} to {})\n   {}\n", i, info.name, info.typeName,
                   info.driver, apiVersionOf(info), info.subgroupSize, info.minSubgroupSize, info.maxSubgroupSize,
                   info.suitable ? "Suitable." : info.missing);
    }
    if (devices.empty()) fmt::print("No Vulkan device was found; install a driver, for example mesa-vulkan-drivers.\n");
}

}  // namespace

void addDevicesCommand(CLI::App& app, Work& chosen) {
    CLI::App* command = app.add_subcommand("devices", "List the Vulkan devices, and whether they are suitable");
    const auto json = std::make_shared<bool>(false);
    command->add_flag("--json", *json, "As JSON");
    command->callback([&chosen, json] {
        chosen = [json] {
            const renderer::VulkanInstance instance;
            const std::vector<DeviceInfo> devices = instance.listDevices();
            *json ? printJson(devices) : printList(devices);
            return kGood;
        };
    });
}

}  // namespace gnomon::app
