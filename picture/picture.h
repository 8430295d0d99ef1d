#pragma once
// Pictures on the CPU: exposure, tone mapping, PNG files, a hash, comparison. EXR files: picture/exr.h.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gnomon::renderer {

/// The brightest radiance that a picture of half floats holds.
inline constexpr float kBrightestHalf = 65504.0f;

/// Linear Rec. 709, RGBA, rows from the top. Alpha is 0 where there is no geometry, else 1.
struct HdrPicture {
    std::uint32_t width = 0, height = 0;
    std::vector<float> rgba;
    float brightest = kBrightestHalf;  ///< what a channel holds at most, where the picture comes from
};

/// Pixels of which a channel is as bright as the picture holds, so that it may have been brighter.
std::uint64_t clippedPixels(const HdrPicture& picture);

/// sRGB, RGB, rows from the top.
struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

/// EV100 at which the picture's geometric mean luminance becomes a middle grey; black, non-finite and
/// background pixels are left out.
/// Source: Lagarde and de Rousiers 2014, "Moving Frostbite to PBR", section 5.1 (EV100 and saturation-based speed).
float automaticExposure(const HdrPicture& picture);

/// Exposes, compresses with the extended Reinhard curve on luminance (Reinhard et al. 2002, "Photographic Tone
/// Reproduction for Digital Images", equation 4), and encodes as sRGB.
Picture toneMap(const HdrPicture& picture, float exposureEv100);

/// Throws std::runtime_error with one sentence where a file cannot be written there: to be asked before long work.
/// Leaves an existing file as it is.
void checkWritable(const std::filesystem::path& file);

/// Throws std::runtime_error with one sentence where the file cannot be written. An existing file is replaced at once.
void writePng(const Picture& picture, const std::filesystem::path& file);
/// Throws std::runtime_error with one sentence where the file cannot be read.
Picture readPng(const std::filesystem::path& file);

/// XXH3, 64 bits, of extent and pixels, as 16 hexadecimal digits.
std::string hashOf(const Picture& picture);

struct Difference {
    std::uint32_t largest = 0;  ///< of any channel, 0 to 255
    std::uint64_t pixels = 0;   ///< that differ at all
    double meanAbsolute = 0.0;  ///< per channel
};
/// Throws std::invalid_argument where the extents differ.
Difference compare(const Picture& a, const Picture& b);
/// Where two pictures differ: grey where equal, red where not, brighter the more.
Picture differencePicture(const Picture& a, const Picture& b);

}  // namespace gnomon::renderer
