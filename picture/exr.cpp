#include <fmt/format.h>
#include <tinyexr.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>

#include "picture/files.h"
#include "picture/picture.h"

namespace gnomon::renderer {
namespace {

constexpr int kChannels = 4;
constexpr std::array<char, kChannels> kChannelNames = {'A', 'B', 'G', 'R'};  // EXR wants them in alphabetical order

std::array<std::vector<float>, kChannels> planesOf(const HdrPicture& picture) {
    std::array<std::vector<float>, kChannels> planes;
    const std::size_t pixels = std::size_t{picture.width} * picture.height;
    for (std::size_t c = 0; c < kChannels; ++c) {
        planes[c].resize(pixels);
        for (std::size_t i = 0; i < pixels; ++i) {
            const float value = picture.rgba[kChannels * i + (kChannels - 1 - c)];
            planes[c][i] = std::isnan(value) ? value : std::clamp(value, -kBrightest, kBrightest);
        }
    }
    return planes;
}

}  // namespace

void writeExr(const HdrPicture& picture, const std::filesystem::path& file) {
    std::array<std::vector<float>, kChannels> planes = planesOf(picture);
    std::array<unsigned char*, kChannels> pointers{};
    std::array<EXRChannelInfo, kChannels> channels{};
    std::array<int, kChannels> given{}, wanted{};
    for (std::size_t c = 0; c < kChannels; ++c) {
        pointers[c] = reinterpret_cast<unsigned char*>(planes[c].data());
        channels[c].name[0] = kChannelNames[c];
        given[c] = TINYEXR_PIXELTYPE_FLOAT;
        wanted[c] = TINYEXR_PIXELTYPE_HALF;
    }
    EXRHeader header;
    InitEXRHeader(&header);
    header.num_channels = kChannels;
    header.channels = channels.data();
    header.pixel_types = given.data();
    header.requested_pixel_types = wanted.data();
    header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
    EXRImage image;
    InitEXRImage(&image);
    image.num_channels = kChannels;
    image.images = pointers.data();
    image.width = static_cast<int>(picture.width);
    image.height = static_cast<int>(picture.height);

    unsigned char* encoded = nullptr;
    const char* error = nullptr;
    const std::size_t size = SaveEXRImageToMemory(&image, &header, &encoded, &error);
    const std::unique_ptr<unsigned char, void (*)(void*)> owner(encoded, std::free);
    if (error != nullptr) FreeEXRErrorMessage(error);
    if (size == 0) throw std::runtime_error(fmt::format("'{}' could not be encoded as EXR.", file.string()));
    replaceFile(file, std::span<const std::uint8_t>(encoded, size));
}

}  // namespace gnomon::renderer
