#include "app/option_checks.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <string>

#include "app/errors.h"

namespace gnomon::app {

const CLI::Validator& fileName() {
    static const CLI::Validator validator(
        [](const std::string& name) { return name.empty() ? "give a file name" : ""; }, "FILE");
    return validator;
}

std::string extensionOf(const std::string& file) {
    std::string extension = std::filesystem::path(file).extension().string();
    for (char& c : extension)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return extension;
}

void checkExtension(const std::string& file, const std::string& extension) {
    if (!extensionOf(file).empty()) requireExtension(file, extension);
}

void requireExtension(const std::string& file, const std::string& extension) {
    if (file.empty() || extensionOf(file) == extension) return;
    std::string kind = extension.substr(1);
    for (char& c : kind) c = static_cast<char>(c - 'a' + 'A');
    throw UsageError(fmt::format("'{}' is no name for {} {} file: it must end in {}.", file, kind == "EXR" ? "an" : "a",
                                 kind, extension));
}

CLI::Validator numberWithin(double low, double high) {
    const std::string range = fmt::format("FLOAT in [{:g} - {:g}]", low, high);
    return {[low, high](const std::string& text) {
                double value = 0.0;
                const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
                const bool good =
                    error == std::errc() && end == text.data() + text.size() && low <= value && value <= high;
                return good ? std::string() : fmt::format("'{}' is no number from {:g} to {:g}", text, low, high);
            },
            range};
}

}  // namespace gnomon::app
