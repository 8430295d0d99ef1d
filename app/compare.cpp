#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <charconv>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "app/commands.h"
#include "app/errors.h"
#include "app/option_checks.h"
#include "app/outputs.h"
#include "picture/exr.h"
#include "picture/picture.h"

namespace gnomon::app {
namespace {

struct CompareOptions {
    std::string a, b, difference;
    std::string tolerance = "0";
};

/// What `work` gives; where the files are at fault, a UsageError.
template <typename Work>
auto ofInputs(const Work& work) {
    try {
        return work();
    } catch (const std::runtime_error& error) {
        throw UsageError(error.what());
    } catch (const std::invalid_argument& error) {
        throw UsageError(error.what());
    }
}

/// The whole text as a number of this kind from 0 to `most`.
template <typename T>
T toleranceOf(const std::string& text, T most, const char* range) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !(value >= T{} && value <= most))
        throw UsageError(fmt::format("--tolerance: '{}' is no {}.", text, range));
    return value;
}

double shareOf(std::uint64_t pixels, std::uint32_t width, std::uint32_t height) {
    return 100.0 * static_cast<double>(pixels) / (static_cast<double>(width) * height);
}

int comparePngs(const CompareOptions& options) {
    const std::uint32_t tolerance = toleranceOf<std::uint32_t>(options.tolerance, 255, "whole number from 0 to 255");
    const renderer::Picture a = ofInputs([&] { return renderer::readPng(options.a); });
    const renderer::Picture b = ofInputs([&] { return renderer::readPng(options.b); });
    const renderer::Difference difference = ofInputs([&] { return renderer::compare(a, b); });
    if (!options.difference.empty()) renderer::writePng(renderer::differencePicture(a, b), options.difference);
    fmt::print("Largest difference {} of 255; {} pixels differ ({:.4f} %); mean {:.6f}.\n", difference.largest,
               difference.pixels, shareOf(difference.pixels, a.width, a.height), difference.meanAbsolute);
    if (difference.largest <= tolerance) return kGood;
    throw std::runtime_error(
        fmt::format("The pictures differ by {}, more than the tolerance of {}.", difference.largest, tolerance));
}

void printComparison(const renderer::ExrComparison& comparison, const renderer::ExrPicture& picture) {
    fmt::print("{:<16} {:>14} {:>14} {:>14} {:>14}\n", "Channel", "largest", "relative", "pixels differ", "NaN in one");
    for (const renderer::ExrDifference& channel : comparison.channels)
        fmt::print("{:<16} {:>14.6g} {:>14.6g} {:>14} {:>14}\n", channel.channel, channel.largest,
                   channel.largestRelative, channel.pixels, channel.notNumbers);
    const renderer::ExrDifference& all = comparison.all;
    fmt::print("Largest difference {:.9g}{}; largest of |a - b| / max(|a|, |b|) {:.6g}; {} pixels differ ({:.4f} %).\n",
               all.largest, all.channel.empty() ? "" : " in " + all.channel, all.largestRelative, all.pixels,
               shareOf(all.pixels, picture.width, picture.height));
    if (all.notNumbers != 0) fmt::print("{} pixels are no number (NaN) in one picture alone.\n", all.notNumbers);
}

int compareExrs(const CompareOptions& options) {
    const double tolerance =
        toleranceOf<double>(options.tolerance, std::numeric_limits<double>::max(), "finite number that is at least 0");
    const renderer::ExrPicture a = ofInputs([&] { return renderer::readExr(options.a); });
    const renderer::ExrPicture b = ofInputs([&] { return renderer::readExr(options.b); });
    const renderer::ExrComparison comparison = ofInputs([&] { return renderer::compare(a, b); });
    if (!options.difference.empty()) renderer::writeExr(renderer::differencePicture(a, b), options.difference);
    printComparison(comparison, a);
    const renderer::ExrDifference& all = comparison.all;
    if (all.notNumbers != 0)
        throw std::runtime_error(
            fmt::format("The pictures differ: {} pixels are no number in one of them alone.", all.notNumbers));
    if (all.largest <= tolerance) return kGood;
    throw std::runtime_error(
        fmt::format("The pictures differ by {:.9g}, more than the tolerance of {:g}.", all.largest, tolerance));
}

int compareFiles(const CompareOptions& options) {
    const bool exr = extensionOf(options.a) == ".exr";
    if (exr != (extensionOf(options.b) == ".exr"))
        throw UsageError(fmt::format("'{}' and '{}' are pictures of different kinds: give two PNG or two EXR files.",
                                     options.a, options.b));
    checkExtension(options.difference, exr ? ".exr" : ".png");
    const std::string inputs[] = {options.a, options.b};
    checkOutputs({&options.difference, 1}, inputs);
    return exr ? compareExrs(options) : comparePngs(options);
}

}  // namespace

void addCompareCommand(CLI::App& app, Work& chosen) {
    CLI::App* command = app.add_subcommand("compare", "Compare two pictures; exit code 1 where they differ");
    const auto options = std::make_shared<CompareOptions>();
    command->add_option("a", options->a, "A PNG or EXR file")->required();
    command->add_option("b", options->b, "Another of the same kind")->required();
    command
        ->add_option("--diff", options->difference,
                     "Write a picture of the differences: PNG, or EXR with each channel's |a - b|")
        ->check(fileName());
    command
        ->add_option("--tolerance", options->tolerance,
                     "Largest difference of a channel that passes: PNG 0 to 255, EXR a number such as 0.001")
        ->capture_default_str();
    command->callback([&chosen, options] { chosen = [options] { return compareFiles(*options); }; });
}

}  // namespace gnomon::app
