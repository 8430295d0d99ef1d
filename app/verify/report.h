#pragma once
// What `verify` found, as a table and as JSON.

#include <filesystem>
#include <string>
#include <vector>

#include "app/frame_json.h"
#include "app/verify/options.h"
#include "app/verify/sweep.h"
#include "truth/figures.h"
#include "truth/flicker.h"

namespace gnomon::app {

struct VerifiedLight {
    std::uint32_t index = 0;  // in the scene
    std::string name;
    renderer::LightKind kind = renderer::LightKind::Point;
    bool hasShadowmap = true;  // the atlas had room
    renderer::LightFigures figures;
    renderer::FlickerFigures flicker;
};

struct VerifyResult {
    std::vector<VerifiedLight> lights;  // those that cast and reach a pixel
    renderer::LightFigures total;
    std::uint32_t flickerFrames = 0;  // 0: not measured
    renderer::FlickerFigures flicker;
    std::uint32_t unseen = 0;         // casting lights that reach no pixel
    std::uint32_t lightsLeftOut = 0;  // of the visible ones, by phase 1's limit
    std::vector<SweptSetting> sweep;  // the chosen setting first; empty: not asked for
    double seconds = 0.0;
};

std::string percent(double share);  ///< with four decimals, without the sign

Json describe(const renderer::Figures& figures);
/// Of what is not subsurface, and the share that was set aside of all.
Json describe(const renderer::LightFigures& figures);

/// What a reader of acne and leak alone would miss, a sentence each.
std::vector<std::string> warningsOf(const VerifyResult& result);

void printVerified(const Session& session, const VerifyResult& result);
void writeVerified(const Session& session, const VerifyOptions& options, const VerifyResult& result,
                   const std::filesystem::path& file);

}  // namespace gnomon::app
