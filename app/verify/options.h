#pragma once
// What `gnomon verify` was asked for.

#include <cstdint>
#include <string>
#include <vector>

#include "app/settings.h"

namespace gnomon::app {

struct VerifyOptions {
    Settings settings;
    std::string json, maps, exportedLights, edgeSet = "footprint";
    std::vector<std::uint32_t> lights;  // empty: all
    std::uint32_t rays = 256, subset = 16, flickerFrames = 0;
    bool sweep = false;
    std::string sweepConstants = "0,64,256,1024,4096,16384,65536", sweepSlopes = "0,0.5,1,2,4,8";
};

}  // namespace gnomon::app
