#pragma once
// Phase 2. Source: the paper, section 2.2.

#include "vulkan/pass.h"

namespace gnomon {

const Pass& findLightsApproximatePass() noexcept;

}  // namespace gnomon
