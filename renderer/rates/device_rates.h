#pragma once
// How fast a device copies memory and samples textures: what a pass cannot beat with data that comes from memory.

#include "renderer/gpu/device.h"

namespace gnomon::renderer {

struct DeviceRates {
    double bytesPerSecond = 0.0;    ///< read and written, by a large copy that no cache holds
    double fetchesPerSecond = 0.0;  ///< texelFetch of a D32 array image, all in the texture caches
    double gathersPerSecond = 0.0;  ///< textureGather of it
};

/// Best of several, in about a second. The device needs timestamps. Throws GpuError. Waits for the device.
DeviceRates measureDeviceRates(const Device& device);

}  // namespace gnomon::renderer
