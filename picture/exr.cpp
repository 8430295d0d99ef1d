#include "picture/exr.h"

#include <fmt/format.h>
#include <tinyexr.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <span>
#include <stdexcept>

#include "picture/files.h"

namespace gnomon::renderer {
namespace {

constexpr std::size_t kRgba = 4;
constexpr std::array<const char*, kRgba> kRgbaNames = {"A", "B", "G", "R"};  // EXR wants them in alphabetical order

float withinHalf(float value) {
    return std::isnan(value) ? value : std::clamp(value, -kBrightestHalf, kBrightestHalf);
}

ExrPicture channelsOf(const HdrPicture& picture, ExrType type) {
    ExrPicture out{picture.width, picture.height, {}};
    const std::size_t pixels = std::size_t{picture.width} * picture.height;
    for (std::size_t c = 0; c < kRgba; ++c) {
        std::vector<float> values(pixels);
        for (std::size_t i = 0; i < pixels; ++i) {
            const float value = picture.rgba[kRgba * i + (kRgba - 1 - c)];
            values[i] = type == ExrType::Half ? withinHalf(value) : value;
        }
        out.channels.push_back({kRgbaNames[c], std::move(values), {}});
    }
    return out;
}

std::vector<const ExrChannel*> inOrder(const ExrPicture& picture) {
    std::vector<const ExrChannel*> sorted;
    for (const ExrChannel& channel : picture.channels) sorted.push_back(&channel);
    std::ranges::sort(sorted, {}, [](const ExrChannel* channel) { return channel->name; });
    return sorted;
}

EXRChannelInfo namedChannel(const std::string& name) {
    EXRChannelInfo info{};
    std::copy_n(name.begin(), std::min(name.size(), std::size(info.name) - 1), info.name);
    return info;
}

void encode(const ExrPicture& picture, const std::filesystem::path& file, ExrType type) {
    std::vector<unsigned char*> pointers;
    std::vector<EXRChannelInfo> channels;
    for (const ExrChannel* channel : inOrder(picture)) {
        // It is read alone; the interface of tinyexr has no const.
        pointers.push_back(reinterpret_cast<unsigned char*>(const_cast<float*>(channel->values.data())));
        channels.push_back(namedChannel(channel->name));
    }
    std::vector<int> given(channels.size(), TINYEXR_PIXELTYPE_FLOAT);
    std::vector<int> wanted(channels.size(), type == ExrType::Half ? TINYEXR_PIXELTYPE_HALF : TINYEXR_PIXELTYPE_FLOAT);
    EXRHeader header;
    InitEXRHeader(&header);
    header.num_channels = static_cast<int>(channels.size());
    header.channels = channels.data();
    header.pixel_types = given.data();
    header.requested_pixel_types = wanted.data();
    header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
    EXRImage image;
    InitEXRImage(&image);
    image.num_channels = header.num_channels;
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

}  // namespace

void writeExr(const HdrPicture& picture, const std::filesystem::path& file, ExrType type) {
    encode(channelsOf(picture, type), file, type);
}

void writeExr(const ExrPicture& picture, const std::filesystem::path& file) {
    encode(picture, file, ExrType::Float);
}

}  // namespace gnomon::renderer
