#pragma once
// Cascades: which of a directional light's views a pixel samples, and how one gives way to the next.
//
// Source: Engel 2006 and Valient 2008 (cascaded shadow maps); the specification, Phase 4.
//
// What: the first cascade that holds the pixel, that is where it lies kCascadeMarginPx texels inside the rectangle and
// at a device depth of 0 to 1. Over the last tenth of the way from the cascade's middle to that margin its visibility
// turns, linearly, into that of the next, which is 1 if there is none or if it does not hold the pixel. A pixel that no
// cascade holds is lit.

#include <functional>
#include <span>

#include "reference/filters.h"

namespace gnomon::reference {

/// A pixel in one cascade.
struct CascadeFit {
    Verdict holds = Verdict::Never;
    Interval blend;  ///< 0: this cascade alone; 1: the next alone
};
CascadeFit fitIn(const ShadowViewModel& cascade, const Pixel& pixel);

/// `sample` gives the visibility in one of the cascades.
Visibility throughCascades(std::span<const ShadowViewModel> cascades, const Pixel& pixel,
                           const std::function<Visibility(std::size_t)>& sample);

}  // namespace gnomon::reference
