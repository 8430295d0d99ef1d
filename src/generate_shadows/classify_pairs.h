#pragma once
// Phase 4, which pairs go to which queue. Source: the paper, section 2.4.

#include "vulkan/pass.h"

namespace gnomon {

const Pass& classifyPairsPass() noexcept;

}  // namespace gnomon
