#pragma once
// The house rules that a program can check: who may include whom, sizes of files, tabs, forbidden words.

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon::house {

inline constexpr std::size_t kMaxCppLines = 600;
inline constexpr std::size_t kMaxShaderLines = 250;

struct TextFile {
    std::string path;  // relative to the project, with slashes
    std::string text;
};

/// One broken rule, as a sentence that begins with file and line.
using Violations = std::vector<std::string>;

/// A line `#include "name"`, `#include <name>` or `#include MACRO`.
struct Include {
    std::size_t line = 0;  // from 1
    std::string name;
    enum class Form { Quoted, Angled, Macro } form = Form::Quoted;
};

/// Every text file of the project's rooms, in order of path. Throws std::filesystem::filesystem_error.
std::vector<TextFile> readProject(const std::filesystem::path& root);

std::vector<Include> includesOf(std::string_view text);

/// The room that a file belongs to: "include", "gpu_interface", "src", "app/view" ...; empty for files at the top.
std::string roomOf(std::string_view path);

bool isCpp(std::string_view path);
bool isShader(std::string_view path);

/// `paths`: all files of the project, by which a name between quotes is found.
Violations checkIncludes(const TextFile& file, const std::set<std::string>& paths);
Violations checkSize(const TextFile& file);
Violations checkText(const TextFile& file);
/// Headers and shader includes may be included twice.
Violations checkGuard(const TextFile& file);

/// All rules over all files.
Violations checkProject(const std::vector<TextFile>& files);

}  // namespace gnomon::house
