#include <fmt/format.h>

#include <memory>
#include <stdexcept>

#include "picture/files.h"
#include "picture/picture.h"

#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace gnomon::renderer {
namespace {

constexpr std::uint64_t kMostPngBytes = 1u << 30;  // stb counts bytes in an int

void append(void* context, void* data, int size) {
    auto& bytes = *static_cast<std::vector<std::uint8_t>*>(context);
    const auto* begin = static_cast<const std::uint8_t*>(data);
    bytes.insert(bytes.end(), begin, begin + size);
}

}  // namespace

void writePng(const Picture& picture, const std::filesystem::path& file) {
    const int width = static_cast<int>(picture.width), height = static_cast<int>(picture.height);
    std::vector<std::uint8_t> bytes;
    if (picture.rgb.size() > kMostPngBytes ||
        !stbi_write_png_to_func(append, &bytes, width, height, 3, picture.rgb.data(), 3 * width))
        throw std::runtime_error(fmt::format("'{}' could not be encoded as PNG.", file.string()));
    replaceFile(file, bytes);
}

Picture readPng(const std::filesystem::path& file) {
    const std::vector<std::uint8_t> bytes = readWholeFile(file, kMostPngBytes);
    int width = 0, height = 0, channels = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width, &height, &channels, 3),
        stbi_image_free);
    if (!pixels) throw std::runtime_error(fmt::format("'{}' is no PNG picture that can be read.", file.string()));
    Picture picture{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
    picture.rgb.assign(pixels.get(), pixels.get() + std::size_t{3} * picture.width * picture.height);
    return picture;
}

}  // namespace gnomon::renderer
