#pragma once
// Runs the built program as its users do.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace gnomon::app {

struct Outcome {
    int exitCode = -1;  // -1: ended by a signal
    std::string out, err;
};

/// `arguments` as in a shell. The program's output goes through files in `folder`, which is also its working folder.
Outcome runProgram(const std::filesystem::path& folder, const std::string& arguments);

/// True for one line that starts with "gnomon: " and ends in one full stop.
bool isOneSentence(const std::string& text);

/// The bytes of floats as a data URI, for buffers of glTF files.
std::string dataUri(std::span<const float> numbers);

/// Each test runs the program in a folder of its own.
class Program : public testing::Test {
protected:
    void SetUp() override;
    void TearDown() override;

    Outcome run(const std::string& arguments) const { return runProgram(folder_, arguments); }
    void expectGood(const std::string& arguments) const;
    /// One sentence on stderr, nothing on stdout.
    void expectRefused(const std::string& arguments, int exitCode) const;
    nlohmann::json readJson(const char* name) const;

    std::filesystem::path folder_;
};

}  // namespace gnomon::app
