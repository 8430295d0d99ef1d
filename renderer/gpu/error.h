#pragma once
// Errors inside the renderer are exceptions with one clear sentence; the application catches them.

#include <stdexcept>
#include <string>

#include <volk.h>

#include "gnomon/result.h"

namespace gnomon::renderer {

/// A failing Vulkan call, a missing device or a scene that does not fit the device.
class GpuError : public std::runtime_error {
public:
    explicit GpuError(const std::string& sentence) : std::runtime_error(sentence) {}
};

/// Throws GpuError with a sentence that names `what` (for example "creating an image") unless the result is a success.
void check(VkResult result, const char* what);

/// Throws GpuError with the library's sentence unless the result is a success.
inline void require(const Result& result) {
    if (!result) throw GpuError(result.message());
}

}  // namespace gnomon::renderer
