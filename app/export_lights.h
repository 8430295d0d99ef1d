#pragma once
// --export-lights: the lights of a frame as a glTF file, for engines and other renderers.

#include <cstdint>
#include <string>
#include <vector>

#include "app/session.h"

namespace CLI {
class App;
}

namespace gnomon::app {

/// Sets `file`, which stays empty without the option. Its name must end in .gltf.
void addExportLights(CLI::App& command, std::string& file);

/// Every light of the scene at that time, scattered ones too, or `only` these of them; nothing for an empty name.
/// Throws UsageError where there is no light.
void exportLights(const Session& session, const std::string& file, double timeSeconds,
                  const std::vector<std::uint32_t>& only);

}  // namespace gnomon::app
