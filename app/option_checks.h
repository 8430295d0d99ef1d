#pragma once
// What the values of options may be, where CLI11 has no check of its own.

#include <CLI/CLI.hpp>

namespace gnomon::app {

/// For options that name a file: an empty name is refused.
const CLI::Validator& fileName();

/// How the name of a file ends, in small letters: ".glb" of "Scene.GLB".
std::string extensionOf(const std::string& file);

/// Throws UsageError where a file's name does not end in `extension`, in small letters as ".png". An empty name is an
/// option that was not given.
void requireExtension(const std::string& file, const std::string& extension);
/// The same, but names without any extension pass.
void checkExtension(const std::string& file, const std::string& extension);

/// As CLI::Range, which lets NaN pass.
CLI::Validator numberWithin(double low, double high);

}  // namespace gnomon::app
