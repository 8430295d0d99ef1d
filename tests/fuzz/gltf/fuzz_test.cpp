// Mutated files through loader, poses and truth: each is refused with a sentence, or sound. Under the sanitizers.
//     GNOMON_FUZZ_CASES=100000 GNOMON_FUZZ_SEED=7 fuzz_gltf_tests
// A case that crashes or hangs lies in the folder that is printed first.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "fuzz/gltf/mutation.h"
#include "fuzz/gltf/one_case.h"

namespace gnomon::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kLongestSeconds = 120;  // for one case, on a busy machine under sanitizers: else it hangs

std::uint64_t numberFrom(const char* variable, std::uint64_t otherwise) {
    const char* text = std::getenv(variable);
    return text != nullptr ? std::strtoull(text, nullptr, 10) : otherwise;
}

std::vector<nlohmann::json> corpus() {
    std::vector<nlohmann::json> out;
    for (const fs::directory_entry& entry : fs::directory_iterator(GNOMON_SOURCE_DIR "/tests/fuzz/gltf/corpus"))
        out.push_back(nlohmann::json::parse(std::ifstream(entry.path())));
    std::ranges::sort(out, {}, [](const nlohmann::json& file) { return file.dump(); });
    return out;
}

struct Folder {
    fs::path path = fs::path(testing::TempDir()) / ("gnomon_fuzz_" + std::to_string(getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
};

TEST(FuzzGltf, FilesOfTheCorpusAreGood) {
    const Folder folder;
    ASSERT_GE(corpus().size(), 3u);
    for (const nlohmann::json& file : corpus()) {
        std::ofstream(folder.path / "good.gltf") << file;
        const Outcome outcome = runCase(folder.path / "good.gltf");
        EXPECT_TRUE(outcome.loaded && outcome.posed && outcome.traced) << file.dump().substr(0, 200);
        EXPECT_EQ(outcome.fault, "");
    }
}

TEST(FuzzGltf, MutatedFiles) {
    const std::uint64_t cases = numberFrom("GNOMON_FUZZ_CASES", 3000), first = numberFrom("GNOMON_FUZZ_SEED", 1);
    const std::vector<nlohmann::json> files = corpus();
    const Folder folder;
    std::printf("[ cases    ] in %s\n", folder.path.c_str());
    std::uint64_t loaded = 0, traced = 0;
    for (std::uint64_t i = 0; i < cases; ++i) {
        Random random((first << 32) + i);
        const std::string text =
            mutated(files[i % files.size()], random).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
        const fs::path file = folder.path / "case.gltf";
        std::ofstream(file, std::ios::binary) << text;
        alarm(kLongestSeconds);
        const Outcome outcome = runCase(file);
        alarm(0);
        loaded += outcome.loaded ? 1 : 0;
        traced += outcome.traced ? 1 : 0;
        ASSERT_EQ(outcome.fault, "") << "case " << i << " of seed " << first << ":\n" << text;
    }
    std::printf("[ cases    ] %llu, of which %llu load and %llu are traced\n", static_cast<unsigned long long>(cases),
                static_cast<unsigned long long>(loaded), static_cast<unsigned long long>(traced));
    EXPECT_GT(loaded, cases / 10) << "mutations are too coarse to get past the loader";
    EXPECT_GT(loaded, traced / 2);
    EXPECT_LT(loaded, cases * 9 / 10) << "mutations are too fine to be refused";
}

}  // namespace
}  // namespace gnomon::fuzz
