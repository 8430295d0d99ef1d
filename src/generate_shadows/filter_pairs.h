#pragma once
// Phase 4, for one queue of pairs. Source: the paper, section 2.4.

#include "vulkan/pass.h"

namespace gnomon {

const Pass& filterPairsPass() noexcept;

}  // namespace gnomon
