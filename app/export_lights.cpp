#include "app/export_lights.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <vector>

#include "app/errors.h"
#include "app/option_checks.h"
#include "app/progress.h"
#include "picture/files.h"
#include "scene/lights_as_gltf.h"
#include "scene/pose.h"

namespace gnomon::app {

void addExportLights(CLI::App& command, std::string& file) {
    command
        .add_option("--export-lights", file,
                    "All lights of the picture, scattered ones too, as a glTF file with KHR_lights_punctual")
        ->check(fileName());
}

void exportLights(const Session& session, const std::string& file, double timeSeconds,
                  const std::vector<std::uint32_t>& only) {
    if (file.empty()) return;
    const std::vector<renderer::SceneLight> posed = renderer::poseAt(session.scene(), timeSeconds).lights;
    std::vector<renderer::SceneLight> lights;
    for (std::uint32_t i = 0; i < posed.size(); ++i)
        if (only.empty() || std::ranges::find(only, i) != only.end()) lights.push_back(posed[i]);
    if (lights.empty()) throw UsageError("There is no light to export.");
    const std::string text = renderer::lightsAsGltf(lights, session.scene().origin);
    renderer::replaceFile(file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    sayProgress(fmt::format("Exported {} light{} to {}.", lights.size(), lights.size() == 1 ? "" : "s", file));
}

}  // namespace gnomon::app
