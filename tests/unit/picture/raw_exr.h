#pragma once
// EXR files byte by byte, as "OpenEXR File Layout" has them: what no library would write.

#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace gnomon::renderer {

inline std::string littleEndian(std::uint64_t value, std::size_t bytes) {
    std::string out;
    for (std::size_t i = 0; i < bytes; ++i, value >>= 8) out += static_cast<char>(value & 0xFF);
    return out;
}

inline std::string floatBytes(float value) {
    return littleEndian(std::bit_cast<std::uint32_t>(value), 4);
}

/// A picture of 2x3 floats in a channel Z, from 0 to 5, uncompressed; to be changed and spoilt.
struct RawExr {
    std::uint32_t version = 2;
    std::vector<std::pair<std::string, std::uint32_t>> channels = {{"Z", 2}};  // 0 whole numbers, 1 half, 2 float
    std::uint32_t sampling = 1;
    std::int32_t left = 0, top = 0, right = 1, bottom = 2;
    std::uint8_t compression = 0, lineOrder = 0;
    std::string more;                 // attributes
    std::vector<std::string> blocks;  // in the order of the table; empty: the floats
    std::vector<std::int32_t> lines;  // that the blocks name; empty: top, top + 1 ...
    bool storedBackwards = false;     // the last block of the table comes first

    static std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
        return name + '\0' + type + '\0' + littleEndian(value.size(), 4) + value;
    }

    [[nodiscard]] std::string header() const {
        std::string list, window;
        for (const auto& [name, type] : channels)
            list += name + '\0' + littleEndian(type, 4) + littleEndian(0, 4) + littleEndian(sampling, 4) +
                    littleEndian(sampling, 4);
        for (const std::int32_t side : {left, top, right, bottom})
            window += littleEndian(static_cast<std::uint32_t>(side), 4);
        return "\x76\x2f\x31\x01" + littleEndian(version, 4) + attribute("channels", "chlist", list + '\0') +
               attribute("compression", "compression", littleEndian(compression, 1)) +
               attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window) +
               attribute("lineOrder", "lineOrder", littleEndian(lineOrder, 1)) +
               attribute("pixelAspectRatio", "float", floatBytes(1.0f)) +
               attribute("screenWindowCenter", "v2f", floatBytes(0.0f) + floatBytes(0.0f)) +
               attribute("screenWindowWidth", "float", floatBytes(1.0f)) + more + '\0';
    }

    [[nodiscard]] std::string bytes() const {
        std::vector<std::string> stored = blocks;
        if (stored.empty())
            for (const float x : {0.0f, 2.0f, 4.0f}) stored.push_back(floatBytes(x) + floatBytes(x + 1.0f));
        const std::size_t count = stored.size();
        std::string out = header();
        std::vector<std::uint64_t> offsets(count);
        std::string chunks;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t i = storedBackwards ? count - 1 - k : k;
            const std::int32_t line = lines.empty() ? top + static_cast<std::int32_t>(i) : lines[i];
            offsets[i] = out.size() + 8 * count + chunks.size();
            chunks += littleEndian(static_cast<std::uint32_t>(line), 4) + littleEndian(stored[i].size(), 4) + stored[i];
        }
        for (const std::uint64_t offset : offsets) out += littleEndian(offset, 8);
        return out + chunks;
    }
};

}  // namespace gnomon::renderer
