#pragma once
// Files, URIs and the GLB container: everything between the disk and the JSON.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon::renderer::gltf {

/// The whole of a regular file; refuses devices, folders and files beyond 4 GiB (the most a GLB can hold).
std::vector<std::uint8_t> readFile(const std::filesystem::path& path);

struct Container {
    std::string_view json;
    std::optional<std::span<const std::uint8_t>> binary;
};
/// Takes a .glb apart, or takes the whole file for JSON when it lacks the GLB magic.
Container openContainer(std::span<const std::uint8_t> file);

bool isDataUri(std::string_view uri);
/// The payload of a data URI; nothing when it is malformed.
std::optional<std::vector<std::uint8_t>> decodeDataUri(std::string_view uri);
/// The path of a relative or absolute file URI; refuses schemes, because nothing is ever fetched.
std::filesystem::path resolveUri(const std::filesystem::path& folder, std::string_view uri);

/// Refuses JSON nested so deeply that a recursive reader would exhaust the stack.
void checkNesting(std::string_view json);

}  // namespace gnomon::renderer::gltf
