#pragma once
// Whole files in and out, so that a reader of a picture never sees half of one.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace gnomon::renderer {

/// Writes beside the file first and renames then: the file is the old or the new one, never a part. Throws
/// std::runtime_error with one sentence.
void replaceFile(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

/// The bytes of a regular file of at most `mostBytes`. Throws std::runtime_error with one sentence.
std::vector<std::uint8_t> readWholeFile(const std::filesystem::path& file, std::uint64_t mostBytes);

}  // namespace gnomon::renderer
