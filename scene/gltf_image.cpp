#include <algorithm>
#include <cstring>
#include <memory>

#include "scene/gltf_material.h"

#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb/stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace gnomon::renderer::gltf {

std::uint64_t imagePixels(std::span<const std::uint8_t> encoded) {
    int width = 0, height = 0, channels = 0;
    if (encoded.size() > 0x7FFFFFFF) return 0;
    if (!stbi_info_from_memory(encoded.data(), static_cast<int>(encoded.size()), &width, &height, &channels)) return 0;
    return width > 0 && height > 0 ? std::uint64_t(width) * std::uint64_t(height) : 0;
}

bool decodeImage(std::span<const std::uint8_t> encoded, bool mirrorU, bool mirrorV, Image& out, std::string& reason) {
    if (encoded.size() > 0x7FFFFFFF) {
        reason = "it is larger than 2 GiB";
        return false;
    }
    int width = 0, height = 0, channels = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(encoded.data(), static_cast<int>(encoded.size()), &width, &height, &channels, 4),
        stbi_image_free);
    if (!pixels || width <= 0 || height <= 0) {
        const char* why = stbi_failure_reason();
        reason = why ? std::string("it is no PNG or JPEG that can be read (") + why + ")"
                     : "it is no PNG or JPEG that can be read";
        return false;
    }
    const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
    const std::size_t outWidth = mirrorU ? 2 * w : w, outHeight = mirrorV ? 2 * h : h;
    out.width = static_cast<std::uint32_t>(outWidth);
    out.height = static_cast<std::uint32_t>(outHeight);
    out.rgba8.resize(outWidth * outHeight * 4);
    for (std::size_t y = 0; y < outHeight; ++y) {
        const stbi_uc* row = pixels.get() + (y < h ? y : 2 * h - 1 - y) * w * 4;
        std::uint8_t* target = out.rgba8.data() + y * outWidth * 4;
        std::memcpy(target, row, w * 4);
        for (std::size_t x = w; x < outWidth; ++x) std::memcpy(target + x * 4, row + (2 * w - 1 - x) * 4, 4);
    }
    return true;
}

}  // namespace gnomon::renderer::gltf
