#include "renderer/gpu/instance.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstring>

namespace gnomon::renderer {

namespace {

const char* sentenceOf(VkResult result) {
    switch (result) {
        case VK_ERROR_OUT_OF_HOST_MEMORY:
            return "the host is out of memory";
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
            return "the device is out of memory; use a smaller resolution, shadow atlas or scene";
        case VK_ERROR_DEVICE_LOST:
            return "the device was lost (a crash or time-out of the driver); start again";
        case VK_ERROR_INITIALIZATION_FAILED:
            return "the driver could not be initialised";
        case VK_ERROR_LAYER_NOT_PRESENT:
            return "a layer is not installed";
        case VK_ERROR_EXTENSION_NOT_PRESENT:
            return "an extension is not present";
        case VK_ERROR_FEATURE_NOT_PRESENT:
            return "a feature is not present";
        case VK_ERROR_INCOMPATIBLE_DRIVER:
            return "no compatible Vulkan driver was found";
        case VK_ERROR_TOO_MANY_OBJECTS:
            return "too many objects exist";
        case VK_ERROR_FORMAT_NOT_SUPPORTED:
            return "a format is not supported";
        case VK_ERROR_FRAGMENTED_POOL:
        case VK_ERROR_OUT_OF_POOL_MEMORY:
            return "a descriptor pool is exhausted";
        case VK_TIMEOUT:
            return "the device did not finish in time";
        default:
            return nullptr;
    }
}

DebugFunctions loadDebugFunctions(VkInstance instance) {
    const auto load = [instance]<typename Function>(Function& function, const char* name) {
        function = reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
    };
    DebugFunctions functions;
    load(functions.createMessenger, "vkCreateDebugUtilsMessengerEXT");
    load(functions.destroyMessenger, "vkDestroyDebugUtilsMessengerEXT");
    load(functions.setObjectName, "vkSetDebugUtilsObjectNameEXT");
    load(functions.beginLabel, "vkCmdBeginDebugUtilsLabelEXT");
    load(functions.endLabel, "vkCmdEndDebugUtilsLabelEXT");
    return functions;
}

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                         VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    if (severity >= VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT && data->pMessage != nullptr) {
        static_cast<MessageLog*>(user)->add(data->pMessage);
    }
    return VK_FALSE;
}

VKAPI_ATTR VkBool32 VKAPI_CALL onMessagePrinted(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                VkDebugUtilsMessageTypeFlagsEXT type,
                                                const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    if (severity >= VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT && data->pMessage != nullptr) {
        std::fprintf(stderr, "Vulkan: %s\n", data->pMessage);
    }
    return onMessage(severity, type, data, user);
}

bool hasLayer(const char* name) {
    std::uint32_t count = 0;
    check(vkEnumerateInstanceLayerProperties(&count, nullptr), "listing layers");
    std::vector<VkLayerProperties> layers(count);
    check(vkEnumerateInstanceLayerProperties(&count, layers.data()), "listing layers");
    return std::any_of(layers.begin(), layers.end(),
                       [&](const auto& l) { return std::strcmp(l.layerName, name) == 0; });
}

bool hasInstanceExtension(const char* name) {
    std::uint32_t count = 0;
    check(vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr), "listing instance extensions");
    std::vector<VkExtensionProperties> found(count);
    check(vkEnumerateInstanceExtensionProperties(nullptr, &count, found.data()), "listing instance extensions");
    return std::any_of(found.begin(), found.end(),
                       [&](const auto& e) { return std::strcmp(e.extensionName, name) == 0; });
}

std::string lowered(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return out;
}

// Prefers discrete over integrated over virtual over CPU, and lavapipe (compiled, threaded) over SwiftShader.
void rankDevice(DeviceInfo& info) {
    switch (info.properties.deviceType) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            info.typeName = "discrete GPU", info.rank = 50;
            break;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            info.typeName = "integrated GPU", info.rank = 40;
            break;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            info.typeName = "virtual GPU", info.rank = 30;
            break;
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            info.typeName = "CPU", info.rank = 20;
            break;
        default:
            info.typeName = "other", info.rank = 10;
            break;
    }
    if (lowered(info.name).find("swiftshader") != std::string::npos) info.rank -= 1;
}

