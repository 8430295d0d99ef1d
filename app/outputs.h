#pragma once
// The files a command is to write.

#include <span>
#include <string>

namespace gnomon::app {

/// Whether the file is right within the folder, by canonical paths. Neither need be there; empty names lie nowhere.
bool liesIn(const std::string& file, const std::string& folder);

/// To be called before any work is done. Throws UsageError where two outputs are one file, or an output is an input.
/// All go by canonical path. Empty names are options that were not given. Throws std::runtime_error where an output
/// cannot be written.
void checkOutputs(std::span<const std::string> outputs, std::span<const std::string> inputs);

}  // namespace gnomon::app
