#pragma once
// A glTF file taken apart. tinygltf turns the JSON into structs; the bytes never pass through it.
//
// Buffers are read on first use. So a broken part which nothing drawn refers to does no harm, and every byte range has
// one check. Inside the loader a refusal is an exception with the sentence for the user. loadGltf() alone catches it.

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace gnomon::renderer::gltf {

struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

template <class... Arguments>
[[noreturn]] void refuse(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    throw Refusal(fmt::format(format, std::forward<Arguments>(arguments)...));
}

/// The element an index of the file refers to, or a refusal that says who pointed where.
template <class T>
const T& at(const std::vector<T>& all, int index, std::string_view kind, std::string_view user) {
    if (index < 0 || static_cast<std::size_t>(index) >= all.size())
        refuse("{} refers to {} {}, but the file has {}", user, kind, index, all.size());
    return all[static_cast<std::size_t>(index)];
}

/// A JSON number as a float, or a refusal when it does not fit.
inline double inFloatRange(double value, std::string_view what) {
    if (!(std::abs(value) <= 3.0e38)) refuse("{} is {}, beyond what a float holds", what, value);
    return value;
}
inline float toFloat(double value, std::string_view what) {
    return static_cast<float>(inFloatRange(value, what));
}

/// Member of an extension's object, or null.
const tinygltf::Value* member(const tinygltf::Value& object, const char* name);
/// Extension of an element, or null when it is absent or no object.
const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions, const char* name);
/// A number or number array from an extension; the default when absent, a refusal when it is something else.
double number(const tinygltf::Value& object, const char* name, double otherwise, std::string_view what);
int integer(const tinygltf::Value& object, const char* name, int otherwise, std::string_view what);
std::vector<double> numbers(const tinygltf::Value& object, const char* name, std::vector<double> otherwise,
                            std::string_view what);

struct ImageSource {
    std::string name, uri;
    int bufferView = -1;
};

/// As written: types are right, but indices may point nowhere. An absent one is -1.
struct AnimationSource {
    struct Sampler {
        int input = -1, output = -1;
        std::string interpolation;
    };
    struct Channel {
        int sampler = -1, node = -1;
        std::string path;
    };
    std::string name;
    std::vector<Sampler> samplers;
    std::vector<Channel> channels;
};

struct BytesOfView {
    std::span<const std::uint8_t> bytes;
    std::size_t stride = 0;  // 0: tightly packed
};

class Document {
public:
    /// Reads and checks the container and the JSON; refuses extensions that the loader lacks.
    explicit Document(const std::filesystem::path& path);

    const tinygltf::Model& model() const { return model_; }
    const std::vector<ImageSource>& images() const { return images_; }
    const std::vector<AnimationSource>& animations() const { return animations_; }

    /// Counts what morph targets and animations are about to hold, because many of them may share the same bytes.
    void spendMotionNumbers(std::size_t count);

    /// The same for accessors without a bufferView, which no bytes of the file vouch for.
    void spendUnbackedElements(std::size_t count, std::string_view user);

    /// The bytes of a bufferView after all checks. They live as long as the document.
    BytesOfView view(int bufferView, std::string_view user);
    /// Encoded bytes of an image, or nothing and a note. `storage` keeps bytes that the document itself does not hold.
    std::span<const std::uint8_t> encodedImage(int image, std::vector<std::uint8_t>& storage);

    /// Adds a sentence to the scene's notes; repeats and floods are held back.
    void note(std::string sentence);
    std::vector<std::string> takeNotes();

private:
    struct BufferSource {
        std::string uri;
        std::uint64_t byteLength = 0;
        bool loaded = false;
        std::vector<std::uint8_t> storage;
        std::span<const std::uint8_t> bytes;
    };

    void parse(std::string_view json);
    void checkExtensions();
    std::span<const std::uint8_t> bufferBytes(int index, std::string_view user);

    std::filesystem::path folder_;
    std::vector<std::uint8_t> file_;
    std::optional<std::span<const std::uint8_t>> binaryChunk_;
    tinygltf::Model model_;
    std::vector<BufferSource> buffers_;
    std::vector<ImageSource> images_;
    std::vector<AnimationSource> animations_;
    std::size_t motionNumbers_ = 0, unbackedElements_ = 0;
    std::vector<std::string> notes_;
    std::unordered_set<std::string> noted_;
    std::size_t heldBack_ = 0;
};

}  // namespace gnomon::renderer::gltf
