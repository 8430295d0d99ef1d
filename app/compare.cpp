#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>
#include <string>

#include "app/commands.h"
#include "app/errors.h"
#include "app/option_checks.h"
#include "app/outputs.h"
#include "picture/picture.h"

namespace gnomon::app {
namespace {

struct CompareOptions {
    std::string a, b, difference;
    std::uint32_t tolerance = 0;
};

renderer::Picture readInput(const std::string& file) {
    try {
        return renderer::readPng(file);
    } catch (const std::runtime_error& error) {
        throw UsageError(error.what());
    }
}

int compareFiles(const CompareOptions& options) {
    const std::string inputs[] = {options.a, options.b};
    checkOutputs({&options.difference, 1}, inputs);
    const renderer::Picture a = readInput(options.a), b = readInput(options.b);
    if (a.width != b.width || a.height != b.height)
        throw UsageError(
            fmt::format("The pictures differ in size: {}x{} and {}x{}.", a.width, a.height, b.width, b.height));
    const renderer::Difference difference = renderer::compare(a, b);
    if (!options.difference.empty()) renderer::writePng(renderer::differencePicture(a, b), options.difference);
    const double share = 100.0 * static_cast<double>(difference.pixels) / (static_cast<double>(a.width) * a.height);
    fmt::print("Largest difference {} of 255; {} pixels differ ({:.4f} %); mean {:.6f}.\n", difference.largest,
               difference.pixels, share, difference.meanAbsolute);
    if (difference.largest <= options.tolerance) return kGood;
    throw std::runtime_error(fmt::format("The pictures differ by {}, more than the tolerance of {}.",
                                         difference.largest, options.tolerance));
}

}  // namespace

void addCompareCommand(CLI::App& app, Work& chosen) {
    CLI::App* command = app.add_subcommand("compare", "Compare two pictures; exit code 1 where they differ");
    const auto options = std::make_shared<CompareOptions>();
    command->add_option("a", options->a, "A PNG file")->required();
    command->add_option("b", options->b, "A PNG file")->required();
    command->add_option("--diff", options->difference, "Write a picture of the differences")->check(fileName());
    command->add_option("--tolerance", options->tolerance, "Largest difference of a channel that passes")
        ->check(CLI::Range(0, 255))
        ->capture_default_str();
    command->callback([&chosen, options] { chosen = [options] { return compareFiles(*options); }; });
}

}  // namespace gnomon::app
