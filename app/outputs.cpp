#include "app/outputs.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "app/errors.h"
#include "renderer/picture/picture.h"

namespace gnomon::app {
namespace {

std::filesystem::path canonical(const std::string& file) {
    std::error_code error;
    const std::filesystem::path path = std::filesystem::weakly_canonical(std::filesystem::absolute(file), error);
    return error ? std::filesystem::path(file) : path;
}

}  // namespace

const CLI::Validator& fileName() {
    static const CLI::Validator validator(
        [](const std::string& name) { return name.empty() ? "give a file name" : ""; }, "FILE");
    return validator;
}

void checkOutputs(std::span<const std::string> outputs, std::span<const std::string> inputs) {
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        if (outputs[i].empty()) continue;
        const std::filesystem::path path = canonical(outputs[i]);
        for (const std::string& input : inputs) {
            if (!input.empty() && canonical(input) == path)
                throw UsageError(fmt::format("'{}' is an input; it will not be overwritten.", outputs[i]));
        }
        for (std::size_t k = 0; k < i; ++k) {
            if (!outputs[k].empty() && canonical(outputs[k]) == path)
                throw UsageError(fmt::format("'{}' is named for two outputs.", outputs[i]));
        }
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
