// gnomon: renders pictures with tiled deferred shadows, measures and verifies them, and compares pictures.

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>

#include "app/build_info.h"
#include "app/commands.h"
#include "app/errors.h"

namespace gnomon::app {
namespace {

// One line that ends like a sentence, whatever a library wrote.
void complain(std::string sentence) {
    while (!sentence.empty() && (sentence.back() == '\n' || sentence.back() == ' ')) sentence.pop_back();
    std::replace_if(
        sentence.begin(), sentence.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    if (sentence.empty() || std::string(".!?").find(sentence.back()) == std::string::npos) sentence += '.';
    std::fputs(("gnomon: " + sentence + "\n").c_str(), stderr);
}

// What is wrong with a command line that names no command and asks for no help. It begins with `first`.
std::string withoutCommand(const std::string& first) {
    if (first.empty()) return "A command is missing; gnomon --help lists them.";
    if (first.front() != '-') return fmt::format("There is no command '{}'; gnomon --help lists them.", first);
    return fmt::format("'{}' is no option here, and a command is missing; gnomon --help lists both.", first);
}

int parseAndWork(int argc, char** argv) {
    CLI::App app("Tiled deferred shadows: renders, measures and verifies them, compares pictures.", "gnomon");
    app.set_version_flag("--version", fmt::format("gnomon {} ({})", version(), commit()));
    app.require_subcommand(1);
    app.footer("Exit codes: 0 good, 1 the work failed, 2 wrong usage or input.");
    Work work;
    addRenderCommand(app, work);
    addBenchCommand(app, work);
    addVerifyCommand(app, work);
    addCompareCommand(app, work);
    addDevicesCommand(app, work);
    addScenesCommand(app, work);
    addSettingsCommand(app, work);
    for (const auto& [name, group] : {std::pair{"render", "Pictures"},
                                      {"compare", "Pictures"},
                                      {"bench", "Measurements"},
                                      {"verify", "Measurements"},
                                      {"devices", "What there is"},
                                      {"scenes", "What there is"},
                                      {"settings", "What there is"}})
        app.get_subcommand(name)->group(group);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
        if (app.get_subcommands().empty()) throw UsageError(withoutCommand(argc > 1 ? argv[1] : ""));
        throw UsageError(error.what());
    }
    const int code = work();
    if (std::fflush(stdout) != 0) throw std::runtime_error("The output could not be written.");
    return code;
}

int guarded(int argc, char** argv) {
    try {
        return parseAndWork(argc, argv);
    } catch (const UsageError& error) {
        complain(error.what());
        return kWrongUsage;
    } catch (const std::bad_alloc&) {
        complain("There is not enough memory.");
    } catch (const std::exception& error) {
        complain(error.what());
    } catch (...) {
        complain("An unknown error came up.");
    }
    return kFailed;
}

}  // namespace
}  // namespace gnomon::app

int main(int argc, char** argv) {
    return gnomon::app::guarded(argc, argv);
}
