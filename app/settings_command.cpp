// gnomon settings: the table of settings, as docs/settings.md has it.

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/commands.h"
#include "app/errors.h"
#include "app/settings_table.h"

namespace gnomon::app {

void addSettingsCommand(CLI::App& app, Work& chosen) {
    app.add_subcommand("settings", "List all settings of render, verify and bench")->callback([&chosen] {
        chosen = [] {
            fmt::print("{}", settingsPage());
            return kGood;
        };
    });
}

}  // namespace gnomon::app
