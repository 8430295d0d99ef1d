#pragma once
// The files a command is to write.

#include <CLI/CLI.hpp>

#include <span>
#include <string>

namespace gnomon::app {

/// For options that name a file: an empty name is refused.
const CLI::Validator& fileName();

/// Before any work is done: throws UsageError where two outputs are one file, or an output is an input (all by
/// canonical path; empty names are options that were not given), and std::runtime_error where an output cannot be
/// written.
void checkOutputs(std::span<const std::string> outputs, std::span<const std::string> inputs);

}  // namespace gnomon::app
