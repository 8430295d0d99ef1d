#include "scene/gltf_bytes.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>

#include "scene/gltf_document.h"

namespace gnomon::renderer::gltf {
namespace {

constexpr std::uint64_t kMaxFileBytes = 0xFFFFFFFFull;
constexpr int kMaxNesting = 200;  // deepest seen in real files: 12
constexpr std::uint32_t kChunkJson = 0x4E4F534A, kChunkBinary = 0x004E4942;

std::uint32_t littleEndian32(std::span<const std::uint8_t> bytes, std::size_t offset) {
    return std::uint32_t(bytes[offset]) | std::uint32_t(bytes[offset + 1]) << 8 |
           std::uint32_t(bytes[offset + 2]) << 16 | std::uint32_t(bytes[offset + 3]) << 24;
}

int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::string percentDecoded(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool escape =
            text[i] == '%' && i + 2 < text.size() && hexDigit(text[i + 1]) >= 0 && hexDigit(text[i + 2]) >= 0;
        if (escape) {
            out.push_back(static_cast<char>(hexDigit(text[i + 1]) * 16 + hexDigit(text[i + 2])));
            i += 2;
        } else {
            out.push_back(text[i]);
        }
    }
    return out;
}

int base64Digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+' || c == '-') return 62;
    if (c == '/' || c == '_') return 63;
    return -1;
}

std::optional<std::vector<std::uint8_t>> base64Decoded(std::string_view text) {
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    if (text.size() % 4 == 1) return std::nullopt;
    std::vector<std::uint8_t> out;
    out.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int count = 0;
    for (char c : text) {
        const int digit = base64Digit(c);
        if (digit < 0) return std::nullopt;
        bits = (bits << 6 | static_cast<std::uint32_t>(digit)) & 0xFFFFFF;
        count += 6;
        if (count >= 8) {
            count -= 8;
            out.push_back(static_cast<std::uint8_t>(bits >> count));
        }
    }
    return out;
}

}  // namespace

std::vector<std::uint8_t> readFile(const std::filesystem::path& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (error || !std::filesystem::exists(status)) refuse("there is no file '{}'", path.string());
    if (!std::filesystem::is_regular_file(status)) refuse("'{}' is not a regular file", path.string());
    const std::uint64_t size = std::filesystem::file_size(path, error);
    if (error) refuse("the size of '{}' cannot be read", path.string());
    if (size > kMaxFileBytes) refuse("'{}' holds {} bytes, more than the 4 GiB that are read", path.string(), size);
    std::vector<std::uint8_t> bytes(size);
    std::ifstream stream(path, std::ios::binary);
    if (!stream || !stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size)))
        refuse("'{}' cannot be read", path.string());
    return bytes;
}

Container openContainer(std::span<const std::uint8_t> file) {
    Container container;
    const auto text = [](std::span<const std::uint8_t> bytes) {
        return std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    };
    if (file.empty()) refuse("the file is empty");
    if (file.size() < 4 || std::memcmp(file.data(), "glTF", 4) != 0) {
        container.json = text(file);
        return container;
    }
    if (file.size() < 20) refuse("the GLB file ends within its header");
    const std::uint32_t version = littleEndian32(file, 4), length = littleEndian32(file, 8);
    if (version == 1) refuse("the file is glTF version 1.0; only 2.0 is read");
    if (version != 2) refuse("the GLB container has version {}; only 2 is read", version);
    if (length > file.size()) refuse("the GLB file is truncated: {} of {} bytes are there", file.size(), length);
    if (length < 20) refuse("the GLB header gives a length of {} bytes", length);
    file = file.first(length);
    bool first = true;
    for (std::size_t offset = 12; offset + 8 <= file.size();) {
        const std::uint32_t chunkBytes = littleEndian32(file, offset), type = littleEndian32(file, offset + 4);
        offset += 8;
        if (chunkBytes > file.size() - offset) refuse("a chunk of the GLB file runs past the file's end");
        if (first != (type == kChunkJson))
            refuse("the GLB file must hold one JSON chunk, and it must be the first chunk");
        if (first) container.json = text(file.subspan(offset, chunkBytes));
        if (type == kChunkBinary && !container.binary) container.binary = file.subspan(offset, chunkBytes);
        first = false;
        offset += std::min<std::size_t>((std::size_t(chunkBytes) + 3) & ~std::size_t(3), file.size() - offset);
    }
    return container;
}

bool isDataUri(std::string_view uri) {
    return uri.starts_with("data:");
}

std::optional<std::vector<std::uint8_t>> decodeDataUri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (!isDataUri(uri) || comma == std::string_view::npos) return std::nullopt;
    const std::string_view payload = uri.substr(comma + 1);
    if (uri.substr(0, comma).ends_with(";base64")) return base64Decoded(payload);
    const std::string plain = percentDecoded(payload);
    return std::vector<std::uint8_t>(plain.begin(), plain.end());
}

std::filesystem::path resolveUri(const std::filesystem::path& folder, std::string_view uri) {
    const std::size_t colon = uri.find(':');
    // One letter before a colon is a Windows drive.
    if (colon != std::string_view::npos && colon > 1 && colon < uri.find_first_of("/?#"))
        refuse("'{}' is not a file of this machine, and nothing is fetched", uri.substr(0, 80));
    const std::string decoded = percentDecoded(uri);
    if (decoded.empty() || decoded.find('\0') != std::string::npos) refuse("a file name is empty or holds a zero byte");
    return folder / std::filesystem::path(std::u8string(decoded.begin(), decoded.end()));
}

void checkNesting(std::string_view json) {
    int depth = 0;
    bool inString = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (inString) {
            if (c == '\\') ++i;
            if (c == '"') inString = false;
        } else if (c == '"') {
            inString = true;
        } else if (c == '{' || c == '[') {
            if (++depth > kMaxNesting) refuse("the JSON is nested more than {} levels deep", kMaxNesting);
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
}

}  // namespace gnomon::renderer::gltf
