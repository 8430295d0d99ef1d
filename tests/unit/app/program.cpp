#include "unit/app/program.h"

#include <sys/wait.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <fstream>
#include <iterator>

namespace gnomon::app {
namespace {

std::string contentsOf(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

Outcome runProgram(const std::filesystem::path& folder, const std::string& arguments) {
    const std::string command =
        "cd '" + folder.string() + "' && '" GNOMON_PROGRAM "' " + arguments + " >stdout.txt 2>stderr.txt </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contentsOf(folder / "stdout.txt"),
            contentsOf(folder / "stderr.txt")};
}

bool isOneSentence(const std::string& text) {
    return text.starts_with("gnomon: ") && text.ends_with(".\n") && std::count(text.begin(), text.end(), '\n') == 1 &&
           text.find(". ") == std::string::npos;
}

std::string dataUri(std::span<const float> numbers) {
    std::string uri = "data:application/octet-stream,";  // percent-encoded
    for (const float number : numbers)
        for (std::uint32_t bits = std::bit_cast<std::uint32_t>(number), i = 0; i < 4; ++i, bits >>= 8) {
            uri += '%';
            for (const std::uint32_t digit : {bits >> 4 & 15u, bits & 15u}) uri += "0123456789abcdef"[digit];
        }
    return uri;
}

void Program::SetUp() {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("gnomon_") + test->test_suite_name() + "_" + test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
}

void Program::TearDown() {
    std::filesystem::remove_all(folder_);
}

void Program::expectGood(const std::string& arguments) const {
    const Outcome result = run(arguments);
    EXPECT_EQ(result.exitCode, 0) << arguments << "\n" << result.out << result.err;
}

void Program::expectRefused(const std::string& arguments, int exitCode) const {
    const Outcome result = run(arguments);
    EXPECT_EQ(result.exitCode, exitCode) << arguments << "\n" << result.err;
    EXPECT_TRUE(isOneSentence(result.err)) << arguments << "\n" << result.err;
    EXPECT_EQ(result.out, "") << arguments;
}

nlohmann::json Program::readJson(const char* name) const {
    return nlohmann::json::parse(std::ifstream(folder_ / name));
}

}  // namespace gnomon::app
