#pragma once
// --export-lights: the lights of a frame as a glTF file, for engines and other renderers.

#include <string>

#include "app/session.h"

namespace CLI {
class App;
}

namespace gnomon::app {

/// Sets `file`, which stays empty without the option. Its name must end in .gltf.
void addExportLights(CLI::App& command, std::string& file);

/// Every light that shines at that time, scattered ones too; nothing for an empty name. Throws UsageError where no
/// light shines.
void exportLights(const Session& session, const std::string& file, double timeSeconds);

}  // namespace gnomon::app
