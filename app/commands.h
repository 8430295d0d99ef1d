#pragma once
// The subcommands. Each adds itself to the command line. Parsing sets `chosen` to the work of the one that is used. The
// work returns the exit code.

#include <functional>

namespace CLI {
class App;
}

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
