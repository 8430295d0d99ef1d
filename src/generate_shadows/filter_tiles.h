#pragma once
// Phase 4, for cheap filters. Source: the paper, section 2.4.

#include "vulkan/pass.h"

namespace gnomon {

const Pass& filterTilesPass() noexcept;

}  // namespace gnomon
