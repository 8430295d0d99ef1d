#pragma once
// All that the program does with a file before and beside the device: load it, complete it, pose it, trace it.

#include <filesystem>
#include <string>

namespace gnomon::fuzz {

struct Outcome {
    bool loaded = false, posed = false, traced = false;
    std::string fault;  ///< what was wrong with the answer; empty: nothing
};

/// Never throws. Crashes, hangs and sanitizers' reports are the caller's to see.
[[nodiscard]] Outcome runCase(const std::filesystem::path& file);

}  // namespace gnomon::fuzz
