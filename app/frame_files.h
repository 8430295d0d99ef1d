#pragma once
// What `render` writes of a frame beside its picture: depth, normals and the visibility of lights, as EXR files of
// 32-bit floats. docs/pictures.md says what stands in them.

#include <cstdint>
#include <string>
#include <vector>

#include "app/session.h"

namespace CLI {
class App;
}

namespace gnomon::app {

/// Lights in one file of visibility.
inline constexpr std::size_t kMostVisibilityLights = 64;

/// Names of files; empty: not wanted.
struct FrameFiles {
    std::string depth, normals, visibility;
};

void addFrameFiles(CLI::App& command, FrameFiles& files);
std::vector<std::string> namesOf(const FrameFiles& files);
/// Throws UsageError where a name or the way of shadowing is wrong. `shadows` as shadowModeOf() takes it.
void checkFrameFiles(const FrameFiles& files, const std::string& shadows);

/// The lights whose visibility is to be written, each once, by their index in the scene: those that --light names, or
/// all. Empty where none is wanted. Throws UsageError where they are too many, or the scene has none.
std::vector<std::uint32_t> visibilityLights(const FrameFiles& files, const Session& session);

/// Of the renderer's last frame.
void writeFrameFiles(renderer::Renderer& renderer, const FrameFiles& files, const std::vector<std::uint32_t>& lights);

}  // namespace gnomon::app
