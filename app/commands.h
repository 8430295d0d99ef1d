#pragma once
// The subcommands. Each adds itself to the command line; parsing one that is used sets `chosen` to the work to be done,
// which returns the exit code.

#include <CLI/CLI.hpp>
#include <functional>

namespace gnomon::app {

using Work = std::function<int()>;

void addRenderCommand(CLI::App& app, Work& chosen);
void addBenchCommand(CLI::App& app, Work& chosen);
void addVerifyCommand(CLI::App& app, Work& chosen);
void addCompareCommand(CLI::App& app, Work& chosen);
void addDevicesCommand(CLI::App& app, Work& chosen);
void addScenesCommand(CLI::App& app, Work& chosen);
void addSettingsCommand(CLI::App& app, Work& chosen);

}  // namespace gnomon::app
