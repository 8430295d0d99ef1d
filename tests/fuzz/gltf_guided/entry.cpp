// The same cases as fuzz_gltf_tests, found by libFuzzer: it keeps the files that reach code no file reached before.
//     cmake --preset fuzz && cmake --build --preset fuzz --target fuzz_gltf_guided
//     build/fuzz/bin/fuzz_gltf_guided -timeout=120 FOUND tests/fuzz/gltf/corpus
// FOUND is a folder of yours: what is new goes there. Nothing is written to the corpus.
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "fuzz/gltf/mutation.h"
#include "fuzz/gltf/one_case.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t mostBytes);

namespace {

constexpr unsigned kOneInBytes = 8;  // so often bytes change in place of glTF's parts

const std::filesystem::path& caseFile() {
    static const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("gnomon_fuzz_guided_" + std::to_string(getpid()) + ".gltf");
    static const bool removed = std::atexit([] { std::filesystem::remove(caseFile()); }) == 0;
    static_cast<void>(removed);
    return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::ofstream(caseFile(), std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    const gnomon::fuzz::Outcome outcome = gnomon::fuzz::runCase(caseFile());
    if (outcome.fault.empty()) return 0;
    std::fprintf(stderr, "%s\n", outcome.fault.c_str());
    std::abort();
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t mostBytes,
                                               unsigned seed) {
    if (seed % kOneInBytes == 0) return LLVMFuzzerMutate(data, size, mostBytes);
    const auto file = nlohmann::json::parse(data, data + size, nullptr, false);
    if (file.is_discarded()) return LLVMFuzzerMutate(data, size, mostBytes);
    gnomon::fuzz::Random random(seed);
    const std::string text =
        gnomon::fuzz::mutated(file, random).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    if (text.size() > mostBytes) return LLVMFuzzerMutate(data, size, mostBytes);
    std::memcpy(data, text.data(), text.size());
    return text.size();
}
