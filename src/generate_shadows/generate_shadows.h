#pragma once
// Phase 4. Source: the paper, section 2.4.

#include "vulkan/pass.h"

namespace gnomon {

const Pass& generateShadowsPass() noexcept;

}  // namespace gnomon
