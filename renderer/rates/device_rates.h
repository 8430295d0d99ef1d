#pragma once
// How fast a device copies memory and samples textures: what a pass cannot beat with data that comes from memory.

#include "renderer/gpu/device.h"

namespace gnomon::renderer {

/// Of a D32 array image, all in the texture caches, per second.
struct SampleRates {
    double coherent = 0.0;   ///< neighbouring lanes read neighbouring texels
    double scattered = 0.0;  ///< each lane reads somewhere in a square of 32x32 texels, as taps of soft shadows do
};

struct DeviceRates {
    double bytesPerSecond = 0.0;  ///< read and written, by a large copy that no cache holds
    SampleRates fetches;          ///< texelFetch: one texel
    SampleRates gathers;          ///< textureGather: 2x2 texels
};

/// Best of several, in about a second. The device needs timestamps. Throws GpuError. Waits for the device.
DeviceRates measureDeviceRates(const Device& device);

}  // namespace gnomon::renderer
