#pragma once
// Phase 4, the search of Filter::PcssShared. Source: the paper, section 2.4.

#include "vulkan/pass.h"

namespace gnomon {

const Pass& searchPairsPass() noexcept;

}  // namespace gnomon