void findMissing(DeviceInfo& info) {
    auto lacks = [&](const std::string& what) {
        if (info.missing.empty()) info.missing = "'" + info.name + "' lacks " + what + ".";
    };
    if (info.apiVersion < VK_API_VERSION_1_3) {
        lacks("Vulkan 1.3 (it has " + std::to_string(VK_API_VERSION_MAJOR(info.apiVersion)) + "." +
              std::to_string(VK_API_VERSION_MINOR(info.apiVersion)) + ")");
        return;
    }
    VkPhysicalDeviceVulkan13Features v13{};
    v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v13, {}};
    vkGetPhysicalDeviceFeatures2(info.handle, &features);
    if (!v13.synchronization2) lacks("the feature synchronization2");
    if (!v13.dynamicRendering) lacks("the feature dynamicRendering");
    if (!v13.computeFullSubgroups) lacks("the feature computeFullSubgroups");
    if (!v13.subgroupSizeControl) lacks("the feature subgroupSizeControl");
    if (info.properties.limits.maxColorAttachments < 7) lacks("seven colour attachments");
    if (info.queueFamily == VK_QUEUE_FAMILY_IGNORED) lacks("a queue for both graphics and compute");
}

DeviceInfo describe(VkPhysicalDevice device) {
    DeviceInfo info;
    info.handle = device;
    VkPhysicalDeviceVulkan13Properties v13{};
    v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES;
    VkPhysicalDeviceVulkan12Properties v12{};
    v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES;
    v12.pNext = &v13;
    VkPhysicalDeviceVulkan11Properties v11{};
    v11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES;
    v11.pNext = &v12;
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, nullptr, {}};
    vkGetPhysicalDeviceProperties(device, &info.properties);
    info.apiVersion = info.properties.apiVersion;
    info.name = info.properties.deviceName;
    if (info.apiVersion >= VK_API_VERSION_1_3) {
        properties.pNext = &v11;
        vkGetPhysicalDeviceProperties2(device, &properties);
        info.driver = std::string(v12.driverName) + " " + v12.driverInfo;
        info.subgroupSize = v11.subgroupSize;
        info.minSubgroupSize = v13.minSubgroupSize;
        info.maxSubgroupSize = v13.maxSubgroupSize;
    }
    info.queueFamily = VK_QUEUE_FAMILY_IGNORED;
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (std::uint32_t f = 0; f < count && info.queueFamily == VK_QUEUE_FAMILY_IGNORED; ++f) {
        if ((families[f].queueFlags & kNeeded) == kNeeded) info.queueFamily = f;
    }
    rankDevice(info);
    findMissing(info);
    info.suitable = info.missing.empty();
    return info;
}

std::string namesOf(const std::vector<DeviceInfo>& devices) {
    std::string names;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        names += (i == 0 ? "" : ", ") + std::to_string(i) + " '" + devices[i].name + "'";
    }
    return names;
}

}  // namespace

void check(VkResult result, const char* what) {
    if (result >= VK_SUCCESS && result != VK_TIMEOUT) return;
    const char* why = sentenceOf(result);
    std::string sentence = std::string("Vulkan failed while ") + what + ": ";
    sentence += why != nullptr ? why : "error " + std::to_string(static_cast<int>(result));
    throw GpuError(sentence + ".");
}

void MessageLog::add(std::string message) {
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(message));
}
std::size_t MessageLog::count() const {
    const std::lock_guard lock(mutex_);
    return messages_.size();
}
std::vector<std::string> MessageLog::messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
}
void MessageLog::clear() {
    const std::lock_guard lock(mutex_);
    messages_.clear();
}

