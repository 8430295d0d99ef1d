#pragma once
// Pictures of what `verify` found, the colours as docs/verify.md says: one per light, and one of all lights.

#include <filesystem>
#include <span>
#include <vector>

#include "app/verify/report.h"
#include "picture/picture.h"

namespace gnomon::app {

class VerifyMaps {
public:
    /// `frame`: the picture that is judged. `soft`: as figuresOf() has it.
    VerifyMaps(std::filesystem::path folder, renderer::Picture frame, bool soft);

    /// Writes truth, result and errors of a light, side by side.
    void add(const VerifiedLight& light, const renderer::LightTruth& truth, std::span<const float> result);
    /// Writes the frame beside the worst error of each pixel over all lights.
    void writeTotal() const;

    [[nodiscard]] static std::string totalFileName() { return "total.png"; }

private:
    std::filesystem::path folder_;
    renderer::Picture frame_;
    bool soft_;
    std::vector<std::uint8_t> worst_;  // per pixel
};

/// light_007_name.png, in letters, digits and dashes.
[[nodiscard]] std::string mapFileName(const VerifiedLight& light);

}  // namespace gnomon::app
