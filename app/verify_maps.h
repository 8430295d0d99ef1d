#pragma once
// Pictures of what `verify` found, one file per light.

#include <filesystem>
#include <span>
#include <string>

#include "app/verify_report.h"
#include "renderer/picture/picture.h"

namespace gnomon::app {

/// Truth, result and errors side by side, the colours as docs/verify.md says.
[[nodiscard]] renderer::Picture errorMap(std::span<const renderer::PixelTruth> truth, std::span<const float> result,
                                         renderer::TruthExtent extent, bool soft);

/// light_007_name.png, in letters, digits and dashes.
[[nodiscard]] std::string mapFileName(const VerifiedLight& light);

}  // namespace gnomon::app