VulkanInstance::VulkanInstance(const InstanceDesc& desc) : log_(std::make_unique<MessageLog>()) {
    if (volkInitialize() != VK_SUCCESS) {
        throw GpuError("No Vulkan loader was found; install libvulkan1 and a driver such as mesa-vulkan-drivers.");
    }
    if (volkGetInstanceVersion() < VK_API_VERSION_1_3) {
        throw GpuError("The Vulkan loader is older than 1.3; install a newer libvulkan1.");
    }
    std::vector<const char*> layers;
    std::vector<const char*> extensions = desc.extensions;
    debugUtils_ = (desc.debugLabels || desc.validation) && hasInstanceExtension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (debugUtils_) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (desc.validation) {
        if (!hasLayer("VK_LAYER_KHRONOS_validation")) {
            throw GpuError("The Vulkan validation layer is not installed; install vulkan-validationlayers.");
        }
        layers.push_back("VK_LAYER_KHRONOS_validation");
        extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    }
    const VkValidationFeatureEnableEXT enables[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkValidationFeaturesEXT validation{};
    validation.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    validation.enabledValidationFeatureCount = 1;
    validation.pEnabledValidationFeatures = enables;
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "gnomon";
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pNext = desc.validation ? &validation : nullptr;
    info.pApplicationInfo = &application;
    info.enabledLayerCount = static_cast<std::uint32_t>(layers.size());
    info.ppEnabledLayerNames = layers.data();
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    const VkResult created = vkCreateInstance(&info, nullptr, &instance_);
    if (created == VK_ERROR_INCOMPATIBLE_DRIVER) {
        throw GpuError("No Vulkan driver was found; install one, for example mesa-vulkan-drivers.");
    }
    check(created, "creating the instance");
    // Loader trampolines for device functions too, so that several devices can live side by side.
    volkLoadInstance(instance_);
    if (debugUtils_) debug_ = loadDebugFunctions(instance_);
    if (desc.validation && debugUtils_) {
        VkDebugUtilsMessengerCreateInfoEXT messenger{};
        messenger.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
        messenger.messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
        messenger.messageType =
            VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
        messenger.pfnUserCallback = desc.printMessages ? onMessagePrinted : onMessage;
        messenger.pUserData = log_.get();
        if (debug_.createMessenger(instance_, &messenger, nullptr, &messenger_) != VK_SUCCESS) {
            vkDestroyInstance(instance_, nullptr);
            throw GpuError("The callback for validation messages could not be installed.");
        }
    }
}

VulkanInstance::~VulkanInstance() {
    if (messenger_ != VK_NULL_HANDLE) debug_.destroyMessenger(instance_, messenger_, nullptr);
    vkDestroyInstance(instance_, nullptr);
}

std::vector<DeviceInfo> VulkanInstance::listDevices() const {
    std::uint32_t count = 0;
    const VkResult listed = vkEnumeratePhysicalDevices(instance_, &count, nullptr);
    if (listed == VK_ERROR_INITIALIZATION_FAILED) return {};  // the loader's word for "no driver could be used"
    check(listed, "listing devices");
    std::vector<VkPhysicalDevice> handles(count);
    if (count != 0) check(vkEnumeratePhysicalDevices(instance_, &count, handles.data()), "listing devices");
    std::vector<DeviceInfo> devices;
    for (const VkPhysicalDevice handle : handles) devices.push_back(describe(handle));
    return devices;
}

DeviceInfo VulkanInstance::chooseDevice(std::string_view wanted) const {
    const std::vector<DeviceInfo> devices = listDevices();
    if (devices.empty()) {
        throw GpuError("No Vulkan device was found; install a driver, for example mesa-vulkan-drivers.");
    }
    const DeviceInfo* best = nullptr;
    if (wanted.empty()) {
        for (const DeviceInfo& d : devices) {
            if (d.suitable && (best == nullptr || d.rank > best->rank)) best = &d;
        }
        if (best == nullptr) throw GpuError("No Vulkan device is suitable: " + devices.front().missing);
        return *best;
    }
    const bool isIndex =
        std::all_of(wanted.begin(), wanted.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    if (isIndex && wanted.size() < 6) {
        const std::size_t index = std::stoul(std::string(wanted));
        if (index < devices.size()) best = &devices[index];
    }
    for (const DeviceInfo& d : devices) {
        if (best == nullptr && lowered(d.name).find(lowered(wanted)) != std::string::npos) best = &d;
    }
    if (best == nullptr) {
        throw GpuError("No Vulkan device matches '" + std::string(wanted) + "'; known are " + namesOf(devices) + ".");
    }
    if (!best->suitable) throw GpuError(best->missing);
    return *best;
}

}  // namespace gnomon::renderer
