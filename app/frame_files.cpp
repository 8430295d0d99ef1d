#include "app/frame_files.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <numeric>

#include "app/errors.h"
#include "app/option_checks.h"
#include "picture/exr.h"

namespace gnomon::app {
namespace {

renderer::ExrPicture emptyPicture(const renderer::FrameSettings& frame) {
    return {frame.widthPx, frame.heightPx, {}};
}

void writeDepth(renderer::Renderer& renderer, const std::string& file) {
    renderer::ExrPicture picture = emptyPicture(renderer.settings());
    picture.channels.push_back({"Z", renderer.readDepth(), {}});
    renderer::writeExr(picture, file);
}

void writeNormals(renderer::Renderer& renderer, const std::string& file) {
    renderer::ExrPicture picture = emptyPicture(renderer.settings());
    const std::vector<glm::vec3> normals = renderer.readNormals();
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<float> values;
        values.reserve(normals.size());
        for (const glm::vec3& normal : normals) values.push_back(normal[axis]);
        picture.channels.push_back({std::string(1, "XYZ"[axis]), std::move(values), {}});
    }
    renderer::writeExr(picture, file);
}

void writeVisibility(renderer::Renderer& renderer, const std::string& file, const std::vector<std::uint32_t>& lights) {
    renderer::ExrPicture picture = emptyPicture(renderer.settings());
    for (const std::uint32_t light : lights)
        picture.channels.push_back({fmt::format("light{}", light), renderer.readVisibility(light), {}});
    renderer::writeExr(picture, file);
}

}  // namespace

void addFrameFiles(CLI::App& command, FrameFiles& files) {
    command
        .add_option("--depth-exr", files.depth,
                    "Distances along the view axis, of the last frame, an EXR file: channel Z, infinite at background")
        ->check(fileName());
    command
        .add_option("--normals-exr", files.normals,
                    "Shading normals in world space, of the last frame, an EXR file: channels X, Y and Z, 0 at "
                    "background")
        ->check(fileName());
    command
        .add_option("--visibility-exr", files.visibility,
                    fmt::format("Shadows of each light, of the last frame, an EXR file: channels light0, light1 and so "
                                "on, 0 dark to 1 lit, -1 where the light does not reach; --shadows deferred, and {} "
                                "lights at most, see --light",
                                kMostVisibilityLights))
        ->check(fileName());
}

std::vector<std::string> namesOf(const FrameFiles& files) {
    return {files.depth, files.normals, files.visibility};
}

void checkFrameFiles(const FrameFiles& files, const std::string& shadows) {
    for (const std::string& file : namesOf(files)) requireExtension(file, ".exr");
    if (!files.visibility.empty() && shadows != "deferred")
        throw UsageError("--visibility-exr goes with --shadows deferred alone: no other way stores it.");
}

std::vector<std::uint32_t> visibilityLights(const FrameFiles& files, const Session& session) {
    if (files.visibility.empty()) return {};
    std::vector<std::uint32_t> lights = session.settings().onlyLights;
    if (lights.empty()) {
        lights.resize(session.scene().lights.size());
        std::iota(lights.begin(), lights.end(), 0u);
    }
    std::ranges::sort(lights);
    lights.erase(std::ranges::unique(lights).begin(), lights.end());
    if (lights.empty()) throw UsageError("--visibility-exr has nothing to write: the scene has no light.");
    if (lights.size() > kMostVisibilityLights)
        throw UsageError(
            fmt::format("--visibility-exr writes {} lights at most and here are {}: choose some with --light.",
                        kMostVisibilityLights, lights.size()));
    const renderer::FrameSettings& frame = session.rendererDesc().frame;
    const std::uint64_t pixels = std::uint64_t{frame.widthPx} * frame.heightPx;
    if (pixels > renderer::kMostExrValues / lights.size())
        throw UsageError(fmt::format(
            "--visibility-exr writes {} lights at most of a picture of {}x{} pixels: choose some with --light.",
            renderer::kMostExrValues / pixels, frame.widthPx, frame.heightPx));
    return lights;
}

void writeFrameFiles(renderer::Renderer& renderer, const FrameFiles& files, const std::vector<std::uint32_t>& lights) {
    if (!files.depth.empty()) writeDepth(renderer, files.depth);
    if (!files.normals.empty()) writeNormals(renderer, files.normals);
    if (!files.visibility.empty()) writeVisibility(renderer, files.visibility, lights);
}

}  // namespace gnomon::app
