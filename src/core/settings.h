#pragma once
// What shaders see of ShadowSettings.

#include "gnomon/settings.h"
#include "gpu_interface/structs.h"

namespace gnomon {

// All but subgroupSize and shadowAtlases, which are the context's. For settings that were checked.
gpu::Specialization specializationOf(const ShadowSettings& settings) noexcept;
void writePcssTaps(const ShadowSettings& settings, gpu::GpuFrame& frame) noexcept;

}  // namespace gnomon
