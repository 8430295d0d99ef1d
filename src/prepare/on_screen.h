#pragma once
// How large a visible light is on screen, for hosts that plan shadow views by it.

#include "prepare/cull_and_sort.h"

namespace gnomon::prepare {

/// `share`: of the screen that its reach covers.
LightOnScreen measure(const VisibleLight& light, const ViewCamera& camera, float share) noexcept;

}  // namespace gnomon::prepare
