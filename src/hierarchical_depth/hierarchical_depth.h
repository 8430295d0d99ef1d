#pragma once
// Hierarchical depth. Source: the paper, section 2.2, note 1.

#include "vulkan/pass.h"

namespace gnomon {

const Pass& hierarchicalDepthPass() noexcept;

}  // namespace gnomon
