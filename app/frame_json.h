#pragma once
// One frame as JSON, for machines.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "app/frame_table.h"

namespace gnomon::app {

using Json = nlohmann::ordered_json;

/// Program, device, scene and every setting: what a measurement must state.
Json describe(const Session& session);
/// Phase and kind of a pass: "compute", "drawing" or "transfer".
Json sortOf(Phase phase, RowKind kind);
Json countersOf(const FrameResult& result);
Json describe(const Session& session, const FrameResult& result);
/// "point", "spot" or "directional".
const char* nameOf(renderer::LightKind kind);
void writeJson(const Json& json, const std::filesystem::path& file);

}  // namespace gnomon::app
