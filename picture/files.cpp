#include "picture/files.h"

#include <fmt/format.h>

#include <fstream>
#include <random>
#include <stdexcept>
#include <string>
#include <system_error>

#include "picture/picture.h"

namespace gnomon::renderer {
namespace {

namespace fs = std::filesystem;

// Renaming replaces a link itself, so links are followed first. Devices and folders are refused: a rename would put a
// file in the place of /dev/null.
fs::path destinationOf(const fs::path& file) {
    std::error_code error;
    if (file.filename().empty()) throw std::runtime_error(fmt::format("'{}' names no file.", file.string()));
    const fs::file_status status = fs::status(file, error);
    if (fs::exists(status) && !fs::is_regular_file(status))
        throw std::runtime_error(fmt::format("'{}' cannot be written: it is no regular file.", file.string()));
    const fs::path destination = fs::weakly_canonical(fs::absolute(file), error);
    const fs::path folder = error ? fs::path() : destination.parent_path();
    if (folder.empty() || !fs::is_directory(folder, error))
        throw std::runtime_error(fmt::format("'{}' cannot be written: its folder does not exist.", file.string()));
    return destination;
}

fs::path temporaryBeside(const fs::path& destination) {
    std::random_device random;
    fs::path temporary = destination;
    temporary += fmt::format(".{:08x}.part", random());
    return temporary;
}

}  // namespace

void checkWritable(const fs::path& file) {
    const fs::path probe = temporaryBeside(destinationOf(file));
    const bool written = std::ofstream(probe, std::ios::binary).put('\0').flush().good();
    std::error_code error;
    fs::remove(probe, error);
    if (!written)
        throw std::runtime_error(fmt::format("'{}' cannot be written: its folder takes no new files.", file.string()));
}

void replaceFile(const fs::path& file, std::span<const std::uint8_t> bytes) {
    const fs::path destination = destinationOf(file);
    const fs::path temporary = temporaryBeside(destination);
    std::ofstream stream(temporary, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    std::error_code error;
    if (stream.good()) fs::rename(temporary, destination, error);
    if (stream.good() && !error) return;
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw std::runtime_error(fmt::format("'{}' could not be written: {}.", file.string(),
                                         error ? error.message() : "the folder is read-only or the disk is full"));
}

std::vector<std::uint8_t> readWholeFile(const fs::path& file, std::uint64_t mostBytes) {
    std::error_code error;
    if (!fs::exists(file, error)) throw std::runtime_error(fmt::format("'{}' does not exist.", file.string()));
    if (!fs::is_regular_file(file, error))
        throw std::runtime_error(fmt::format("'{}' is no regular file.", file.string()));
    const std::uintmax_t size = fs::file_size(file, error);
    if (error || size > mostBytes)
        throw std::runtime_error(fmt::format("'{}' is too large to be read.", file.string()));
    std::vector<std::uint8_t> bytes(size);
    std::ifstream stream(file, std::ios::binary);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (!stream || static_cast<std::uintmax_t>(stream.gcount()) != size)
        throw std::runtime_error(fmt::format("'{}' could not be read.", file.string()));
    return bytes;
}

}  // namespace gnomon::renderer
