#pragma once
// Sums for the frame's statistics; not part of the technique.

#include "vulkan/pass.h"

namespace gnomon {

const Pass& gatherStatisticsPass() noexcept;

}  // namespace gnomon
