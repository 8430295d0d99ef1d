#include "unit/app/program.h"

#include <sys/wait.h>

#include <algorithm>
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

}  // namespace gnomon::app
