#pragma once
// Runs the built program as its users do.

#include <filesystem>
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

}  // namespace gnomon::app
