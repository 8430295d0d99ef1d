#pragma once
// Checks the host's shadow views and turns them into what shaders read.

#include <span>

#include "gnomon/view.h"
#include "gpu_interface/structs.h"

namespace gnomon {

// How wide a view is is not asked: six faces may reach any number of texels beyond 90 degrees.
// Writes views.size() entries, front to back, never reading `out`. Fails on the first view that breaks a rule of
// ShadowView; thread safe.
Result convertShadowViews(std::span<const ShadowView> views, std::span<const ShadowAtlas> atlases,
                          gpu::GpuShadowView* out) noexcept;

}  // namespace gnomon
