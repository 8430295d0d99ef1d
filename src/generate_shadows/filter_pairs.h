#pragma once
// Phase 4, last step. Source: the paper, section 2.4.

#include "vulkan/pass.h"

namespace gnomon {

const Pass& filterPairsPass() noexcept;

}  // namespace gnomon
