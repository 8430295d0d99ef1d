#pragma once
// Least and greatest depths of blocks of the shadow atlases.

#include "vulkan/pass.h"

namespace gnomon {

const Pass& shadowBoundsPass() noexcept;

}  // namespace gnomon
