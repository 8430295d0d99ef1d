#include "app/outputs.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <stdexcept>

#include "app/errors.h"
#include "picture/picture.h"

namespace gnomon::app {
namespace {

std::filesystem::path canonical(const std::string& file) {
    std::error_code error;
    const std::filesystem::path path = std::filesystem::weakly_canonical(std::filesystem::absolute(file), error);
    return error ? std::filesystem::path(file) : path;
}

}  // namespace

bool liesIn(const std::string& file, const std::string& folder) {
    if (file.empty() || folder.empty()) return false;
    return canonical(file).parent_path() == (canonical(folder) / "file").parent_path();
}

void checkOutputs(std::span<const std::string> outputs, std::span<const std::string> inputs) {
    std::set<std::filesystem::path> read, written;
    for (const std::string& input : inputs)
        if (!input.empty()) read.insert(canonical(input));
    for (const std::string& output : outputs) {
        if (output.empty()) continue;
        const std::filesystem::path path = canonical(output);
        if (read.contains(path)) throw UsageError(fmt::format("'{}' is an input; it will not be overwritten.", output));
        if (!written.insert(path).second) throw UsageError(fmt::format("'{}' is named for two outputs.", output));
    }
    for (const std::string& file : outputs) {
        if (file.empty()) continue;
        try {
            renderer::checkWritable(file);
        } catch (const std::runtime_error& error) {
            throw UsageError(error.what());
        }
    }
}

}  // namespace gnomon::app
