#pragma once
// What an EXR file says that it holds, looked over before a decoder believes it.
//
// Problem: a damaged or hostile file sends a decoder to rows that are not there, or has it take memory for pixels that
// no file of that length can hold.
// Source: "OpenEXR File Layout", openexr.com.
// Plain way: hand the file to tinyexr, which ends the program on some files, reads past the end of others, and leaves
// rows unwritten where a file holds a row twice.
// Here: header and chunk table are read once before, and everything is refused that is not a whole, single picture of
// scan lines.
// Limits: pixels are not decoded here, so damage within a compressed block is left for the decoder to find. PIZ is
// refused, because tinyexr decodes it without looking at where its input ends.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace gnomon::renderer {

struct ExrLayout {
    struct Channel {
        std::string name;
        std::int32_t type = 0;  // TINYEXR_PIXELTYPE_...
    };
    std::vector<Channel> channels;  // as the file has them
    std::int32_t left = 0, top = 0;
    std::uint32_t width = 0, height = 0;
    std::uint8_t compression = 0;  // TINYEXR_COMPRESSIONTYPE_...
    std::size_t chunkTable = 0;    // where it begins
};

/// Every block of scan lines is there, once, in its place, and long enough for what it is to hold. Throws
/// std::runtime_error with the rest of a sentence that begins with the file's name: "is damaged or cut off".
ExrLayout checkedExrLayout(std::span<const std::uint8_t> file);

}  // namespace gnomon::renderer
