#pragma once
// What the values of options may be, where CLI11 has no check of its own.

#include <CLI/CLI.hpp>

namespace gnomon::app {

/// For options that name a file: an empty name is refused.
const CLI::Validator& fileName();

/// How the name of a file ends, in small letters: ".glb" of "Scene.GLB".
std::string extensionOf(const std::string& file);

/// As CLI::Range, which lets NaN pass.
CLI::Validator numberWithin(double low, double high);

}  // namespace gnomon::app
