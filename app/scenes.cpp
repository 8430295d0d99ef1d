#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>

#include "app/commands.h"
#include "app/errors.h"
#include "scene/builtin/builtin.h"

namespace gnomon::app {

void addScenesCommand(CLI::App& app, Work& chosen) {
    app.add_subcommand("scenes", "List the built-in scenes")->callback([&chosen] {
        chosen = [] {
            const std::vector<renderer::BuiltinInfo> scenes = renderer::builtinScenes();
            std::size_t width = 0;
            for (const auto& scene : scenes) width = std::max(width, scene.name.size());
            for (const auto& scene : scenes) fmt::print("{:<{}}  {}\n", scene.name, width, scene.description);
            return kGood;
        };
    });
}

}  // namespace gnomon::app
