#pragma once
// Phase 3. Source: the paper, section 2.3.

#include "vulkan/pass.h"

namespace gnomon {

const Pass& findLightsAccuratePass() noexcept;

}  // namespace gnomon
